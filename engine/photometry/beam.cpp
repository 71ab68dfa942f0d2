// Figures of distributions. SPDX-License-Identifier: MIT
#include "photometry/beam.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace vesper::photometry {
namespace {

glm::dvec3 direction_of(Goniometry goniometry, double h, double v) {
    const double a = h * kRadiansPerDegree, b = v * kRadiansPerDegree;
    switch (goniometry) {
        case Goniometry::CGamma:
            return {std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b)};
        case Goniometry::TypeB:
            return {std::sin(a), std::cos(a) * std::sin(b), -std::cos(a) * std::cos(b)};
        case Goniometry::TypeA:
            return {std::cos(b) * std::sin(a), std::sin(b), -std::cos(b) * std::cos(a)};
    }
    return {};
}

/// The greatest intensity of type C over all planes at a gamma.
double greatest_at(const Distribution& d, double gamma) {
    double greatest = 0;
    for (const double c : d.horizontal)
        greatest = std::max(greatest, intensity(d, direction_of(d.goniometry, c, gamma)));
    return greatest;
}

/// The same distribution with what lies above the horizontal cut off.
Distribution lower_half(const Distribution& d) {
    Distribution half = d;
    half.vertical.clear();
    for (const double gamma : d.vertical)
        if (gamma < 90) half.vertical.push_back(gamma);
    if (d.vertical.back() >= 90) half.vertical.push_back(90);
    half.candela.clear();
    for (const double c : d.horizontal)
        for (const double gamma : half.vertical)
            half.candela.push_back(intensity(d, direction_of(d.goniometry, c, gamma)));
    return half;
}

struct GlareClass {
    const char* name;
    std::array<double, 4> limits;  // cd/klm at 70, 80, 90 deg and from 95 deg up
};
constexpr double kAny = HUGE_VAL;
constexpr double kNothing = 0.5;          // cd/klm: rounds to 0
constexpr GlareClass kGlareClasses[] = {  // EN 13201-2:2015, table A.1, strictest first; G*6 asks 0 from 90 deg up
    {"G*6", {350, 100, 0, 0}},      {"G*5", {350, 100, 10, 0}},     {"G*4", {500, 100, 10, 0}},
    {"G*3", {kAny, 100, 20, kAny}}, {"G*2", {kAny, 150, 30, kAny}}, {"G*1", {kAny, 200, 50, kAny}}};

void find_cut_off(const Distribution& d, BeamFigures& figures) {
    const double per_klm = 1000 / figures.flux;
    const double gammas[] = {70, 80, 90};
    for (size_t i = 0; i < 3; ++i) figures.at_70_80_90_95[i] = greatest_at(d, gammas[i]) * per_klm;
    figures.at_70_80_90_95[3] = greatest_at(d, 95) * per_klm;
    for (const double gamma : d.vertical)
        if (gamma > 95)
            figures.at_70_80_90_95[3] = std::max(figures.at_70_80_90_95[3], greatest_at(d, gamma) * per_klm);
    for (const GlareClass& c : kGlareClasses) {
        bool holds = true;
        for (size_t i = 0; i < 4; ++i) holds &= figures.at_70_80_90_95[i] <= std::max(c.limits[i], kNothing);
        if (!holds) continue;
        figures.glare_class = c.name;
        return;
    }
}

}  // namespace

double intensity_at(const Distribution& d, double h, double v) {
    return intensity(d, direction_of(d.goniometry, h, v));
}

Cut plane_cut(const Distribution& d, double c) {
    Cut cut;
    const auto add = [&](double plane, double gamma, double angle) {
        cut.angle.push_back(angle);
        cut.candela.push_back(intensity(d, direction_of(Goniometry::CGamma, plane, gamma)));
    };
    for (size_t i = d.vertical.size(); i-- > 0;) add(c + 180, d.vertical[i], -d.vertical[i]);
    if (d.vertical.front() <= 0) cut.angle.pop_back(), cut.candela.pop_back();
    for (const double gamma : d.vertical) add(c, gamma, gamma);
    return cut;
}

Cut horizontal_cut(const Distribution& d, double v) {
    Cut cut{d.horizontal, {}};
    for (const double h : d.horizontal) cut.candela.push_back(intensity_at(d, h, v));
    return cut;
}

Cut vertical_cut(const Distribution& d, double h) {
    Cut cut{d.vertical, {}};
    for (const double v : d.vertical) cut.candela.push_back(intensity_at(d, h, v));
    return cut;
}

