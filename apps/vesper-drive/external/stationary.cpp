#include "external/stationary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "photometry/retroreflection.h"

namespace vesper::drive {
namespace {

using Standing = osi::StationaryObject::Kind;

constexpr std::array<const char*, 20> kKindNames{"thing of no stated kind",
                                                 "other thing",
                                                 "bridge",
                                                 "building",
                                                 "pole",
                                                 "pylon",
                                                 "delineator",
                                                 "tree",
                                                 "barrier",
                                                 "vegetation",
                                                 "curbstone",
                                                 "wall",
                                                 "structure",
                                                 "structure",
                                                 "overhead structure",
                                                 "reflective structure",
                                                 "thing of a construction site",
                                                 "speed bump",
                                                 "emitting structure",
                                                 "traffic sign"};
constexpr double kSameThing = 0.5;  // m
constexpr double kPanel = 0.02;     // m, thickness of a sign
constexpr double kUsualSign = 0.6;  // m
constexpr int kRoundSides = 16;

enum class Shape : uint8_t { Box, Cylinder, Cone, Panel };

Shape shape_of(Standing kind) {
    if (kind == Standing::Sign) return Shape::Panel;
    if (kind == Standing::Pylon) return Shape::Cone;
    const bool round = kind == Standing::Pole || kind == Standing::Delineator || kind == Standing::Tree;
    return round ? Shape::Cylinder : Shape::Box;
}

glm::vec3 reflectance_of(Standing kind) {
    if (kind == Standing::Tree || kind == Standing::Vegetation) return {0.05f, 0.1f, 0.03f};
    if (kind == Standing::Pylon || kind == Standing::Construction) return {0.6f, 0.15f, 0.03f};
    return glm::vec3(0.3f);
}

void add_face(scene::Primitive& p, const std::array<glm::vec3, 4>& corners) {
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const auto first = uint32_t(p.vertices.size());
    for (const glm::vec3& corner : corners) {
        p.vertices.push_back({.position = corner, .normal = normal});
        p.bounds.add(corner);
    }
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + i);
}

// Faces of a box of side 1 about the origin: front (-z), the others.
void add_front(scene::Primitive& p) {
    constexpr float h = 0.5f;
    add_face(p, {{{h, -h, -h}, {-h, -h, -h}, {-h, h, -h}, {h, h, -h}}});
}
void add_other_faces(scene::Primitive& p) {
    constexpr float h = 0.5f;
    add_face(p, {{{-h, -h, h}, {h, -h, h}, {h, h, h}, {-h, h, h}}});
    add_face(p, {{{h, -h, h}, {h, -h, -h}, {h, h, -h}, {h, h, h}}});
    add_face(p, {{{-h, -h, -h}, {-h, -h, h}, {-h, h, h}, {-h, h, -h}}});
    add_face(p, {{{-h, h, h}, {h, h, h}, {h, h, -h}, {-h, h, -h}}});
    add_face(p, {{{-h, -h, -h}, {h, -h, -h}, {h, -h, h}, {-h, -h, h}}});
}
// `top`: its radius.
void add_round(scene::Primitive& p, float top) {
    constexpr float h = 0.5f;
    const auto at = [](int i, float radius, float y) {
        const float angle = 2 * std::numbers::pi_v<float> * float(i) / kRoundSides;
        return glm::vec3(radius * std::sin(angle), y, radius * std::cos(angle));
    };
    for (int i = 0; i < kRoundSides; ++i) {
        add_face(p, {at(i, h, -h), at(i + 1, h, -h), at(i + 1, top, h), at(i, top, h)});
        add_face(p, {glm::vec3(0, h, 0), at(i, top, h), at(i + 1, top, h), glm::vec3(0, h, 0)});
    }
}

uint32_t matt(scene::Scene& scene, const std::string& name, const glm::vec3& reflectance) {
    scene.materials.push_back({.name = name, .base_colour = glm::vec4(reflectance, 1), .roughness = 1});
    return uint32_t(scene.materials.size() - 1);
}

// White sheeting of class RA2, where the scene has room for one more; coefficients are multiplied by the colour.
uint32_t sheeting(scene::Scene& scene) {
    constexpr float kWhite = 0.5f;
    const uint32_t material = matt(scene, "sign of messages", glm::vec3(kWhite));
    auto made = photometry::rescaled(photometry::retroreflective_class("RA2"), 1 / double(kWhite));
    auto& known = scene.retroreflectors;
    const auto same = std::find(known.begin(), known.end(), made);
    if (same == known.end() && known.size() == scene::kMaxRetroreflectors) return material;
    scene.materials[material].retroreflector = uint32_t(same - known.begin());
    if (same == known.end()) known.push_back(std::move(made));
    return material;
}

uint32_t mesh_of(scene::Scene& scene, Standing kind) {
    const std::string name = std::string("messages: ") + kKindNames[size_t(kind)];
    scene::Mesh mesh{.name = name, .primitives = {}};
    const Shape shape = shape_of(kind);
    scene::Primitive body{.material = matt(scene, name, reflectance_of(kind))};
    if (shape == Shape::Cylinder) add_round(body, 0.5f);
    if (shape == Shape::Cone) add_round(body, 0.05f);
    if (shape == Shape::Box) add_front(body);
    if (shape == Shape::Box || shape == Shape::Panel) add_other_faces(body);
    mesh.primitives.push_back(std::move(body));
    if (shape == Shape::Panel) {
        scene::Primitive front{.material = sheeting(scene)};
        add_front(front);
        mesh.primitives.push_back(std::move(front));
    }
    scene.meshes.push_back(std::move(mesh));
    return uint32_t(scene.meshes.size() - 1);
}

// Length, width and height; none: it cannot be drawn.
glm::dvec3 box_of(const osi::StationaryObject& o) {
    glm::dvec3 size = o.size;
    if (o.kind == Standing::Sign) {
        size.x = kPanel;
        for (int i = 1; i < 3; ++i)
            if (size[i] == 0) size[i] = kUsualSign;
    }
    return size;
}

glm::quat standing_turn(const osi::StationaryObject& o, const MessageFrame& frame) {
    const glm::dmat3 axes = osi::axes_of(o.yaw + frame.yaw, o.pitch, o.roll);
    const auto world = [](const glm::dvec3& a) { return glm::vec3(a.x, a.z, -a.y); };
    return glm::quat_cast(glm::mat3(-world(axes[1]), world(axes[2]), -world(axes[0])));
}

}  // namespace

