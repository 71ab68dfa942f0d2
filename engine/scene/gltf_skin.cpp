// Meshes that joints and morph targets put in place (specification 2.0, sections 3.7.2.2 and 3.7.3), at rest.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/gltf_reader.h"
#include "scene/placement.h"

namespace vesper::scene {
namespace {

constexpr uint32_t kMostSets = 4;  // of four joints each: exporters write one or two

/// The node tree of the file, as skins go up and down in it.
class JointTree {
public:
    JointTree(GltfReader& reader, const std::vector<uint32_t>& parents)
        : reader_(reader), parents_(parents), depth_(parents.size(), kNone) {}

    uint32_t parent(uint32_t node) const { return parents_[node]; }

    /// The deepest node that two stand on or are; kNone where there is none, or one of them is kNone.
    uint32_t common(const JsonValue& skin, uint32_t a, uint32_t b) {
        while (a != b && a != kNone && b != kNone) {
            step(skin);
            const uint32_t deep_a = depth(skin, a), deep_b = depth(skin, b);
            if (deep_a >= deep_b) a = parents_[a];
            if (deep_b >= deep_a) b = parents_[b];
        }
        return a == b ? a : kNone;
    }

    /// From a node's frame to that of one above it, or to the world. `known` keeps what is on the way.
    glm::dmat4 relative(const JsonValue& skin, uint32_t node, uint32_t frame, std::map<uint32_t, glm::dmat4>& known) {
        std::vector<uint32_t> way;
        uint32_t at = node;
        for (; at != frame && !known.contains(at); at = parents_[at]) step(skin), way.push_back(at);
        glm::dmat4 placed = at == frame ? glm::dmat4(1) : known.at(at);
        for (auto next = way.rbegin(); next != way.rend(); ++next)
            placed = known[*next] = placed * local_transform(read_placed(reader_.document.node(*next)));
        return placed;
    }

private:
    uint32_t depth(const JsonValue& skin, uint32_t node) {
        std::vector<uint32_t> way;
        for (; node != kNone && depth_[node] == kNone; node = parents_[node]) step(skin), way.push_back(node);
        uint32_t deep = node == kNone ? kNone : depth_[node];
        for (auto next = way.rbegin(); next != way.rend(); ++next) depth_[*next] = ++deep;  // a root's is 0
        return deep;
    }
    /// Any number of joints may stand as deep as there are nodes.
    void step(const JsonValue& skin) {
        if (++steps_ / 100 > reader_.limits.nodes)
            skin.fail("the joints of the skins together stand too deep in the node tree");
    }