std::optional<Width> width_of(const Cut& cut, double share) {
    if (cut.candela.empty()) return {};
    const double level = share * *std::max_element(cut.candela.begin(), cut.candela.end());
    if (!(level > 0)) return {};
    const auto crossing = [&](size_t outside, size_t inside) {
        const double a = cut.candela[outside], b = cut.candela[inside];
        return cut.angle[outside] + (cut.angle[inside] - cut.angle[outside]) * (level - a) / (b - a);
    };
    size_t first = 0, last = cut.candela.size() - 1;
    while (cut.candela[first] < level) ++first;
    while (cut.candela[last] < level) --last;
    return Width{first > 0 ? crossing(first - 1, first) : cut.angle[first],
                 last + 1 < cut.angle.size() ? crossing(last + 1, last) : cut.angle[last]};
}

BeamSymmetry symmetry_of(const Distribution& d) {
    const double tolerance = 1e-3 * largest_intensity(d);
    const auto alike = [&](auto&& other) {
        for (size_t h = 0; h < d.horizontal.size(); ++h)
            for (size_t v = 0; v < d.vertical.size(); ++v) {
                // What planes say of the axis, where they meet, they say each for itself.
                if (d.goniometry == Goniometry::CGamma && (d.vertical[v] == 0 || d.vertical[v] == 180)) continue;
                const glm::dvec3 there = direction_of(d.goniometry, other(d.horizontal[h]), d.vertical[v]);
                if (std::abs(d.at(h, v) - intensity(d, there)) > tolerance) return false;
            }
        return true;
    };
    if (d.goniometry != Goniometry::CGamma)
        return alike([](double h) { return -h; }) ? BeamSymmetry::LeftRight : BeamSymmetry::None;
    if (d.horizontal.size() == 1 || alike([](double) { return 0; })) return BeamSymmetry::Rotational;
    const bool about_c0 = alike([](double c) { return -c; }), about_c90 = alike([](double c) { return 180 - c; });
    if (about_c0 && about_c90) return BeamSymmetry::Quadrants;
    return about_c0 ? BeamSymmetry::AboutC0 : about_c90 ? BeamSymmetry::AboutC90 : BeamSymmetry::None;
}

const char* name_of(BeamSymmetry symmetry) {
    switch (symmetry) {
        case BeamSymmetry::None:
            return "none";
        case BeamSymmetry::Rotational:
            return "rotational";
        case BeamSymmetry::Quadrants:
            return "about both planes, C0-180 and C90-270";
        case BeamSymmetry::AboutC0:
            return "about the plane C0-180";
        case BeamSymmetry::AboutC90:
            return "about the plane C90-270";
        case BeamSymmetry::LeftRight:
            return "left and right alike";
    }
    return "";
}

BeamFigures beam_figures(const Distribution& d) {
    BeamFigures figures;
    figures.flux = luminous_flux(d);
    if (d.lamp_flux > 0) figures.output_ratio = figures.flux / d.lamp_flux;
    if (d.candela.empty()) return figures;
    const auto greatest = std::max_element(d.candela.begin(), d.candela.end());
    const auto index = static_cast<size_t>(greatest - d.candela.begin());
    figures.largest = *greatest;
    figures.largest_h = d.horizontal[index / d.vertical.size()];
    figures.largest_v = d.vertical[index % d.vertical.size()];
    figures.symmetry = symmetry_of(d);
    if (d.goniometry != Goniometry::CGamma || !(figures.flux > 0)) return figures;
    if (d.vertical.back() > 90) figures.upward_share = std::max(0.0, 1 - luminous_flux(lower_half(d)) / figures.flux);
    if (d.vertical.front() >= 90) figures.upward_share = 1;
    find_cut_off(d, figures);
    return figures;
}

std::span<const BeamPoint> passing_beam_points() {
    static constexpr BeamPoint kPoints[] = {
        {"B50L", -3.43, 0.57, 0, 350},   {"BR", 2.5, 1, 0, 1750},         {"75R", 1.15, -0.57, 10100, 0},
        {"75L", -3.43, -0.57, 0, 10600}, {"50L", -3.43, -0.86, 0, 13200}, {"50R", 1.72, -0.86, 10100, 0},
        {"50V", 0, -0.86, 5100, 0},      {"25L", -9, -1.72, 1700, 0},     {"25R", 9, -1.72, 1700, 0}};
    return kPoints;
}

}  // namespace vesper::photometry
