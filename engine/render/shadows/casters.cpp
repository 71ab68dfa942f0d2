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
    // Of the angles to the middle of the sphere, and between this and its edge.
    const double cosine = std::clamp(glm::dot(glm::dvec3(lamp.axis), to) / away, -1.0, 1.0), edge_sine = radius / away,
                 edge_cosine = std::sqrt(1 - edge_sine * edge_sine);
    const double nearest =
        cosine >= edge_cosine ? 1 : cosine * edge_cosine + std::sqrt(1 - cosine * cosine) * edge_sine;
    if (number >= list.counts.cones)
        return nearest > 0 ? double(lamp.intensity) * std::pow(nearest, double(lamp.lobe_a)) : 0;
    const double ramp = std::clamp(double(lamp.lobe_a) * nearest + double(lamp.lobe_b), 0.0, 1.0);
    return double(lamp.intensity) * ramp * ramp;
}

IsCaster::IsCaster(const CastingLamp& lamp, const gpu_scene::LampList& list, const gpu_scene::View& view, bool culled)
    : list_(&list),
      number_(lamp.number),
      position_(lamp.position),
      to_view_(view.world_to_view),
      beside_(kAside * double(lamp.layout.radius)),
      texels_(kTexelsAside * 2 / (double(lamp.layout.side) * double(lamp.layout.zoom))),
      least_(lamp.least_light) {
    if (culled) paths_ = light_paths(view, lamp.position, kPlaneReach);
    const double undimmed = kFaintestLight * double(lamp.layout.range) * double(lamp.layout.range);  // cd
    share_ = undimmed / double(list.lamps[lamp.number].intensity);
}

// Of spheres within it: room that grows with the distance does not bring them before a plane that leaves it out, since
// the lamp is on the other side of it.
bool IsCaster::operator()(const gpu_scene::WorldSphere& sphere) const {
    if (!list_) return true;
    const glm::dvec3 to = sphere.centre - position_;
    const double away = glm::length(to), nearest = std::max(away - sphere.radius, 0.0);
    const double radius = sphere.radius + beside_ + texels_ * away, wanted = least_ * nearest * nearest;
    return share_ * double(list_->lamps[number_].intensity) >= wanted && may_lie_in(paths_, {sphere.centre, radius}) &&
           share_ * intensity_towards(*list_, number_, to_view_ * to, radius) >= wanted;
}

}  // namespace vesper::render
