// Surfaces that are the glass of lamps. SPDX-License-Identifier: MIT
#include "scene/lamp_glass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/budget.h"

namespace vesper::scene {
namespace {

using glm::dvec3;

/// Lamps at a node's own place in the tree: on it, on its parent, on its children, on its siblings.
class Neighbours {
public:
    Neighbours(const Scene& scene, std::vector<GlassLamp>& lamps) : scene_(scene) {
        for (GlassLamp& lamp : lamps) {
            at_[lamp.node].push_back(&lamp);
            if (scene.nodes[lamp.node].parent != kNone) below_[scene.nodes[lamp.node].parent].push_back(&lamp);
        }
    }
    std::vector<GlassLamp*> of(uint32_t node) const {
        const uint32_t parent = scene_.nodes[node].parent;
        std::vector<GlassLamp*> found;
        const auto take = [&](const auto& map, uint32_t key) {
            if (const auto lamps = map.find(key); lamps != map.end())
                found.insert(found.end(), lamps->second.begin(), lamps->second.end());
        };
        take(at_, node), take(below_, node);
        if (parent != kNone) take(at_, parent), take(below_, parent);
        return found;
    }

private:
    const Scene& scene_;
    std::map<uint32_t, std::vector<GlassLamp*>> at_, below_;
};

/// Lamps in the reach of a primitive, to find the nearest one to a place.
class NearLamps {
public:
    NearLamps(const Primitive& primitive, const glm::dmat4& world, const std::vector<GlassLamp*>& lamps) {
        if (primitive.bounds.empty()) return;
        dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const dvec3 corner : placed_corners(primitive.bounds, world))
            low = glm::min(low, corner), high = glm::max(high, corner);
        for (GlassLamp* const lamp : lamps)
            if (glm::distance(lamp->position, glm::clamp(lamp->position, low, high)) <= kGlassReach + kRounding)
                near_.push_back({lamp, near_.size()});
        const dvec3 size = high - low;
        for (int axis = 1; axis < 3; ++axis)
            if (size[axis] > size[axis_]) axis_ = axis;
        std::sort(near_.begin(), near_.end(), [&](const Ranked& a, const Ranked& b) { return along(a) < along(b); });
    }
    bool empty() const { return near_.empty(); }

    /// The nearest in reach, the first of several; null if there is none.
    GlassLamp* to(dvec3 place) const {
        const Ranked* best = nullptr;
        double least = kGlassReach;
        auto at = std::lower_bound(near_.begin(), near_.end(), place[axis_] - kGlassReach - kRounding,
                                   [&](const Ranked& lamp, double value) { return along(lamp) < value; });
        for (; at != near_.end() && along(*at) <= place[axis_] + kGlassReach + kRounding; ++at) {
            const double distance = glm::distance(at->lamp->position, place);
            if (distance > least || (best && distance == least && at->rank > best->rank)) continue;
            best = &*at, least = distance;
        }
        return best ? best->lamp : nullptr;
    }

private:
    static constexpr double kRounding = 1e-3;  // m, of bounds in the world
    struct Ranked {
        GlassLamp* lamp;
        size_t rank;
    };
    double along(const Ranked& lamp) const { return lamp.lamp->position[axis_]; }

    std::vector<Ranked> near_;  ///< by their place on the axis
    int axis_ = 0;              ///< the longest of the primitive
};

/// Adds the triangles of a primitive to the lamps they are nearest to. `picture` null: they emit evenly.
void add_area(const Primitive& primitive, const glm::dmat4& world, bool double_sided, const EmitterRule& emitter,
              const photometry::PictureMeans* picture, const std::vector<GlassLamp*>& lamps) {
    const NearLamps near(primitive, world, lamps);
    if (near.empty()) return;
    const double side = glm::determinant(glm::dmat3(world)) < 0 ? -1 : 1;
    for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        check_time();
        dvec3 p[3];
        std::array<glm::dvec2, 3> uv;
        for (size_t c = 0; c < 3; ++c) {
            const Vertex& vertex = primitive.vertices[primitive.indices[i + c]];
            p[c] = dvec3(world * glm::dvec4(vertex.position, 1));
            uv[c] = glm::dvec2(vertex.emission_uv());
        }
        const dvec3 centre = (p[0] + p[1] + p[2]) / 3.0, area = 0.5 * side * glm::cross(p[1] - p[0], p[2] - p[0]);
        GlassLamp* const nearest = near.to(centre);
        if (!nearest) continue;
        const double facing = glm::dot(area, nearest->axis), seen = facing > 0 || double_sided ? std::abs(facing) : 0;
        GlassLamp::Side& lit = facing > 0 ? nearest->front : nearest->back;
        lit.area += seen;
        lit.lamp += seen * (picture ? emitter.scale * picture->over(uv) : emitter.luminance);
    }
}

}  // namespace

void add_glass(const Scene& scene, const std::vector<glm::dmat4>& world, const std::vector<uint32_t>& materials,
               const EmitterRule& emitter, const photometry::PictureMeans* picture, std::vector<GlassLamp>& lamps) {
    std::vector<bool> shining(scene.materials.size());
    for (const uint32_t material : materials) shining[material] = true;
    const auto shines = [&](const Primitive& p) { return bool(shining[p.material]); };
    const Neighbours neighbours(scene, lamps);
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        check_time();
        if (scene.nodes[node].mesh == kNone) continue;
        const std::vector<Primitive>& primitives = scene.meshes[scene.nodes[node].mesh].primitives;
        if (std::none_of(primitives.begin(), primitives.end(), shines)) continue;
        const std::vector<GlassLamp*> beside = neighbours.of(node);
        if (beside.empty()) continue;
        for (const Primitive& p : primitives)
            if (shines(p)) add_area(p, world[node], scene.materials[p.material].double_sided, emitter, picture, beside);
    }
}

}  // namespace vesper::scene
