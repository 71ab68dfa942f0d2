// SPDX-License-Identifier: MIT
#include "io/primaries.h"

#include <cmath>

#include "base/error.h"

namespace vesper::io {
namespace {

/// Columns are X, Y, Z of the primaries. Nothing is divided by a primary's y, which is 0 for X and Z.
glm::dmat3 to_xyz(const Primaries& p) {
    const auto xyz = [](glm::dvec2 c) { return glm::dvec3(c, 1 - c.x - c.y); };
    const glm::dmat3 directions(xyz(p.red), xyz(p.green), xyz(p.blue));
    const double volume = glm::determinant(directions);
    const glm::dvec3 amounts = glm::inverse(directions) * (xyz(p.white) / p.white.y);
    const bool sound = std::abs(volume) > 1e-6 && p.white.y > 1e-6 &&
                       std::isfinite(amounts.x + amounts.y + amounts.z) && amounts.x != 0 && amounts.y != 0 &&
                       amounts.z != 0;
    if (!sound) throw Error("its primaries are no base of colours");
    return {directions[0] * amounts.x, directions[1] * amounts.y, directions[2] * amounts.z};
}

}  // namespace

bool make_white(const Primaries& p) {
    const auto side = [&](glm::dvec2 a, glm::dvec2 b) {
        return (b.x - a.x) * (p.white.y - a.y) - (b.y - a.y) * (p.white.x - a.x);
    };
    const double r = side(p.red, p.green), g = side(p.green, p.blue), b = side(p.blue, p.red);
    return (r > 0 && g > 0 && b > 0) || (r < 0 && g < 0 && b < 0);
}

glm::dmat3 to_rec709(const Primaries& primaries) { return glm::inverse(to_xyz(kRec709)) * to_xyz(primaries); }

}  // namespace vesper::io
