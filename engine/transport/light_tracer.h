// All the light that a point gets, by its origin: paths of rays on the host. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "transport/emitters.h"
#include "transport/lamp_light.h"
#include "transport/surfaces.h"

namespace vesper::transport {

/// Ways of light to a point.
enum class Origin : uint8_t {
    Lamps,     ///< directly
    Emitters,  ///< surfaces with an emission, directly
    Sky,       ///< directly
    Once,      ///< of all of these, reflected once
    More,      ///< reflected twice or more
};
constexpr size_t kOrigins = 5;

/// Illuminance on a surface by origin.
struct Illuminance {
    std::array<glm::dvec3, kOrigins> rgb{};         ///< lx
    std::array<double, kOrigins> standard_error{};  ///< of the luminance of each, lx; Lamps: 0, they are summed up
    double standard_error_of_sum = 0;               ///< lx; origins share paths

    glm::dvec3 operator[](Origin origin) const { return rgb[size_t(origin)]; }
    glm::dvec3 sum() const;
};

struct TraceSettings {
    uint32_t paths = 16'384;
    uint32_t most_reflections = 32;  ///< light that is reflected more often counts as absorbed
    double threshold = 1e-3;         ///< illuminance below which a lamp counts as dark, lx
    uint32_t lamp_rays = 0;  ///< shadow rays to lamps from each place that reflects, by chance and without threshold;
                             ///< 0: one to each lamp
    uint64_t seed = 1;       ///< the same gives the same result
};

/// Light in a scene whose surfaces are matt (SurfacePoint): from a point paths go in directions distributed as cosines,
/// and on from each surface that they meet, which sends the light that it emits and that it gets from lamps (Kajiya
/// 1986). Points look at emitting triangles as well, and each way to them counts by how likely it was (Veach and Guibas
/// 1995). Estimates have no bias but for `most_reflections` and the threshold; their error falls with the
/// root of the number of paths. Lamps are points, seen by shadow rays; the ambient constant of the scene is no light
/// here.
class LightTracer {
public:
    /// The scene with its nodes at `world`. Keeps references to both.
    LightTracer(const scene::Scene& scene, std::span<const glm::dmat4> world);
    LightTracer(scene::Scene&&, std::span<const glm::dmat4>) = delete;
    LightTracer(const LightTracer&) = delete;
    LightTracer& operator=(const LightTracer&) = delete;

    /// At a point (m, world) of a surface with the unit normal `normal`. Throws Error if the time of a Budget is over.
    Illuminance at(glm::dvec3 point, glm::dvec3 normal, const TraceSettings& settings = {}) const;

private:
    glm::dvec3 sky(glm::dvec3 direction) const;
    struct Way;
    double cosine_share(const Way& way, size_t number, glm::dvec3 to) const;
    glm::dvec3 look_at_emitter(const Way& way, glm::dvec2 chance) const;
    glm::dvec3 light_of_lamps(const SurfacePoint& surface, uint32_t node, const TraceSettings& settings,
                              Random& random) const;
    double weight_of_hit(const Way& way, const rays::Hit& hit, const SurfacePoint& surface) const;

    const scene::Scene& scene_;
    rays::RayCaster rays_;
    Surfaces surfaces_;
    Emitters emitters_;
    EmitterChoice by_power_;
    LampLight lamps_;
};

}  // namespace vesper::transport