std::string text_of(const KindCounts& counts) {
    std::string text;
    for (const auto& [kind, count] : counts) text += (text.empty() ? "" : ", ") + kind + ": " + std::to_string(count);
    return text;
}

std::string kind_of(const osi::StationaryObject& object) { return kKindNames[size_t(object.kind)]; }

StationaryNodes add_stationary(scene::Scene& scene, std::span<const osi::StationaryObject> objects,
                               const MessageFrame& frame, std::span<const glm::dvec3> roads) {
    StationaryNodes made;
    std::map<Standing, uint32_t> meshes;
    for (const osi::StationaryObject& o : objects) {
        const std::string kind = kind_of(o);
        const glm::dvec3 size = box_of(o), place = frame.point(o.centre);
        if (std::any_of(roads.begin(), roads.end(), [&](const glm::dvec3& known) {
                return std::hypot(known.x - place.x, known.z - place.z) < kSameThing;
            })) {
            ++made.of_roads[kind];
            continue;
        }
        if (o.kind == Standing::Bridge || o.kind == Standing::Overhead || std::min({size.x, size.y, size.z}) <= 0) {
            ++made.not_shown[kind];
            continue;
        }
        const auto mesh = meshes.find(o.kind);
        scene::Node node{.name = "stationary " + std::to_string(o.id), .translation = place};
        node.rotation = standing_turn(o, frame);
        node.scale = glm::vec3(size.y, size.z, size.x);  // across, up, along
        node.mesh = mesh != meshes.end() ? mesh->second : meshes[o.kind] = mesh_of(scene, o.kind);
        scene.nodes.push_back(std::move(node));
        if (o.kind != Standing::Sign) made.standing.emplace_back(uint32_t(scene.nodes.size() - 1), size.z / 2);
        ++made.shown[kind];
    }
    return made;
}

void StationaryCensus::add(const osi::Message& message) {
    for (const osi::StationaryObject& object : message.stationary)
        if (known_.size() < size_t(osi::kMostObjects) && known_.insert(osi::key_of(object)).second)
            ++counts_[kind_of(object)];
}

}  // namespace vesper::drive
