// A piece of surface, as what lights it is chosen for. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <glm/glm.hpp>

namespace vesper::transport {

/// A place on a surface, in the world.
struct SurfacePlace {
    glm::dvec3 point{0};   ///< m
    glm::dvec3 normal{0};  ///< unit length
    uint32_t node = 0;     ///< that has it
};

/// Bounds of places beside each other: lights are weighed for all of them at once. What lights any of them has a weight
/// above 0.
struct Patch {
    glm::dvec3 middle{0}, half{0};  ///< of the box around them, m
    glm::dvec3 normal{0};           ///< mean
    double turned = 0;              ///< how far from it normals are, at most

    /// `places`: one at least.
    static Patch around(std::span<const SurfacePlace> places) {
        Patch patch;
        glm::dvec3 low(places[0].point), high(low);
        for (const SurfacePlace& place : places) {
            low = glm::min(low, place.point), high = glm::max(high, place.point);
            patch.normal += place.normal / double(places.size());
        }
        for (const SurfacePlace& place : places)
            patch.turned = glm::max(patch.turned, glm::distance(place.normal, patch.normal));
        patch.middle = 0.5 * (low + high), patch.half = 0.5 * (high - low);
        return patch;
    }
    /// How far places are from the middle at most: in any direction, and along the mean normal; m.
    double across() const { return glm::length(half); }
    double thick() const { return glm::dot(half, glm::abs(normal)); }
};

}  // namespace vesper::transport
