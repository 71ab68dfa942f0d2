// Tables of retroreflection. SPDX-License-Identifier: MIT
#include "photometry/retroreflection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace vesper::photometry {
namespace {

double cos_of(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

void check_angles(const char* what, const std::vector<double>& angles, const std::vector<double>& values,
                  size_t least) {
    if (angles.size() < least || angles.size() > kMaxRetroNodes)
        throw Error(std::string(what) + ": " + std::to_string(least) + " to " + std::to_string(kMaxRetroNodes) +
                    " angles are wanted");
    if (values.size() != angles.size()) throw Error(std::string(what) + ": as many values as angles are wanted");
    for (size_t i = 0; i < angles.size(); ++i)
        if (!(angles[i] >= 0 && angles[i] <= 90) || (i > 0 && !(angles[i] > angles[i - 1])))
            throw Error(std::string(what) + ": angles must ascend within 0 and 90 degrees");
}

}  // namespace

Retroreflector retroreflective_class(const std::string& name) {
    // Least values of new white sheets at an entrance angle of 5 degrees. At 30 degrees 30 of 70 and 150 of 250 are
    // left (EN 12899-1); the fall to 0 at 80 degrees is ours.
    if (name == "RA1") return {name, {0.2, 0.33, 2}, {70, 50, 5}, {5, 30, 50, 80}, {1, 0.43, 0.15, 0}};
    if (name == "RA2") return {name, {0.2, 0.33, 2}, {250, 180, 5}, {5, 30, 50, 80}, {1, 0.6, 0.15, 0}};
    if (name == "prismatic" || name == "RA3")
        return {name, {0.2, 0.5, 1}, {580, 420, 120}, {5, 30, 50, 80}, {1, 0.6, 0.15, 0}};
    throw Error("is none of RA1, RA2, RA3 and prismatic");
}

Retroreflector retroreflective_marking(double r_l_mcd) {
    // Headlamps 0.65 m and eyes 1.2 m high see a marking under 1.05 degrees at 30 m, 2.1 at 15 m. How beads fall off
    // beyond is an assumption: to a tenth at 6 degrees.
    const double r_l = r_l_mcd / 1000;
    return {"R_L", {2, 6}, {r_l, r_l / 10}, {90}, {1}, true};
}

Retroreflector rescaled(Retroreflector r, double factor) {
    for (double& value : r.coefficient) value *= factor;
    return r;
}

void check_retroreflector(const Retroreflector& r) {
    check_angles("observation", r.observation, r.coefficient, 2);
    check_angles("entrance", r.entrance, r.entrance_factor, 1);
    for (const double value : r.coefficient)
        if (!(value >= 1e-6 && value <= 1e5))
            throw Error("observation: coefficients must be within 1e-6 and 1e5 cd/(lx m^2)");
    if (!(r.coefficient.back() < r.coefficient[r.coefficient.size() - 2]))
        throw Error(
            "observation: the last coefficient must be less than the one before, since it goes on falling like that");
    for (const double value : r.entrance_factor)
        if (!(value >= 0 && value <= 1)) throw Error("entrance: factors must be within 0 and 1");
}

double retroreflection(const Retroreflector& r, double observation, double entrance) {
    size_t i = 0;
    while (i + 2 < r.observation.size() && observation > r.observation[i + 1]) ++i;
    const double slope = std::log(r.coefficient[i + 1] / r.coefficient[i]) / (r.observation[i + 1] - r.observation[i]);
    const double peak =
        r.coefficient[i] * std::exp(slope * (std::max(observation, r.observation[0]) - r.observation[i]));
    if (entrance <= r.entrance.front()) return peak * r.entrance_factor.front();
    if (entrance >= r.entrance.back())
        return peak * r.entrance_factor.back() *
               (r.entrance.back() < 90 ? std::max(cos_of(entrance), 0.0) / cos_of(r.entrance.back()) : 1);
    size_t k = 0;
    while (entrance > r.entrance[k + 1]) ++k;
    const double from = cos_of(r.entrance[k]), to = cos_of(r.entrance[k + 1]),
                 t = (cos_of(entrance) - from) / (to - from);
    return peak * (r.entrance_factor[k] + t * (r.entrance_factor[k + 1] - r.entrance_factor[k]));
}

double retroreflected_luminance(const Retroreflector& r, double observation, double entrance, double view,
                                double illuminance) {
    const double coefficient = retroreflection(r, observation, entrance);
    return coefficient * illuminance / (r.marking ? 1 : std::max(cos_of(view), 0.05));
}

}  // namespace vesper::photometry
