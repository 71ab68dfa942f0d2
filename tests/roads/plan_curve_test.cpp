// Reference lines against closed forms and series. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "roads/plan_curve.h"

namespace vesper::test {

using roads::PlanGeometry, roads::plan_point;

namespace {

/// Fresnel's integrals of cos and sin(pi u^2 / 2) by their power series (Abramowitz and Stegun 7.3.11, 7.3.13): another
/// way than the code's quadrature.
std::pair<double, double> fresnel(double x) {
    double c = 0, s = 0, factor = 1;
    const double q = M_PI / 2;
    for (int n = 0; n < 60; ++n) {
        const double even = factor * std::pow(q, 2 * n) * std::pow(x, 4 * n + 1) / (4 * n + 1);
        c += (n % 2 ? -1 : 1) * even;
        s += (n % 2 ? -1 : 1) * factor * std::pow(q, 2 * n + 1) / (2 * n + 1) * std::pow(x, 4 * n + 3) / (4 * n + 3);
        factor /= (2.0 * n + 1) * (2.0 * n + 2);
    }
    return {c, s};
}

PlanGeometry spiral(double start, double end, double length) {
    return {.kind = PlanGeometry::Kind::Spiral, .length = length, .curvature = start, .curvature_end = end};
}

// 1e-9 m: both are exact to rounding.
TEST(PlanCurve, ClothoidsAreFresnelsIntegrals) {
    for (const double length : {10.0, 60.0, 120.0}) {
        const PlanGeometry g = spiral(0, 0.025, length);
        const double rate = 0.025 / length, scale = std::sqrt(M_PI / rate);
        for (double d = 0; d <= length; d += length / 7) {
            const roads::PlanPoint p = plan_point(g, d);
            const auto [c, s] = fresnel(d / scale);
            EXPECT_NEAR(p.x, scale * c, 1e-9) << length << " " << d;
            EXPECT_NEAR(p.y, scale * s, 1e-9) << length << " " << d;
            EXPECT_NEAR(p.heading, rate * d * d / 2, 1e-12);
            EXPECT_NEAR(p.curvature, rate * d, 1e-12);
        }
    }
}

TEST(PlanCurve, ClothoidsEndWhereTheirMirrorImageBegins) {
    const PlanGeometry in = spiral(0.02, -0.01, 80);
    const roads::PlanPoint end = plan_point(in, 80);
    PlanGeometry back = spiral(0.01, -0.02, 80);
    back.x = end.x, back.y = end.y, back.heading = end.heading + M_PI;
    const roads::PlanPoint home = plan_point(back, 80);
    EXPECT_NEAR(home.x, 0, 1e-9);
    EXPECT_NEAR(home.y, 0, 1e-9);
    EXPECT_NEAR(std::remainder(home.heading - M_PI, 2 * M_PI), 0, 1e-12);
}

TEST(PlanCurve, ClothoidsOfOneCurvatureAreArcsAndArcsOfNoneAreLines) {
    const PlanGeometry arc{
        .kind = PlanGeometry::Kind::Arc, .x = 3, .y = -2, .heading = 0.7, .length = 200, .curvature = -0.03};
    PlanGeometry same = spiral(-0.03, -0.03, 200);
    same.x = 3, same.y = -2, same.heading = 0.7;
    const double radius = 1 / 0.03;
    for (double d = 0; d <= 200; d += 13) {
        const roads::PlanPoint a = plan_point(arc, d), b = plan_point(same, d);
        EXPECT_NEAR(a.x, b.x, 1e-9);
        EXPECT_NEAR(a.y, b.y, 1e-9);
        EXPECT_NEAR(std::hypot(a.x - (3 + radius * std::sin(0.7)), a.y - (-2 - radius * std::cos(0.7))), radius, 1e-9);
    }
    for (const double tiny : {0.0, 1e-15, 1e-9}) {
        const roads::PlanPoint p = plan_point({.kind = PlanGeometry::Kind::Arc, .length = 100, .curvature = tiny}, 100);
        EXPECT_NEAR(p.x, 100, 1e-9);
        EXPECT_NEAR(p.y, tiny * 5000, 1e-9);
    }
}

TEST(PlanCurve, LinesGoOnStraightBeyondTheirEnds) {
    const PlanGeometry line{.kind = PlanGeometry::Kind::Line, .x = 1, .y = 2, .heading = M_PI / 2, .length = 10};
    EXPECT_NEAR(plan_point(line, 12).y, 14, 1e-12);
    EXPECT_NEAR(plan_point(line, -3).y, -1, 1e-12);
    EXPECT_NEAR(plan_point(line, 12).x, 1, 1e-12);
}

/// The arc length of v = u^2 / (2 r) from 0 to u: r / 2 (w sqrt(1 + w^2) + asinh w), w = u / r.
double parabola(double u, double r) {
    const double w = u / r;
    return r / 2 * (w * std::sqrt(1 + w * w) + std::asinh(w));
}

TEST(PlanCurve, PolynomialsRunByArcLength) {
    constexpr double kRadius = 50, kEnd = 60;
    const double length = parabola(kEnd, kRadius);
    PlanGeometry graph{.kind = PlanGeometry::Kind::Poly3, .length = length};
    graph.v = {0, 0, 1 / (2 * kRadius), 0};
    EXPECT_NEAR(roads::measure(graph), length, 1e-9);
    PlanGeometry by_length{.kind = PlanGeometry::Kind::ParamPoly3, .length = length};
    by_length.u = {0, 1, 0, 0}, by_length.v = graph.v, by_length.p_end = kEnd;
    EXPECT_NEAR(roads::measure(by_length), length, 1e-9);
    PlanGeometry normalized = by_length;
    normalized.u = {0, kEnd, 0, 0}, normalized.v = {0, 0, kEnd * kEnd / (2 * kRadius), 0}, normalized.p_end = 1;
    EXPECT_NEAR(roads::measure(normalized), length, 1e-9);
    for (double u = 0; u <= kEnd; u += 5)
        for (const PlanGeometry& g : {graph, by_length, normalized}) {
            const roads::PlanPoint p = plan_point(g, parabola(u, kRadius));
            EXPECT_NEAR(p.x, u, 1e-8);
            EXPECT_NEAR(p.y, u * u / (2 * kRadius), 1e-8);
            EXPECT_NEAR(p.heading, std::atan(u / kRadius), 1e-9);
            EXPECT_NEAR(p.curvature, 1 / kRadius / std::pow(1 + u * u / kRadius / kRadius, 1.5), 1e-9);
        }
}

TEST(PlanCurve, StatedLengthsStretchPolynomials) {
    PlanGeometry g{.kind = PlanGeometry::Kind::ParamPoly3, .heading = M_PI, .length = 20};
    g.u = {0, 10, 0, 0}, g.p_end = 1;  // 10 m long
    EXPECT_NEAR(roads::measure(g), 10, 1e-12);
    EXPECT_NEAR(plan_point(g, 10).x, -5, 1e-9);
    EXPECT_NEAR(plan_point(g, 20).x, -10, 1e-9);
}

}  // namespace
}  // namespace vesper::test