    GltfReader& reader_;
    const std::vector<uint32_t>& parents_;
    std::vector<uint32_t> depth_;
    uint64_t steps_ = 0;
};

/// Inverse bind matrices; identities where the file has none.
std::vector<glm::dmat4> inverse_bind(GltfReader& reader, const GltfPart<tinygltf::Skin>& skin) {
    const size_t joints = skin->joints.size();
    std::vector<glm::dmat4> made(joints, glm::dmat4(1));
    if (skin->inverseBindMatrices < 0) return made;
    const JsonValue reference = skin.json.at("inverseBindMatrices");
    const Floats matrices =
        read_floats(reader.document, skin->inverseBindMatrices, {TINYGLTF_TYPE_MAT4}, reader.limits.vertices);
    take_decoded(reader, reference, matrices.count);
    if (matrices.count < joints)
        reference.fail("has " + std::to_string(matrices.count) + " matrices for " + std::to_string(joints) + " joints");
    for (size_t i = 0; i < joints; ++i)
        for (size_t k = 0; k < 16; ++k) {
            const double value = matrices[i][k];
            if (!std::isfinite(value)) reference.fail("matrix " + std::to_string(i) + " is not finite");
            if (k % 4 != 3)
                made[i][static_cast<int>(k / 4)][static_cast<int>(k % 4)] = value;  // the last row is 0 0 0 1
        }
    return made;
}

/// The frame is that of the deepest node above all joints: what moves it, by name or by keys, moves the mesh; what
/// moves joints does not.
Skin read_skin(GltfReader& reader, const GltfPart<tinygltf::Skin>& source, JointTree& tree) {
    const std::vector<uint32_t> joints(source->joints.begin(), source->joints.end());
    if (joints.empty()) source.json.fail("has no joints for the mesh that it is to put in place");
    Skin skin{.frame = joints.front(), .joints = inverse_bind(reader, source)};
    for (const uint32_t joint : joints) skin.frame = tree.common(source.json, skin.frame, joint);
    const std::set<uint32_t> all(joints.begin(), joints.end());
    while (skin.frame != kNone && (all.contains(skin.frame) || reader.node_of[skin.frame] == kNone))
        skin.frame = tree.parent(skin.frame);
    std::map<uint32_t, glm::dmat4> known;
    for (size_t i = 0; i < joints.size(); ++i)
        skin.joints[i] = tree.relative(source.json, joints[i], skin.frame, known) * skin.joints[i];
    return skin;
}

struct Weighed {
    Floats joints, weights;
};

}  // namespace

bool hangs_on_joints(GltfReader& reader, uint32_t mesh) {
    const auto [place, is_new] = reader.jointed.try_emplace(mesh, true);
    if (!is_new) return place->second;
    for (const tinygltf::Primitive& primitive : reader.document.model().meshes[mesh].primitives)
        for (const char* name : {"JOINTS_0", "WEIGHTS_0"})
            place->second = place->second && primitive.attributes.contains(name);
    return place->second;
}

void read_skinned(GltfReader& reader, const std::vector<uint32_t>& parents) {
    std::map<uint32_t, std::vector<uint32_t>> holders;  // one skin in memory at a time
    for (const uint32_t node : reader.skinned)
        holders[static_cast<uint32_t>(reader.document.node(node)->skin)].push_back(node);
    JointTree tree(reader, parents);
    for (const auto& [index, held] : holders) {
        const Skin skin = read_skin(reader, reader.document.skin(index), tree);
        for (const uint32_t holder : held) {
            const auto source = reader.document.node(holder);
            Node drawn;
            drawn.name = source->name;
            drawn.parent = skin.frame == kNone ? kNone : reader.node_of[skin.frame];
            const std::vector<float> weights(source->weights.begin(), source->weights.end());
            drawn.mesh = read_mesh(reader, static_cast<uint32_t>(source->mesh), {weights, index, &skin});
            const uint32_t made = add_node(reader, source.json, std::move(drawn));
            if (reader.node_of[holder] == kNone)
                reader.node_of[holder] = made;
            else
                mark(reader.source.added, made);
        }
    }
}

void add_targets(GltfReader& reader, const GltfPart<tinygltf::Primitive>& primitive, const char* attribute,
                 const std::vector<float>& weights, Floats& values) {
    if (std::all_of(weights.begin(), weights.end(), [](float w) { return w == 0; })) return;
    const auto& targets = primitive->targets;
    take_decoded(reader, primitive.json, targets.size());
    for (size_t t = 0; t < std::min(weights.size(), targets.size()); ++t) {
        const auto found = targets[t].find(attribute);
        if (weights[t] == 0 || found == targets[t].end()) continue;
        if (reader.document.model().accessors[static_cast<size_t>(found->second)].type != TINYGLTF_TYPE_VEC3) {
            reader.notes.add("a morph target that is not of type VEC3 is left out");
            continue;
        }
        const Floats moves = read_floats(reader.document, found->second, {TINYGLTF_TYPE_VEC3}, reader.limits.vertices);
        take_decoded(reader, primitive.json, moves.count);
        if (moves.count != values.count)
            primitive.json.at("targets").elements()[t].at(attribute).fail(
                "has " + std::to_string(moves.count) + " elements, " + attribute + " " + std::to_string(values.count));
        for (size_t i = 0; i < values.values.size(); ++i) values.values[i] += weights[t] * moves.values[i];
    }
}

void bend(GltfReader& reader, const GltfPart<tinygltf::Primitive>& source, const Skin& skin, Primitive& primitive) {
    const JsonValue attributes = source.json.at("attributes");
    std::vector<Weighed> sets;
    for (uint32_t n = 0; n < kMostSets; ++n) {
        const std::string number = std::to_string(n);
        const size_t count = primitive.vertices.size();
        auto joints = read_attribute(reader, source, "JOINTS_" + number, count, {TINYGLTF_TYPE_VEC4});
        auto weights = read_attribute(reader, source, "WEIGHTS_" + number, count, {TINYGLTF_TYPE_VEC4});
        if (!joints || !weights) break;
        take_decoded(reader, attributes, 2 * count);
        sets.push_back({std::move(*joints), std::move(*weights)});
    }
    std::vector<char> mirrored(primitive.vertices.size());
    for (size_t i = 0; i < primitive.vertices.size(); ++i) {
        const auto joint = [&](const Weighed& set, size_t c) -> const glm::dmat4& {
            const float index = set.joints[i][c];
            if (!(index >= 0 && index < static_cast<float>(skin.joints.size())))
                attributes.fail("vertex " + std::to_string(i) + " hangs on a joint that is none of the skin's " +
                                std::to_string(skin.joints.size()));
            return skin.joints[static_cast<size_t>(index)];
        };
        glm::dmat4 sum(0);
        double total = 0;
        for (const Weighed& set : sets)
            for (size_t c = 0; c < 4; ++c) {
                const double weight = set.weights[i][c];
                if (!(weight > 0)) continue;  // what hangs on nothing may name any joint
                sum += weight * joint(set, c), total += weight;
            }
        const glm::dmat4 m = total > 0 ? sum / total : joint(sets.front(), 0);
        Vertex& vertex = primitive.vertices[i];
        vertex.position = glm::vec3(m * glm::dvec4(glm::dvec3(vertex.position), 1));
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(vertex.position[c]))
                attributes.fail("vertex " + std::to_string(i) + " is put at no finite place by its joints");
        // Normals go by the cofactors, as in gbuffer.vert: outward stays outward also where joints mirror.
        const glm::dvec3 x(m[0]), y(m[1]), z(m[2]), n(vertex.normal);
        const glm::dvec3 turned = n.x * glm::cross(y, z) + n.y * glm::cross(z, x) + n.z * glm::cross(x, y);
        mirrored[i] = glm::dot(x, glm::cross(y, z)) < 0;
        const double length = glm::length(turned);
        if (length > 0 && std::isfinite(length)) vertex.normal = glm::vec3((mirrored[i] ? -turned : turned) / length);
    }
    for (size_t i = 0; i < primitive.indices.size(); i += 3)
        if (mirrored[primitive.indices[i]] + mirrored[primitive.indices[i + 1]] + mirrored[primitive.indices[i + 2]] >
            1)
            std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
}

}  // namespace vesper::scene
