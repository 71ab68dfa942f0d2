// The node tree of a glTF file, with cameras and instances. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/gltf_reader.h"
#include "scene/rotation.h"

namespace vesper::scene {
namespace {

/// The parent of every node; a node with two, or above itself, is refused.
std::vector<uint32_t> read_parents(GltfDocument& document) {
    const std::vector<tinygltf::Node>& nodes = document.model().nodes;
    std::vector<uint32_t> parents(nodes.size(), kNone);
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        const std::vector<int>& children = nodes[i].children;
        for (size_t c = 0; c < children.size(); ++c) {
            uint32_t& parent = parents[static_cast<size_t>(children[c])];
            if (parent != kNone)
                document.list("nodes")[i]
                    .at("children")
                    .elements()[c]
                    .fail("node " + std::to_string(children[c]) + " has more than one parent");
            parent = i;
        }
    }
    // With one parent each, nodes not reached from a root go round in circles.
    std::vector<uint32_t> reached;
    for (uint32_t i = 0; i < nodes.size(); ++i)
        if (parents[i] == kNone) reached.push_back(i);
    for (size_t i = 0; i < reached.size(); ++i) {
        const std::vector<int>& children = nodes[reached[i]].children;
        reached.insert(reached.end(), children.begin(), children.end());
    }
    if (reached.size() != nodes.size()) {
        std::vector<bool> seen(nodes.size());
        for (const uint32_t i : reached) seen[i] = true;
        const auto lost = static_cast<size_t>(std::find(seen.begin(), seen.end(), false) - seen.begin());
        document.list("nodes")[lost].fail("is its own ancestor");
    }
    return parents;
}

/// Roots of the default scene, of the first one, or of all nodes. Some files list nodes that are no roots: those come
/// last, to be read as roots when their parents have not brought them in.
std::vector<uint32_t> read_roots(GltfReader& reader, const std::vector<uint32_t>& parents) {
    GltfDocument& document = reader.document;
    const auto& scenes = document.model().scenes;
    const auto chosen = document.root().find("scene");
    std::vector<uint32_t> roots;
    if (!chosen && scenes.empty()) {
        for (uint32_t i = 0; i < parents.size(); ++i)
            if (parents[i] == kNone) roots.push_back(i);
        return roots;
    }
    const tinygltf::Scene& scene = scenes[chosen ? chosen->index(scenes.size(), "scenes") : 0];
    if (!chosen && scenes.size() > 1)
        reader.notes.add("the file has several scenes and no default: the first one is read");
    reader.scene.name = scene.name;
    std::vector<uint32_t> others;
    for (const int node : scene.nodes) {
        const auto root = static_cast<uint32_t>(node);
        (parents[root] == kNone ? roots : others).push_back(root);
    }
    if (!others.empty()) reader.notes.add("the scene lists nodes that have parents");
    roots.insert(roots.end(), others.begin(), others.end());
    return roots;
}

/// `xyzw` as floats, which need not be of length 1.
glm::quat rotation_of(const JsonValue& holder, glm::vec4 xyzw) {
    const auto rotation = unit_rotation(xyzw);
    if (!rotation) holder.fail("is no rotation");
    return *rotation;
}

void read_transform(Node& node, const GltfPart<tinygltf::Node>& source) {
    if (const std::vector<double>& m = source->matrix; !m.empty()) {
        if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
            source.json.at("matrix").fail("must have 0 0 0 1 as its last row");
        glm::dmat4 made(1);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) made[c][r] = m[static_cast<size_t>(4 * c + r)];
        node.matrix = made;
        return;
    }
    if (const auto& t = source->translation; !t.empty()) node.translation = {t[0], t[1], t[2]};
    if (const auto& q = source->rotation; !q.empty())
        node.rotation = rotation_of(source.json.at("rotation"), glm::dvec4(q[0], q[1], q[2], q[3]));
    if (const auto& s = source->scale; !s.empty()) node.scale = {s[0], s[1], s[2]};
}

