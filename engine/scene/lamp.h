// Lamps of a scene: luminous intensity and flux, and the luminance they give their openings.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "photometry/distribution.h"
#include "scene/index.h"

namespace vesper::scene {

/// Of the disc of a directional light in the sky, degrees.
inline constexpr double kMostAngularDiameter = 10;

/// A lamp's distribution of luminous intensity about its axis (local -Z).
struct Lamp {
    enum class Kind : uint8_t { Point, Spot, CosinePower, Directional, Measured };
    std::string name;
    Kind kind = Kind::Point;
    float intensity = 0;        ///< on the axis, cd; Directional: illuminance on a surface facing it, lx; Measured:
                                ///< factor on the candela of the distribution (flux scale, maintenance factor, dimming)
    glm::vec3 colour{1};        ///< linear Rec. 709 of luminance 1: (0.212639, 0.715169, 0.072192) . colour == 1
    float inner_cone = 0;       ///< Spot: half angle of full intensity, rad
    float outer_cone = 0.785f;  ///< Spot: half angle of no intensity, rad; squared ramp between, as KHR_lights_punctual
    float exponent = 1;         ///< CosinePower: I(a) = intensity * cos(a)^exponent, 0 behind
    float angular_diameter = 0.00925f;    ///< Directional: of its disc in the sky, rad, for penumbrae; the default is
                                          ///< that of the sun and the moon, 0.53 degrees
    uint32_t distribution = kNone;        ///< Measured: index into Scene::distributions
    photometry::LuminousOpening opening;  ///< seen directly: at the lamp, facing its axis (Point: facing the eye); m,
                                          ///< independent of the node's scale. Length along its X, width along its Y.
                                          ///< Not drawn if the area is 0
};

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
