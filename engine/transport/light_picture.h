// Light of many points, such as those that the pixels of a picture see. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "transport/light_tracer.h"

namespace vesper::transport {

/// A point of a surface.
struct LitPoint {
    glm::dvec3 point{0};   ///< m, world
    glm::dvec3 normal{0};  ///< unit length; 0: there is no surface, and no light
};

/// Illuminance as a picture keeps it.
struct PointLight {
    std::array<glm::vec3, kOrigins> lux{};  ///< by Origin, RGB
    float standard_error = 0;               ///< of the luminance of other(), lx

    glm::vec3 operator[](Origin origin) const { return lux[size_t(origin)]; }
    glm::vec3 other() const;  ///< than of lamps directly
};

/// LightTracer::at each of the points, with a seed of its own, so that errors of neighbours have nothing in common. On
/// all processors; the same points give the same light, whatever the number of threads. `progress` is called now and
/// then with shares from 0 to 1, from this thread; where it returns false the work ends and the result is empty. Throws
/// Error if the time of a Budget is over.
std::vector<PointLight> light_of(const LightTracer& tracer, std::span<const LitPoint> points,
                                 const TraceSettings& settings, const std::function<bool(double)>& progress = {});

}  // namespace vesper::transport
