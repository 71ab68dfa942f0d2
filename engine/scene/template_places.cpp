// Places of lamps that a template suggests. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "base/budget.h"
#include "scene/template_rules.h"

namespace vesper::scene {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr dvec3 kUp{0, 1, 0};
constexpr size_t kMostNodes = 1000;                      // that are looked at below a node
constexpr double kSlender = 1.5;                         // height over width, of a pole in any unit
constexpr double kTall = 2.5;                            // m: taller things are lamps with their poles
constexpr double kEnd = 0.1;                             // the part of a pole's height that is its head, or its foot
constexpr double kArmOfHeight = 0.05, kEndOfArm = 0.75;  // the shortest arm; where its end begins
constexpr size_t kMostCorners = 300'000;                 // of triangles that are looked at for it
constexpr double kNear = 0.05, kArm = 0.3;               // m: less is no offset; shorter is no arm
constexpr double kFacing = 0.5;                          // of an area: its sum of normals, if it faces a side
constexpr double kSameAxis = 0.98;                       // cosine
constexpr double kShortest = 1, kLongest = 30;           // m, of vehicles
constexpr double kLongestArm = 10;                       // m, of poles

/// A direction in a node's frame; none where its transform has no inverse.
std::optional<dvec3> in_frame(const glm::dmat4& world, dvec3 direction) {
    const dmat3 axes(world);
    if (!(std::abs(glm::determinant(axes)) > 0)) return std::nullopt;
    const dvec3 local = glm::inverse(axes) * direction;
    const double length = glm::length(local);
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    return local / length;
}

dvec3 unit_or_zero(dvec3 v) { return glm::length(v) > 0 ? glm::normalize(v) : dvec3(0); }

}  // namespace

/// Surfaces at and below a node, in the world.
struct LampPlaces::Surfaces {
    std::vector<Part> all, shining;
    size_t nodes = 0;
};

/// The shape of some surfaces in the world, m.
struct LampPlaces::Shape {
    Bounds box;
    dvec3 facing{0};             ///< sum of normals, by area
    double area = 0;             ///< m^2
    std::vector<dvec3> corners;  ///< of triangles, some of many

    double height() const { return double(box.high.y) - double(box.low.y); }
    bool is_tall() const {
        const glm::vec3 size = box.high - box.low;
        return height() > kTall || height() > kSlender * double(std::max(size.x, size.z));
    }
    bool faces() const { return area > 0 && glm::length(facing) > kFacing * area; }

    /// The middle of the lowest part.
    dvec3 foot() const {
        Bounds low;
        for (const dvec3& corner : corners)
            if (corner.y < double(box.low.y) + kEnd * height()) low.add(glm::vec3(corner));
        return low.empty() ? dvec3(0) : (dvec3(low.low) + dvec3(low.high)) / 2.0;
    }
    /// Where the light comes out: of the highest part, the lower edge of the end of the arm, if it has one.
    dvec3 head(dvec3 above) const {
        const auto is_high = [&](dvec3 corner) { return corner.y > double(box.high.y) - kEnd * height(); };
        const auto distance = [&](dvec3 corner) { return std::hypot(corner.x - above.x, corner.z - above.z); };
        double farthest = 0;
        for (const dvec3& corner : corners)
            if (is_high(corner)) farthest = std::max(farthest, distance(corner));
        const double nearest = farthest > kArmOfHeight * height() ? kEndOfArm * farthest : 0;
        Bounds end;
        for (const dvec3& corner : corners)
            if (is_high(corner) && distance(corner) >= nearest) end.add(glm::vec3(corner));
        if (end.empty()) return above;
        const dvec3 middle = (dvec3(end.low) + dvec3(end.high)) / 2.0;
        return {middle.x, double(end.low.y), middle.z};
    }
};

LampPlaces::Shape LampPlaces::shape_of(const std::vector<Part>& parts) const {
    Shape shape;
    for (const Part& part : parts) {
        const glm::dmat4& m = world_[part.node];
        const double side = glm::determinant(dmat3(m)) < 0 ? -0.5 : 0.5;
        for (size_t i = 0; i + 2 < part.primitive->indices.size(); i += 3) {
            check_time();
            std::array<dvec3, 3> p;
            for (size_t c = 0; c < 3; ++c) {
                p[c] = dvec3(m * glm::dvec4(part.primitive->vertices[part.primitive->indices[i + c]].position, 1));
                shape.box.add(glm::vec3(p[c]));
                if (shape.corners.size() < kMostCorners) shape.corners.push_back(p[c]);
            }
            const dvec3 normal = side * glm::cross(p[1] - p[0], p[2] - p[0]);
            shape.facing += normal, shape.area += glm::length(normal);
        }
    }
    return shape;
}

LampPlaces::LampPlaces(const Scene& scene, const std::vector<bool>& shining)
    : scene_(scene),
      shining_(shining),
      world_(world_transforms(scene, 0)),
      first_child_(scene.nodes.size(), kNone),
      next_(scene.nodes.size(), kNone),
      below_(scene.nodes.size()) {
    for (auto i = static_cast<uint32_t>(scene.nodes.size()); i-- > 0;) {
        const Node& node = scene.nodes[i];
        if (node.mesh != kNone)
            for (const Primitive& primitive : scene.meshes[node.mesh].primitives)
                if (!primitive.bounds.empty())
                    for (const dvec3 corner : placed_corners(primitive.bounds, world_[i]))
                        below_[i].add(glm::vec3(corner));
        if (node.parent == kNone) continue;
        next_[i] = first_child_[node.parent];
        first_child_[node.parent] = i;
        if (!below_[i].empty()) below_[node.parent].add(below_[i].low), below_[node.parent].add(below_[i].high);
    }
}

