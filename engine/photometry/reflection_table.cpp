// Interpolation and integrals of r-tables. SPDX-License-Identifier: MIT
#include "photometry/reflection_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace vesper::photometry {
namespace {

constexpr size_t kMaxSide = 512;
constexpr double kMaxR = 1e4;  // sr^-1: a thousand times the lobe of a flooded road

/// The interval of ascending nodes that holds x, and how far into it.
struct Place {
    size_t index;
    double fraction;
};

Place place_in(const std::vector<double>& nodes, double x) {
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), x);
    const size_t i = std::clamp<size_t>(static_cast<size_t>(above - nodes.begin()), 1, nodes.size() - 1) - 1;
    return {i, std::clamp((x - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0)};
}

double cos3(double tan_gamma) { return std::pow(1 + tan_gamma * tan_gamma, -1.5); }

bool ascending(const std::vector<double>& nodes) {
    return std::adjacent_find(nodes.begin(), nodes.end(), [](double a, double b) { return !(a < b); }) == nodes.end();
}

}  // namespace

double reduced_luminance_coefficient(const ReflectionTable& table, double tan_gamma, double beta_deg) {
    double beyond = 1;
    const double last = table.tan_gamma.back();
    if (tan_gamma > last) {
        if (!table.extended) return 0;
        beyond = (1 + last * last) / (1 + tan_gamma * tan_gamma);
    }
    const Place t = place_in(table.tan_gamma, std::min(tan_gamma, last));
    const Place b = place_in(table.beta, std::abs(std::remainder(beta_deg, 360.0)));
    const double low = std::lerp(table.at(t.index, b.index), table.at(t.index, b.index + 1), b.fraction);
    const double high = std::lerp(table.at(t.index + 1, b.index), table.at(t.index + 1, b.index + 1), b.fraction);
    return std::lerp(low, high, t.fraction) * beyond;
}

double luminance_coefficient(const ReflectionTable& table, double tan_gamma, double beta_deg) {
    return reduced_luminance_coefficient(table, tan_gamma, beta_deg) / cos3(tan_gamma);
}

double average_luminance_coefficient(const ReflectionTable& table) {
    // Half the plane of the lamps, by midpoints a fortieth of H apart; dOmega = cos^3(gamma) dA / H^2.
    constexpr int kPerHeight = 40;
    double q = 0, omega = 0;
    for (int j = 0; j < 3 * kPerHeight; ++j)
        for (int i = -4 * kPerHeight; i < 12 * kPerHeight; ++i) {
            const double x = (i + 0.5) / kPerHeight, y = (j + 0.5) / kPerHeight, t = std::hypot(x, y);
            q += reduced_luminance_coefficient(table, t, std::atan2(y, x) * 180 / std::numbers::pi);
            omega += cos3(t);
        }
    return q / omega;
}

double diffuse_luminance_coefficient(const ReflectionTable& table) {
    // The mean of r over beta is linear between rows, as r is; over gamma by midpoints. dOmega = sin(gamma) dgamma
    // dbeta.
    ReflectionTable mean{
        .name = {}, .tan_gamma = table.tan_gamma, .beta = {0, 180}, .r = {}, .extended = table.extended};
    for (size_t t = 0; t < table.tan_gamma.size(); ++t) {
        double sum = 0;
        for (size_t b = 0; b + 1 < table.beta.size(); ++b)
            sum += (table.beta[b + 1] - table.beta[b]) / 360 * (table.at(t, b) + table.at(t, b + 1));
        mean.r.insert(mean.r.end(), 2, sum);
    }
    constexpr int kSteps = 2000;
    constexpr double kStep = std::numbers::pi / 2 / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double gamma = (i + 0.5) * kStep, t = std::tan(gamma);
        sum += reduced_luminance_coefficient(mean, t, 0) * (1 + t * t) * std::sin(gamma) * kStep;
    }
    return 2 * sum;
}

double specular_factor(const ReflectionTable& table) {
    return reduced_luminance_coefficient(table, 2, 0) / reduced_luminance_coefficient(table, 0, 0);
}

ReflectionTable rescaled(ReflectionTable table, double q0) {
    const double now = table.stated_q0 > 0 ? table.stated_q0 : average_luminance_coefficient(table);
    if (!(now > 0) || !(q0 > 0) || !std::isfinite(q0)) throw Error(table.name + ": cannot be scaled to this Q0");
    for (double& value : table.r) value *= q0 / now;
    table.stated_q0 = q0;
    return table;
}

ReflectionTable extended(ReflectionTable table) {
    const size_t columns = table.beta.size();
    for (size_t b = 0; b < columns; ++b)
        for (size_t t = 1; t < table.tan_gamma.size(); ++t)
            if (table.at(t, b) == 0)
                table.r[t * columns + b] = table.at(t - 1, b) * cos3(table.tan_gamma[t]) / cos3(table.tan_gamma[t - 1]);
    table.extended = true;
    return table;
}

ReflectionTable without_sheen(ReflectionTable table) {
    const ReflectionTable whole = table;
    for (size_t t = 0; t < table.tan_gamma.size(); ++t)
        for (size_t b = 0; b < table.beta.size(); ++b)
            table.r[t * table.beta.size() + b] = reduced_luminance_coefficient(whole, table.tan_gamma[t], 90);
    return table;
}

void check_reflection_table(const ReflectionTable& table, const std::string& place) {
    const auto require = [&](bool holds, const char* reason) {
        if (!holds) throw Error(place + ": " + reason);
    };
    const auto &t = table.tan_gamma, &b = table.beta;
    require(t.size() >= 2 && b.size() >= 2, "a reflection table has at least two tan gamma and two beta");
    require(t.size() <= kMaxSide && b.size() <= kMaxSide, "a reflection table has at most 512 tan gamma and 512 beta");
    require(table.r.size() == t.size() * b.size(), "a reflection table has one value for each tan gamma and beta");
    require(ascending(t) && t.front() == 0 && t.back() <= 1e3, "tan gamma must ascend from 0 to at most 1000");
    require(ascending(b) && b.front() == 0 && b.back() == 180, "beta must ascend from 0 to 180");
    require(std::all_of(table.r.begin(), table.r.end(), [](double v) { return v >= 0 && v <= kMaxR; }),
            "r must be from 0 to 10000 sr^-1");
    require(table.r.front() > 0, "r at tan gamma 0 must be more than 0");
    require(table.stated_q0 >= 0 && table.stated_q0 <= 100, "Q0 must be from 0 to 100 sr^-1");
}

}  // namespace vesper::photometry
