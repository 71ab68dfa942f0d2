// Surfaces that are the glass of lamps. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/photometry.h"

namespace vesper::scene {

/// m: a surface farther from a lamp than this is not its glass.
inline constexpr double kGlassReach = 1;

/// A lamp at a node of the scene, and the surfaces that are its glass.
struct GlassLamp {
    uint32_t node;
    glm::dvec3 position, axis;  // world; m, unit length
    struct Side {
        double area = 0, lamp = 0;  // emitting area, m^2, and its integral of luminance, cd
    } front, back;                  // towards the axis and away from it

    /// The side towards the axis if there is any.
    const Side& seen() const { return front.area > 0 ? front : back; }
};

/// Adds to lamps the surfaces of some materials near them: on their nodes, on parents, children and siblings of these.
/// They emit as the rule says; `picture` null: evenly.
void add_glass(const Scene&, const std::vector<glm::dmat4>& world, const std::vector<uint32_t>& materials,
               const EmitterRule& emitter, const photometry::PictureMeans* picture, std::vector<GlassLamp>& lamps);

}  // namespace vesper::scene
