// The reference line of a road seen from above (OpenDRIVE planView). SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vesper::roads {

/// One geometry of a reference line. All lengths m, headings rad counter-clockwise from +x, curvatures 1/m (positive:
/// to the left).
struct PlanGeometry {
    enum class Kind : uint8_t { Line, Arc, Spiral, Poly3, ParamPoly3 };
    Kind kind = Kind::Line;
    double s = 0;                      ///< its start along the road
    double x = 0, y = 0, heading = 0;  ///< of its first point
    double length = 0;
    double curvature = 0, curvature_end = 0;  ///< Arc: the first; Spiral: linear between the two
    std::array<double, 4> u{0, 1, 0, 0};      ///< ParamPoly3: a, b, c, d of u(p), along the first tangent
    std::array<double, 4> v{};                ///< Poly3: of v(u); ParamPoly3: of v(p), to the left
    double p_end = 0;                         ///< ParamPoly3: of p at the end, 1 or the length; Poly3: of u
    std::vector<double> lengths;  ///< of the polynomials: arc length at p = i p_end / (size - 1), see measure()
};

struct PlanPoint {
    double x = 0, y = 0;
    double heading = 0;    ///< rad
    double curvature = 0;  ///< 1/m
};

/// Tabulates the arc length of polynomials, and for Poly3 finds the u at which `length` ends; must be called before
/// plan_point. Returns the arc length from p = 0 to p_end: for ParamPoly3 it should be `length`.
double measure(PlanGeometry& geometry);

/// The point `distance` m along a geometry; beyond its ends straight on. Arc lengths of ParamPoly3 are scaled so that
/// p_end lies at `length`.
PlanPoint plan_point(const PlanGeometry& geometry, double distance);

}  // namespace vesper::roads