void LampPlaces::collect(uint32_t node, Surfaces& surfaces) const {
    std::vector<uint32_t> open{node};
    while (!open.empty() && surfaces.nodes++ < kMostNodes) {
        check_time();
        const uint32_t i = open.back();
        open.pop_back();
        for (uint32_t child = first_child_[i]; child != kNone && open.size() < kMostNodes; child = next_[child])
            open.push_back(child);
        if (scene_.nodes[i].mesh == kNone) continue;
        for (const Primitive& primitive : scene_.meshes[scene_.nodes[i].mesh].primitives) {
            if (primitive.bounds.empty()) continue;
            surfaces.all.push_back({&primitive, i});
            if (shining_[primitive.material]) surfaces.shining.push_back({&primitive, i});
        }
    }
}

bool LampPlaces::shines_beside(uint32_t node) const {
    const auto shines = [&](uint32_t i) {
        return scene_.nodes[i].mesh != kNone &&
               std::ranges::any_of(scene_.meshes[scene_.nodes[i].mesh].primitives,
                                   [&](const Primitive& p) { return bool(shining_[p.material]); });
    };
    const uint32_t parent = scene_.nodes[node].parent;
    if (parent == kNone) return false;
    if (shines(parent)) return true;
    size_t looked = 0;
    for (uint32_t i = first_child_[parent]; i != kNone && looked++ < kMostNodes; i = next_[i])
        if (shines(i)) return true;
    return false;
}

std::optional<dvec3> LampPlaces::off_vehicle(uint32_t node, dvec3 at) const {
    for (uint32_t up = node; up != kNone; up = scene_.nodes[up].parent) {
        check_time();
        if (below_[up].empty()) continue;
        const dvec3 low(below_[up].low), high(below_[up].high), size = high - low;
        if (std::max(size.x, size.z) < kShortest) continue;
        if (std::max(size.x, size.z) > kLongest) return std::nullopt;
        const auto local = in_frame(world_[up], at - (low + high) / 2.0);
        if (!local) return std::nullopt;
        // The axis of the vehicle, of those that lie level, that the lamp is farthest along.
        dvec3 best(0);
        double farthest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const dvec3 direction = unit_or_zero(dvec3(world_[up][axis]));
            if (std::abs(direction.y) > 0.7 || std::abs((*local)[axis]) <= farthest) continue;
            farthest = std::abs((*local)[axis]);
            best = (*local)[axis] < 0 ? -direction : direction;
        }
        if (!(farthest > 0)) return std::nullopt;
        return best;
    }
    return std::nullopt;
}

LampPlace LampPlaces::of(uint32_t node, const SourceKind& kind, bool has_light, bool foot_above) const {
    const glm::dmat4& world = world_[node];
    const dvec3 origin(world[3]);
    LampPlace place{.world = origin};
    Surfaces surfaces;
    collect(node, surfaces);
    place.surface = !surfaces.shining.empty() || shines_beside(node);
    if (has_light) return place;  // the light of the file says where, and along -Z

    const bool glows = !surfaces.shining.empty();
    const Shape shape = shape_of(glows ? surfaces.shining : surfaces.all);
    std::optional<dvec3> foot;  // of a pole
    if (!shape.box.empty()) {
        place.world = (dvec3(shape.box.low) + dvec3(shape.box.high)) / 2.0;
        if (!glows && shape.is_tall() && !kind.of_vehicle) foot = shape.foot(), place.world = shape.head(*foot);
        for (int axis = 0; axis < 3; ++axis)
            place.offset[axis] = glm::dot(place.world - origin, unit_or_zero(dvec3(world[axis])));
        if (glm::length(place.offset) < kNear) place.offset = dvec3(0), place.world = origin;
    }
    std::optional<dvec3> aim;  // in the world
    const bool down = kind.standard == std::string_view("street-lamp");
    if (down)
        aim = -kUp;
    else if (kind.outer > 0 || kind.of_vehicle)
        aim = shape.faces()     ? unit_or_zero(shape.facing)
              : kind.of_vehicle ? off_vehicle(node, place.world)
                                : std::nullopt;
    if (aim) place.aim = in_frame(world, *aim);
    if (place.aim && glm::dot(*place.aim, dvec3(0, 0, -1)) > kSameAxis) place.aim.reset();
    if (down) {
        // An origin that is not set apart from the one above tells no more than that one.
        const bool apart = scene_.nodes[node].translation != dvec3(0);
        if (!foot && apart && glm::length(place.offset) > 0)
            foot = origin;
        else if (!foot && foot_above)
            foot = dvec3(world_[scene_.nodes[node].parent][3]);
        dvec3 arm = place.world - foot.value_or(place.world);
        arm.y = 0;
        if (glm::length(arm) > kArm && glm::length(arm) < kLongestArm) place.c0 = in_frame(world, glm::cross(arm, kUp));
    }
    return place;
}

glm::dvec3 LampPlaces::middle(uint32_t node) const {
    const Bounds& box = below_[node];
    return box.empty() ? dvec3(world_[node][3]) : (dvec3(box.low) + dvec3(box.high)) / 2.0;
}

glm::dvec3 LampPlaces::axis(uint32_t node, const LampPlace& place) const {
    const dvec3 axis = unit_or_zero(dmat3(world_[node]) * place.aim.value_or(dvec3(0, 0, -1)));
    return axis == dvec3(0) ? -kUp : axis;
}

}  // namespace vesper::scene