/// Cameras are kept once per node that has one, so that each can have a name of its own.
uint32_t read_camera(GltfReader& reader, const JsonValue& source, const std::string& node_name, bool shared) {
    const std::string& type = source.at("type").text();
    if (type == "orthographic") {
        reader.notes.add("an orthographic camera is left out");
        return kNone;
    }
    if (type != "perspective") {
        reader.notes.add("a camera of a type that glTF does not have is left out");
        return kNone;
    }
    const JsonValue perspective = source.at("perspective");
    constexpr double kWidest = std::numbers::pi - 1e-4;
    const double fov = perspective.at("yfov").number(1e-4);
    if (fov > kWidest) {
        reader.notes.add("a camera with a field of view of 180 degrees or more is left out");
        return kNone;
    }
    Camera camera;
    const std::string own_name = source.text_or("name", "");
    camera.name = own_name.empty() || shared ? node_name : own_name;
    camera.vertical_fov = static_cast<float>(fov);
    camera.near = static_cast<float>(perspective.at("znear").number(1e-6));
    reader.scene.cameras.push_back(camera);
    return static_cast<uint32_t>(reader.scene.cameras.size() - 1);
}

/// EXT_mesh_gpu_instancing: a child with the mesh for each instance.
void read_instances(GltfReader& reader, const JsonValue& instancing, uint32_t parent) {
    const JsonValue attributes = instancing.at("attributes");
    const auto read = [&](const char* name, int type) -> std::optional<Floats> {
        const auto reference = attributes.find(name);
        if (!reference) return std::nullopt;
        const uint32_t accessor = reference->index(reader.document.list("accessors").size(), "accessors");
        return read_floats(reader.document, static_cast<int>(accessor), {type}, reader.limits.nodes);
    };
    const auto translations = read("TRANSLATION", TINYGLTF_TYPE_VEC3), rotations = read("ROTATION", TINYGLTF_TYPE_VEC4),
               scales = read("SCALE", TINYGLTF_TYPE_VEC3);
    uint32_t count = 0;
    for (const auto* floats : {&translations, &rotations, &scales}) {
        if (!*floats) continue;
        if (count != 0 && count != (*floats)->count) attributes.fail("the instance attributes differ in count");
        count = (*floats)->count;
        for (const float value : (*floats)->values)
            if (!std::isfinite(value)) attributes.fail("an instance transform is not finite");
    }
    if (count == 0) return;  // nothing we know of: the mesh stays where it is
    const uint32_t mesh = std::exchange(reader.scene.nodes[parent].mesh, kNone);
    for (uint32_t i = 0; i < count; ++i) {
        Node instance;
        instance.name = reader.scene.nodes[parent].name + " #" + std::to_string(i);
        instance.parent = parent;
        instance.mesh = mesh;
        if (translations) instance.translation = {(*translations)[i][0], (*translations)[i][1], (*translations)[i][2]};
        if (scales) instance.scale = {(*scales)[i][0], (*scales)[i][1], (*scales)[i][2]};
        if (rotations) {
            const auto q = (*rotations)[i];
            instance.rotation = rotation_of(attributes, {q[0], q[1], q[2], q[3]});
        }
        const uint32_t made = add_node(reader, instancing, std::move(instance));
        mark(reader.source.added, made), mark(reader.source.instances, made);
    }
}

/// Whether KHR_node_visibility hides a node itself.
bool is_hidden(const JsonValue& node) {
    const auto extensions = node.find("extensions");
    const auto visibility = extensions ? extensions->find("KHR_node_visibility") : std::nullopt;
    return visibility && !visibility->boolean_or("visible", true);
}

/// Of a `hidden` node the place and the camera.
void read_node(GltfReader& reader, uint32_t index, uint32_t parent, bool hidden,
               const std::vector<uint32_t>& camera_uses) {
    const auto source = reader.document.node(index);
    Node node;
    node.name = source->name;
    node.parent = parent;
    read_transform(node, source);
    const auto extensions = source.json.find("extensions");
    const auto instancing = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
    // A node without a mesh has -1, which is kNone.
    const uint32_t mesh = hidden ? kNone : static_cast<uint32_t>(source->mesh);
    const bool has_skin = mesh != kNone && source->skin >= 0,
               skinned = has_skin && !instancing && hangs_on_joints(reader, mesh);
    if (has_skin)
        reader.notes.add(
            skinned ? "a node with a skin is shown at rest"
                    : "a node with a skin, but instances or a mesh without joints, is shown as it is modelled");
    if (skinned)
        reader.skinned.insert(index);
    else if (mesh != kNone)
        node.mesh = read_mesh(reader, mesh, {{source->weights.begin(), source->weights.end()}});
    if (source->camera >= 0) {
        const auto camera = static_cast<size_t>(source->camera);
        node.camera =
            read_camera(reader, reader.document.list("cameras")[camera],
                        node.name.empty() ? "node " + std::to_string(index) : node.name, camera_uses[camera] > 1);
    }
    Node second;  // a node has one light: a measured one beside another becomes a child's
    if (extensions && !hidden) {
        if (const auto lamp = extensions->find("KHR_lights_punctual"))
            if (const uint32_t used = lamp->at("light").index(reader.punctual_lights, "lights");
                !reader.unknown_lights.contains(used))
                node.lamp = used;
        if (const auto lamp = extensions->find("EXT_lights_ies"))
            (node.lamp == kNone ? node : second).lamp = read_measured_light(reader, *lamp);
    }
    const bool has_mesh = node.mesh != kNone;
    // Where nothing else hangs on it, the node with the mesh in place, which follows, takes its place and name.
    if (skinned && node.camera == kNone && node.lamp == kNone && second.lamp == kNone && source->children.empty())
        return;
    const uint32_t made = add_node(reader, source.json, std::move(node));
    reader.node_of[index] = made;
    if (second.lamp != kNone) {
        second.name = reader.scene.nodes[made].name;
        second.parent = made;
        mark(reader.source.added, add_node(reader, source.json, std::move(second)));
    }
    if (instancing && has_mesh) read_instances(reader, *instancing, made);
}

