#include "render/shadows/casters.h"

#include <algorithm>
#include <cmath>

namespace vesper::render {
namespace {

// visibility.comp: a lookup is aside by at most so many radii of the lamp, across the way of its light and then along a
// plane on which it is ten times as long; and by so many texels, where the plane of a surface may be twice as far.
constexpr double kAside = 3 * 11, kTexelsAside = 4, kPlaneReach = 2;

}  // namespace

std::vector<HalfSpace> light_paths(const gpu_scene::View& view, glm::dvec3 lamp, double reach) {
    constexpr double kLeast = 1e-9;  // m: a lamp nearer to an edge of what is seen gives no plane with it
    const glm::dmat3 to_world = glm::transpose(glm::dmat3(view.world_to_view));
    const glm::dvec3 eye = gpu_scene::eye_of(view), to_lamp = lamp - eye;
    const glm::dvec2 low(view.tangent_low), high(view.tangent_high);
    const glm::dvec3 edges[4]{glm::normalize(to_world * glm::dvec3(low.x, low.y, -1)),
                              glm::normalize(to_world * glm::dvec3(high.x, low.y, -1)),
                              glm::normalize(to_world * glm::dvec3(high.x, high.y, -1)),
                              glm::normalize(to_world * glm::dvec3(low.x, high.y, -1))};
    std::vector<HalfSpace> spaces;
    // What holds the pyramid of all that is seen, moved so far that the lamp is in it.
    const auto add = [&](glm::dvec3 inward) {
        spaces.push_back({inward, glm::dot(inward, eye) + std::min(glm::dot(inward, to_lamp), 0.0)});
    };
    add(to_world * glm::dvec3(0, 0, -1));
    bool inside[4];  // of side k, between edges k and k + 1
    for (size_t k = 0; k < 4; ++k) {
        const glm::dvec3 inward = glm::normalize(glm::cross(edges[(k + 1) % 4], edges[k]));
        inside[k] = glm::dot(inward, to_lamp) >= 0;
        add(inward);
    }
    // The lamp sees an edge before nothing between a side that faces it and one that does not.
    for (size_t k = 0; k < 4; ++k) {
        if (inside[k] == inside[(k + 3) % 4]) continue;
        glm::dvec3 inward = glm::cross(to_lamp, edges[k]);
        if (glm::length(inward) < kLeast) continue;
        inward = glm::normalize(inward) * (glm::dot(inward, edges[(k + 2) % 4]) < 0 ? -1.0 : 1.0);
        spaces.push_back({inward, glm::dot(inward, eye)});
    }
    // lamp + reach (p - lamp) is off a plane by as much less as the lamp is before it.
    for (HalfSpace& space : spaces)
        space.offset -= (reach - 1) * std::max(glm::dot(space.inward, lamp) - space.offset, 0.0);
    return spaces;
}

bool may_lie_in(const std::vector<HalfSpace>& spaces, const gpu_scene::WorldSphere& sphere) {
    return std::ranges::all_of(spaces, [&](const HalfSpace& space) {
        return glm::dot(space.inward, sphere.centre) >= space.offset - sphere.radius;
    });
}

double intensity_towards(const gpu_scene::LampList& list, uint32_t number, glm::dvec3 to, double radius) {
    const shared::Lamp& lamp = list.lamps[number];
    const double away = glm::length(to);
    if (number >= list.counts.cones + list.counts.powers || away <= radius) return double(lamp.intensity);
    const double cosine = std::clamp(glm::dot(glm::dvec3(lamp.axis), to) / away, -1.0, 1.0);
    const double nearest = std::cos(std::max(std::acos(cosine) - std::asin(radius / away), 0.0));
    if (number >= list.counts.cones)
        return nearest > 0 ? double(lamp.intensity) * std::pow(nearest, double(lamp.lobe_a)) : 0;
    const double ramp = std::clamp(double(lamp.lobe_a) * nearest + double(lamp.lobe_b), 0.0, 1.0);
    return double(lamp.intensity) * ramp * ramp;
}

IsCaster select_casters(const CastingLamp& lamp, const gpu_scene::LampList& list, const gpu_scene::View& view,
                        bool culled) {
    std::vector<HalfSpace> paths;
    if (culled) paths = light_paths(view, lamp.position, kPlaneReach);
    const double beside = kAside * double(lamp.layout.radius);
    const double texels = kTexelsAside * 2 / (double(lamp.layout.side) * double(lamp.layout.zoom));
    const double undimmed = kFaintestLight * double(lamp.layout.range) * double(lamp.layout.range);  // cd
    const double share = undimmed / double(list.lamps[lamp.number].intensity);
    const glm::dmat3 to_view(view.world_to_view);
    const glm::dvec3 position = lamp.position;
    const double least = lamp.least_light;
    const uint32_t number = lamp.number;
    return [=, &list](const gpu_scene::WorldSphere& sphere) {
        const glm::dvec3 to = sphere.centre - position;
        const double away = glm::length(to), nearest = std::max(away - sphere.radius, 0.0);
        const double radius = sphere.radius + beside + texels * away;
        return may_lie_in(paths, {sphere.centre, radius}) &&
               share * intensity_towards(list, number, to_view * to, radius) >= least * nearest * nearest;
    };
}

}  // namespace vesper::render
