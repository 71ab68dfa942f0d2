#include "scene/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vesper {

glm::dvec2 cone_ramp(const Light& light) {
    if (light.kind == Light::Kind::Point) return {0, 1};
    const double outer = light.outer_cone, inner = std::min<double>(light.inner_cone, outer);
    // The difference of the cosines, as a product: between narrow cones they agree in most of their digits.
    const double difference = 2 * std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2);
    const double slope = 1 / std::max(1e-5, difference);
    return {slope, 1 - slope * std::cos(inner)};
}

double luminous_intensity(const Light& light, std::span<const Distribution> distributions, glm::dvec3 direction) {
    const double length = glm::length(direction);
    if (!(length > 0)) return 0;
    const double cosine = -direction.z / length, candela = light.intensity;
    switch (light.kind) {
        case Light::Kind::Point:
            return candela;
        case Light::Kind::Spot: {
            const glm::dvec2 line = cone_ramp(light);
            const double ramp = std::clamp(line.x * cosine + line.y, 0.0, 1.0);
            return candela * ramp * ramp;
        }
        case Light::Kind::CosinePower:
            return cosine > 0 ? candela * std::pow(cosine, static_cast<double>(light.exponent)) : 0;
        case Light::Kind::Measured:
            return candela * intensity(distributions[light.distribution], direction);
        case Light::Kind::Directional:
            break;
    }
    return 0;
}

double luminous_flux(const Light& light) {
    constexpr double kPi = std::numbers::pi;
    const double intensity = light.intensity;
    switch (light.kind) {
        case Light::Kind::Point:
            return 4 * kPi * intensity;
        case Light::Kind::Spot: {
            // Full within the inner cone; between, the squared ramp in cos(angle), whose mean is a third.
            const auto cap = [](double angle) { return 2 * std::pow(std::sin(angle / 2), 2); };  // 1 - cos
            const double outer = cap(light.outer_cone), inner = std::min(cap(light.inner_cone), outer);
            return 2 * kPi * intensity * (inner + (outer - inner) / 3);
        }
        case Light::Kind::CosinePower:
            return 2 * kPi * intensity / (light.exponent + 1.0);
        case Light::Kind::Directional:
        case Light::Kind::Measured:  // its flux is that of its distribution
            break;
    }
    return 0;
}

double axis_luminance(const Light& light, std::span<const Distribution> distributions) {
    const double area = light.opening.area();
    return area > 0 ? luminous_intensity(light, distributions, {0, 0, -1}) / area : 0;
}

}  // namespace vesper