/// Meshes are kept once, but drawn and added up once for each node.
void check_drawn(const GltfReader& reader) {
    std::vector<uint64_t> triangles(reader.scene.meshes.size());
    for (size_t i = 0; i < triangles.size(); ++i)
        for (const Primitive& primitive : reader.scene.meshes[i].primitives)
            triangles[i] += primitive.indices.size() / 3;
    uint64_t drawn = 0;
    for (const Node& node : reader.scene.nodes)
        if (node.mesh != kNone) drawn += triangles[node.mesh];
    const uint64_t limit = reader.limits.indices / 3 * 10;  // triangles, those of meshes ten times
    if (drawn > limit)
        reader.document.root().at("nodes").fail("show " + std::to_string(drawn) +
                                                " triangles together, more than the limit of " + std::to_string(limit));
}

}  // namespace

Node read_placed(const GltfPart<tinygltf::Node>& source) {
    Node node;
    read_transform(node, source);
    return node;
}

uint32_t add_node(GltfReader& reader, const JsonValue& source, Node node) {
    if (reader.scene.nodes.size() >= reader.limits.nodes)
        source.fail("more nodes than the limit of " + std::to_string(reader.limits.nodes));
    reader.scene.nodes.push_back(std::move(node));
    return static_cast<uint32_t>(reader.scene.nodes.size() - 1);
}

void read_nodes(GltfReader& reader) {
    const size_t count = reader.document.list("nodes").size();
    if (count > reader.limits.nodes)
        reader.document.root().at("nodes").fail("more nodes than the limit of " + std::to_string(reader.limits.nodes));
    reader.node_of.assign(count, kNone);
    const std::vector<uint32_t> parents = read_parents(reader.document);
    const std::vector<tinygltf::Node>& nodes = reader.document.model().nodes;

    std::vector<uint32_t> camera_uses(reader.document.list("cameras").size());
    for (const tinygltf::Node& node : nodes)
        if (node.camera >= 0) ++camera_uses[static_cast<size_t>(node.camera)];

    std::vector<bool> hidden(count);
    std::vector<uint32_t> waiting = read_roots(reader, parents);
    std::reverse(waiting.begin(), waiting.end());
    while (!waiting.empty()) {  // no recursion: a tree may be as deep as it has nodes
        const uint32_t index = waiting.back();
        waiting.pop_back();
        if (reader.node_of[index] != kNone || reader.skinned.contains(index)) continue;
        const uint32_t parent = parents[index];
        hidden[index] = (parent != kNone && hidden[parent]) || is_hidden(reader.document.node(index).json);
        if (hidden[index]) reader.notes.add("a node that KHR_node_visibility hides is not shown");
        read_node(reader, index, parent == kNone ? kNone : reader.node_of[parent], hidden[index], camera_uses);
        waiting.insert(waiting.end(), nodes[index].children.rbegin(), nodes[index].children.rend());
    }
    read_skinned(reader, parents);

    const auto lit = std::count_if(reader.scene.nodes.begin(), reader.scene.nodes.end(),
                                   [](const Node& n) { return n.lamp != kNone; });
    if (static_cast<uint64_t>(lit) > reader.limits.lamps)
        reader.document.root().fail("more lights than the limit of " + std::to_string(reader.limits.lamps));
    check_drawn(reader);
    if (reader.scene.nodes.empty() && !reader.document.list("meshes").empty())
        reader.notes.add("no node shows any of the file's meshes: the scene is empty");
}

}  // namespace vesper::scene
