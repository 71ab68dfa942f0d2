#include "scene/lamp.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace vesper::scene {

glm::dvec2 cone_ramp(const Lamp& lamp) {
    if (lamp.kind == Lamp::Kind::Point) return {0, 1};
    const double outer = lamp.outer_cone, inner = std::min<double>(lamp.inner_cone, outer);
    // The difference of the cosines, as a product: between narrow cones they agree in most of their digits.
    const double difference = 2 * std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2);
    const double slope = 1 / std::max(1e-5, difference);
    return {slope, 1 - slope * std::cos(inner)};
}

glm::dmat3 lamp_frame(const glm::dmat4& node_to_world) {
    const auto unit = [](glm::dvec3 v) { return v / std::max(glm::length(v), 1e-300); };
    const glm::dvec3 x(node_to_world[0]), back = unit(glm::dvec3(node_to_world[2])),
                                          right = unit(x - glm::dot(x, back) * back);
    return {right, glm::cross(back, right), back};
}

double luminous_intensity(const Lamp& lamp, std::span<const photometry::Distribution> distributions,
                          glm::dvec3 direction) {
    const double length = glm::length(direction);
    if (!(length > 0)) return 0;
    const double cosine = -direction.z / length, candela = lamp.intensity;
    switch (lamp.kind) {
        case Lamp::Kind::Point:
            return candela;
        case Lamp::Kind::Spot: {
            const glm::dvec2 line = cone_ramp(lamp);
            const double ramp = std::clamp(line.x * cosine + line.y, 0.0, 1.0);
            return candela * ramp * ramp;
        }
        case Lamp::Kind::CosinePower:
            return cosine > 0 ? candela * std::pow(cosine, static_cast<double>(lamp.exponent)) : 0;
        case Lamp::Kind::Measured:
            return candela * photometry::intensity(distributions[lamp.distribution], direction);
        case Lamp::Kind::Directional:
            break;
    }
    return 0;
}

double luminous_flux(const Lamp& lamp) {
    const double intensity = lamp.intensity;
    switch (lamp.kind) {
        case Lamp::Kind::Point:
            return 4 * kPi * intensity;
        case Lamp::Kind::Spot: {
            // Full within the inner cone; between, the squared ramp in cos(angle), whose mean is a third.
            const auto cap = [](double angle) { return 2 * std::pow(std::sin(angle / 2), 2); };  // 1 - cos
            const double outer = cap(lamp.outer_cone), inner = std::min(cap(lamp.inner_cone), outer);
            return 2 * kPi * intensity * (inner + (outer - inner) / 3);
        }
        case Lamp::Kind::CosinePower:
            return 2 * kPi * intensity / (lamp.exponent + 1.0);
        case Lamp::Kind::Directional:
        case Lamp::Kind::Measured:  // its flux is that of its distribution
            break;
    }
    return 0;
}

double axis_luminance(const Lamp& lamp, std::span<const photometry::Distribution> distributions) {
    const double area = lamp.opening.area();
    return area > 0 ? luminous_intensity(lamp, distributions, {0, 0, -1}) / area : 0;
}

}  // namespace vesper::scene
