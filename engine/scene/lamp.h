// Luminous intensity and flux of a scene's lamps, and the luminance they give their openings.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "scene/scene.h"

namespace vesper::scene {

/// Intensity of a lamp in a direction of its own frame (axis -Z, right +X, up +Y; any length), cd. A directional light
/// has none: 0.
double luminous_intensity(const Lamp& lamp, std::span<const photometry::Distribution> distributions,
                          glm::dvec3 direction);

/// Directions of a lamp's frame to the world, from where its node is: at right angles, whatever the scale; the axis is
/// kept, then the direction to the right.
glm::dmat3 lamp_frame(const glm::dmat4& node_to_world);

/// Luminous flux of a lamp, lm: its intensity integrated over all directions. Not of Measured: see distribution.h.
double luminous_flux(const Lamp& lamp);

/// Slope a and offset b of KHR_lights_punctual's ramp in the cosine c to a lamp's axis, clamp(a c + b, 0, 1): 1 within
/// the inner cone, 0 beyond the outer; intensity goes with its square. A point lamp is 1 in every direction. Cones that
/// coincide get an edge of 1e-5 in the cosine, outwards.
glm::dvec2 cone_ramp(const Lamp& lamp);

/// Luminance of its opening seen along its axis, L = I / A, cd/m^2; 0 without opening.
double axis_luminance(const Lamp& lamp, std::span<const photometry::Distribution> distributions);

}  // namespace vesper::scene
