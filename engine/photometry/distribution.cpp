// Intensity and luminous flux of measured distributions. SPDX-License-Identifier: MIT
#include "photometry/distribution.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace vesper::photometry {
namespace {

constexpr double kRounding = 1e-9;  // deg: a direction computed for the last angle may end up beyond it

/// Where an angle lies between two of a list: weight of the upper one. Not found outside the list.
struct Between {
    size_t low = 0, high = 0;
    double weight = 0;
    bool found = false;
};

Between locate(const std::vector<double>& angles, double angle) {
    if (angles.empty() || !(angle >= angles.front() - kRounding && angle <= angles.back() + kRounding)) return {};
    angle = std::clamp(angle, angles.front(), angles.back());
    const auto above = std::upper_bound(angles.begin(), angles.end(), angle);
    if (above == angles.end()) return {angles.size() - 1, angles.size() - 1, 0, true};
    const auto high = static_cast<size_t>(above - angles.begin());
    const double width = angles[high] - angles[high - 1];
    return {high - 1, high, (angle - angles[high - 1]) / width, true};
}

/// The integral of the line from (a, at_a) to (b, at_b) times sin, angles in rad.
double line_times_sine(double a, double b, double at_a, double at_b) {
    const double width = b - a;
    const double plain = 2 * std::sin((a + b) / 2) * std::sin(width / 2);                         // cos a - cos b
    const double moment = 2 * std::cos((a + b) / 2) * std::sin(width / 2) - width * std::cos(b);  // of (x - a) sin x
    return at_a * plain + (at_b - at_a) * (moment / width);
}

/// The exact integral of a piecewise linear function over angles from a pole, or from the equator (`pole` = -90).
template <class Value>
double integral_from_pole(const std::vector<double>& degrees, double pole, Value&& value) {
    double sum = 0;
    for (size_t i = 1; i < degrees.size(); ++i)
        sum += line_times_sine((degrees[i - 1] - pole) * kRadiansPerDegree, (degrees[i] - pole) * kRadiansPerDegree,
                               value(i - 1), value(i));
    return sum;
}

template <class Value>
double integral(const std::vector<double>& degrees, Value&& value) {
    double sum = 0;
    for (size_t i = 1; i < degrees.size(); ++i)
        sum += (degrees[i] - degrees[i - 1]) * kRadiansPerDegree * (value(i - 1) + value(i)) / 2;
    return sum;
}

}  // namespace

double LuminousOpening::area() const { return length > 0 && width > 0 ? length * width * (round ? kPi / 4 : 1) : 0; }

double intensity(const Distribution& d, glm::dvec3 direction) {
    if (!(glm::length(direction) > 0)) return 0;
    const double right = direction.x, up = direction.y, forward = -direction.z;
    double horizontal = 0, vertical = 0;
    switch (d.goniometry) {
        case Goniometry::CGamma:
            vertical = std::atan2(std::hypot(right, up), forward) / kRadiansPerDegree;
            if (d.horizontal.size() > 1) horizontal = std::atan2(up, right) / kRadiansPerDegree;
            if (horizontal < 0) horizontal += 360;
            break;
        case Goniometry::TypeB:
            horizontal = std::atan2(right, std::hypot(up, forward)) / kRadiansPerDegree;
            vertical = std::atan2(up, forward) / kRadiansPerDegree;
            break;
        case Goniometry::TypeA:
            horizontal = std::atan2(right, forward) / kRadiansPerDegree;
            vertical = std::atan2(up, std::hypot(right, forward)) / kRadiansPerDegree;
            break;
    }
    const Between h = locate(d.horizontal, horizontal), v = locate(d.vertical, vertical);
    if (!h.found || !v.found) return 0;
    return glm::mix(glm::mix(d.at(h.low, v.low), d.at(h.low, v.high), v.weight),
                    glm::mix(d.at(h.high, v.low), d.at(h.high, v.high), v.weight), h.weight);
}

double luminous_flux(const Distribution& d) {
    if (d.goniometry == Goniometry::TypeB)  // dOmega = cos H dH dV
        return integral(d.vertical, [&](size_t v) {
            return integral_from_pole(d.horizontal, -90, [&](size_t h) { return d.at(h, v); });
        });
    const double pole = d.goniometry == Goniometry::TypeA ? -90 : 0;  // cos V dV dH, sin gamma dgamma dC
    const auto half_plane = [&](size_t h) {
        return integral_from_pole(d.vertical, pole, [&](size_t v) { return d.at(h, v); });
    };
    if (d.goniometry == Goniometry::CGamma && d.horizontal.size() == 1) return 2 * kPi * half_plane(0);
    return integral(d.horizontal, half_plane);
}

double largest_intensity(const Distribution& d) {
    return d.candela.empty() ? 0 : *std::max_element(d.candela.begin(), d.candela.end());
}

}  // namespace vesper::photometry
