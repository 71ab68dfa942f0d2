#include "scene/light.h"

#include <algorithm>
#include <cmath>

namespace vesper {

double luminous_intensity(const Light& light, std::span<const Distribution> distributions, glm::dvec3 direction) {
    const double length = glm::length(direction);
    if (!(length > 0)) return 0;
    const double cosine = -direction.z / length, candela = light.intensity;
    switch (light.kind) {
        case Light::Kind::Point:
            return candela;
        case Light::Kind::Spot: {
            // The ramp of KHR_lights_punctual; cones that coincide get an edge of 1e-5 in the cosine, as in shading.
            const double outer = light.outer_cone, inner = std::min<double>(light.inner_cone, outer);
            const double width = std::max(1e-5, 2 * std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2));
            const double ramp = std::clamp(1 + (cosine - std::cos(inner)) / width, 0.0, 1.0);
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

double axis_luminance(const Light& light, std::span<const Distribution> distributions) {
    const double area = light.opening.area();
    return area > 0 ? luminous_intensity(light, distributions, {0, 0, -1}) / area : 0;
}

std::string deviation(double factor) {
    const long percent = std::lround(100 * std::abs(factor - 1));
    return factor > 3 ? std::to_string(std::lround(factor)) + " times as much"
                      : std::to_string(percent) + (factor < 1 ? " % less" : " % more");
}

}  // namespace vesper
