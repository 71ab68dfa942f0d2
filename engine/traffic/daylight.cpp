#include "traffic/daylight.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vesper::traffic {
namespace {

// log10 of lx as a cubic of the elevation over 90 degrees, from each elevation up.
struct Piece {
    double from;
    std::array<double, 4> factors;
};
constexpr Piece kPieces[]{{20, {3.74, 3.97, -4.07, 1.47}},         {5, {3.05, 13.28, -45.98, 64.33}},
                          {-0.8, {2.88, 22.26, -207.64, 1034.30}}, {-5, {2.88, 21.81, -258.11, -858.36}},
                          {-12, {2.70, 12.17, -431.69, -1899.83}}, {-18, {13.84, 262.72, 1447.42, 2797.93}}};

}  // namespace

double daylight_illuminance(double sun_elevation) {
    const double elevation = std::clamp(sun_elevation, -18.0, 90.0), x = elevation / 90;
    const Piece* piece = std::begin(kPieces);
    while (elevation < piece->from) ++piece;
    const auto& f = piece->factors;
    return std::pow(10, f[0] + x * (f[1] + x * (f[2] + x * f[3])));
}

double daylight_temperature(double sun_elevation) { return 6500 + 5500 * std::clamp(-sun_elevation / 6, 0.0, 1.0); }

}  // namespace vesper::traffic
