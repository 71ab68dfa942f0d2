// Points of reference lines. SPDX-License-Identifier: MIT
#include "roads/plan_curve.h"

#include <algorithm>
#include <cmath>

namespace vesper::roads {
namespace {

// Gauss-Legendre, 8 points on [-1, 1]: exact for polynomials of degree 15.
constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};

/// The integral of f over [a, b] in `panels` equal parts; f gives whatever can be added and scaled.
template <class Function>
auto integral(Function&& f, double a, double b, int panels) {
    auto sum = f(a) * 0.0;
    const double half = (b - a) / (2 * panels);
    for (int panel = 0; panel < panels; ++panel) {
        const double middle = a + half * (2 * panel + 1);
        for (size_t i = 0; i < kNode.size(); ++i)
            sum = sum + (f(middle - half * kNode[i]) + f(middle + half * kNode[i])) * (kWeight[i] * half);
    }
    return sum;
}

struct Vector {
    double x, y;
    Vector operator+(Vector o) const { return {x + o.x, y + o.y}; }
    Vector operator*(double k) const { return {x * k, y * k}; }
};

double cubic(const std::array<double, 4>& c, double p) { return c[0] + p * (c[1] + p * (c[2] + p * c[3])); }
double slope(const std::array<double, 4>& c, double p) { return c[1] + p * (2 * c[2] + p * 3 * c[3]); }
double second_derivative(const std::array<double, 4>& c, double p) { return 2 * c[2] + 6 * p * c[3]; }

double speed(const PlanGeometry& g, double p) { return std::hypot(slope(g.u, p), slope(g.v, p)); }

/// Arc length from the table's node before p to p.
double beyond(const PlanGeometry& g, double from, double p) {
    return integral([&](double at) { return speed(g, at); }, from, p, 1);
}

/// The p at an arc length: the table, then Newton on the length within its cell.
double parameter_at(const PlanGeometry& g, double arc) {
    const size_t cells = g.lengths.size() - 1;
    const auto above = std::upper_bound(g.lengths.begin() + 1, g.lengths.end() - 1, arc);
    const auto cell = static_cast<size_t>(above - g.lengths.begin()) - 1;
    const double width = g.p_end / static_cast<double>(cells), from = width * static_cast<double>(cell);
    const double have = g.lengths[cell], span = g.lengths[cell + 1] - have;
    double p = span > 0 ? from + width * (arc - have) / span : from;
    for (int i = 0; i < 4; ++i) {
        const double v = speed(g, p);
        if (!(v > 1e-9)) break;
        p = std::clamp(p - (have + beyond(g, from, p) - arc) / v, from, from + width);
    }
    return p;
}

/// The integral of the unit tangent: Fresnel's integrals for any curvature and rate of it. Panels turn by at most 1
/// rad, where 16th order leaves less than 1e-14 of their length.
Vector clothoid(double curvature, double rate, double length) {
    const auto heading = [&](double s) { return s * (curvature + s * rate / 2); };
    // The most it can turn, also where it turns back.
    const double turn = (std::abs(curvature) + std::abs(rate * length) / 2) * std::abs(length);
    const int panels = std::clamp(static_cast<int>(std::ceil(turn)), 1, 4096);
    return integral([&](double s) { return Vector{std::cos(heading(s)), std::sin(heading(s))}; }, 0, length, panels);
}

PlanPoint placed(const PlanGeometry& g, double u, double v, double turn, double curvature) {
    const double c = std::cos(g.heading), s = std::sin(g.heading);
    return {g.x + u * c - v * s, g.y + u * s + v * c, g.heading + turn, curvature};
}

PlanPoint polynomial_point(const PlanGeometry& g, double distance) {
    const double scale = g.kind == PlanGeometry::Kind::ParamPoly3 && g.length > 0 ? g.lengths.back() / g.length : 1;
    const double p = parameter_at(g, distance * scale);
    const double du = slope(g.u, p), dv = slope(g.v, p), v = std::hypot(du, dv);
    const double curvature =
        v > 1e-9 ? (du * second_derivative(g.v, p) - dv * second_derivative(g.u, p)) / (v * v * v) : 0;
    return placed(g, cubic(g.u, p), cubic(g.v, p), std::atan2(dv, du), curvature);
}

PlanPoint inside(const PlanGeometry& g, double distance) {
    switch (g.kind) {
        case PlanGeometry::Kind::Line:
            return placed(g, distance, 0, 0, 0);
        case PlanGeometry::Kind::Arc: {
            const double turn = g.curvature * distance;
            // sin(x)/x and its like, without loss where the curvature is small.
            const double half = turn / 2, chord = std::abs(half) > 1e-6 ? distance * std::sin(half) / half : distance;
            return placed(g, chord * std::cos(half), chord * std::sin(half), turn, g.curvature);
        }
        case PlanGeometry::Kind::Spiral: {
            const double rate = g.length > 0 ? (g.curvature_end - g.curvature) / g.length : 0;
            const Vector end = clothoid(g.curvature, rate, distance);
            return placed(g, end.x, end.y, distance * (g.curvature + distance * rate / 2),
                          g.curvature + rate * distance);
        }
        default:
            return polynomial_point(g, distance);
    }
}

}  // namespace

double measure(PlanGeometry& g) {
    constexpr size_t kCells = 64;
    if (g.kind != PlanGeometry::Kind::Poly3 && g.kind != PlanGeometry::Kind::ParamPoly3) return g.length;
    const bool graph = g.kind == PlanGeometry::Kind::Poly3;
    if (graph) g.u = {0, 1, 0, 0}, g.p_end = g.length;  // v(u) is never shorter than u
    g.lengths.assign(kCells + 1, 0);
    const double width = g.p_end / kCells;
    for (size_t i = 0; i < kCells; ++i)
        g.lengths[i + 1] = g.lengths[i] + beyond(g, width * static_cast<double>(i), width * static_cast<double>(i + 1));
    if (graph) {
        g.p_end = parameter_at(g, g.length);
        for (size_t i = 0; i < kCells; ++i) {
            const double step = g.p_end / kCells;
            g.lengths[i + 1] =
                g.lengths[i] + beyond(g, step * static_cast<double>(i), step * static_cast<double>(i + 1));
        }
    }
    return g.lengths.back();
}

PlanPoint plan_point(const PlanGeometry& geometry, double distance) {
    const double within = std::clamp(distance, 0.0, geometry.length);
    PlanPoint point = inside(geometry, within);
    const double past = distance - within;
    if (past != 0)
        point.x += past * std::cos(point.heading), point.y += past * std::sin(point.heading), point.curvature = 0;
    return point;
}

}  // namespace vesper::roads
