#include "gpu_scene/small_emitters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "gpu_scene/luminaires.h"
#include "gpu_scene/silhouette.h"

namespace vesper::gpu_scene {
namespace {

using glm::dvec2, glm::dvec3;

// A triangle as the eye sees it.
struct Seen {
    std::array<dvec3, 3> corners;  // view frame
    Silhouette silhouette;
    dvec3 luminance;
    double widening;  // 0: it emits nothing
};

// Linear over the image: the inverse of the depth of a plane, 1/m, at a place from `origin`, px.
dvec3 inverse_depth(const std::array<dvec3, 3>& corners, dvec2 origin, const View& view) {
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const dvec2 scale(view.ray_scale()), offset(view.ray_offset());
    const dvec3 at_origin(scale * origin + offset, -1);
    return dvec3(dvec2(normal) * scale, glm::dot(normal, at_origin)) / glm::dot(normal, corners[0]);
}

// How a part lies before the eye.
struct Pose {
    glm::dmat4 to_view;
    double front;  // -1: mirrored

    dvec3 place(glm::vec3 at) const { return dvec3(to_view * glm::dvec4(at, 1)); }
    // Above 0 if the eye sees the front of a facet.
    double facing(std::span<const dvec3> c) const {
        return -front * glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), c[0]);
    }
};

// Adds what the view sees of a triangle, unless it is too large.
bool add_seen(const std::array<dvec3, 3>& corners, dvec3 luminance, double longest, const View& view,
              std::vector<Seen>& all) {
    Seen seen{corners, project(corners, view, kSmallest), luminance, 0};
    const Silhouette& s = seen.silhouette;
    if (!(s.width < kSmallEmitter) || !(s.length < longest)) return false;
    if (!std::isfinite(luminance.r + luminance.g + luminance.b)) return false;
    seen.widening = s.widening;
    if (!s.vertices.empty()) all.push_back(std::move(seen));
    return true;
}

// What the view sees of a part, if all of it is small.
std::vector<Seen> look_at(const EmittingPart& part, const Pose& pose, float dimming, const View& view) {
    const double longest = part.plain           ? std::numeric_limits<double>::infinity()
                           : part.frame.empty() ? kLongestTextured
                                                : kLongestFramed;
    std::vector<Seen> all;
    for (const EmittingPart::Triangle& triangle : part.triangles) {
        const std::array<dvec3, 3> corners{pose.place(triangle.corners[0]), pose.place(triangle.corners[1]),
                                           pose.place(triangle.corners[2])};
        const double facing = pose.facing(corners);
        if (!(facing > 0) && !(part.double_sided && facing < 0)) continue;  // seen from behind, or along it
        if (std::ranges::any_of(corners, [&](const dvec3& v) { return !(-v.z > view.near); })) return {};
        std::array<dvec3, 4> luminance;
        for (size_t i = 0; i < 4; ++i) luminance[i] = double(dimming) * dvec3(triangle.luminance[i]);
        const size_t before = all.size();
        if (!add_seen(corners, (luminance[0] + luminance[1] + luminance[2] + luminance[3]) / 4.0, longest, view, all))
            return {};
        if (part.plain || all.size() == before || all.back().silhouette.width < kOneLuminance) continue;
        all.pop_back();
        const auto parts = quarters(corners);
        for (size_t i = 0; i < 4; ++i)
            if (!add_seen(parts[i], luminance[i], longest, view, all)) return {};
    }
    if (all.empty()) return all;
    double deepest = 0;  // of what emits, m
    for (const Seen& seen : all)
        for (const dvec3& corner : seen.corners) deepest = std::max(deepest, -corner.z);
    std::vector<dvec3> corners;
    for (const std::vector<glm::vec3>& facet : part.frame) {
        corners.clear();
        for (const glm::vec3& corner : facet) corners.push_back(pose.place(corner));
        const bool behind = std::ranges::all_of(corners, [&](const dvec3& v) { return -v.z > deepest; });
        if (behind || !(pose.facing(corners) > 0)) continue;
        Seen seen{{corners[0], corners[1], corners[2]}, project(corners, view, 0), dvec3(0), 0};
        if (seen.silhouette.width < kFrameWidth && !seen.silhouette.vertices.empty()) all.push_back(std::move(seen));
    }
    return all;
}

// Whether a frame takes so many more.
bool have_room(const SilhouetteTiles& tiles, size_t listed, const std::vector<Seen>& more) {
    size_t entries = tiles.entries();
    for (const Seen& seen : more) {
        const SilhouetteTiles::Load load = tiles.load_of(seen.silhouette.vertices);
        if (load.most + more.size() > kMostSmallEmittersOfTile) return false;
        entries += load.tiles;
    }
    return entries <= kMostEntries && listed + more.size() <= kMostSmallEmitters;
}

}  // namespace

SmallEmitterList small_emitter_list(const std::vector<EmittingPart>& parts, const GpuScene& scene,
                                    const SceneFrame& frame, const View& view) {
    SmallEmitterList list;
    SilhouetteTiles tiles(view.extent);
    uint32_t number = 0, mesh = 0;
    for (const GpuScene::Placement& placement : scene.placements()) {
        ++mesh;
        Pose pose{view.world_to_view * frame.world[placement.node], 1};
        if (glm::determinant(glm::dmat3(pose.to_view)) < 0) pose.front = -1;
        for (uint32_t i = 0; i < placement.part_count; ++i, ++number) {
            const uint32_t p = placement.first_part + i;
            if (parts[p].triangles.empty()) continue;
            const Sphere sphere = sphere_of(scene.parts()[p], glm::mat4(pose.to_view));
            if (!is_seen(view, sphere)) continue;
            const std::vector<Seen> all = look_at(parts[p], pose, frame.dimming_of(placement.node), view);
            if (all.empty() || !have_room(tiles, list.emitters.size(), all)) continue;
            const float scale = sphere.radius / std::max(scene.parts()[p].radius, 1e-30f);
            for (const Seen& seen : all) {
                const SilhouetteTiles::Place place = tiles.add(seen.silhouette.vertices);
                list.emitters.push_back({glm::vec3(seen.luminance), float(place.first),
                                         glm::vec3(inverse_depth(seen.corners, place.origin, view)),
                                         float(place.vertices), place.origin, float(mesh), float(seen.widening),
                                         parts[p].reach * scale, glm::vec3(0)});
            }
            list.parts.push_back(number);
        }
    }
    static_cast<SilhouetteList&>(list) = tiles.list();
    return list;
}

}  // namespace vesper::gpu_scene
