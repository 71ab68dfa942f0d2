// Maps of measured intensities and of roads against the tables they were made from. SPDX-License-Identifier: MIT
#include "resident/light_maps.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "places.h"
#include "shared/maps.h"

namespace vesper {
namespace {

const std::filesystem::path kData = std::filesystem::path(VESPER_SOURCE_DIR) / "data/photometry";

Scene with(Distribution d) {
    Scene scene;
    scene.distributions.push_back(std::move(d));
    return scene;
}

glm::vec4 cell(const LightMaps& maps, const LightMaps::Intensities& map, uint32_t i, uint32_t j) {
    return maps.texels.at(map.first + size_t(i) * map.cells.y + j);
}

/// Every tabulated value is a corner of a cell, within what floats round: 2^-22, or 2^-24 of the largest.
void expect_every_value(const std::string& file) {
    const Distribution d = read_distribution(kData / file);
    const LightMaps maps = light_maps(with(d));
    const auto& map = maps.intensities.at(0);
    EXPECT_TRUE(map.exact);
    for (size_t h = 0; h < d.horizontal.size(); ++h)
        for (size_t v = 0; v < d.vertical.size(); ++v) {
            double azimuth = d.horizontal[h], polar = d.vertical[v];
            if (d.goniometry == Goniometry::CGamma && azimuth > 180) azimuth -= 360;
            if (d.goniometry == Goniometry::TypeA) polar = 90 - polar;
            const glm::dvec2 at = (glm::radians(glm::dvec2(azimuth, polar)) - map.low) / map.step;
            ASSERT_LT(glm::length(at - glm::round(at)), 1e-6);
            const glm::uvec2 node(glm::round(at));
            const bool first = node.x == 0;  // the cell before the first nodes may be dark
            const glm::vec4 corners = cell(maps, map, std::max(node.x, 1u), std::max(node.y, 1u));
            const double value = double(node.y == 0 ? (first ? corners.x : corners.y) : (first ? corners.z : corners.w)) * double(map.largest);
            ASSERT_NEAR(value, d.at(h, v), d.at(h, v) * std::exp2(-22) + double(map.largest) * std::exp2(-24)) << azimuth << " " << polar;
        }
}

TEST(LightMaps, KeepEveryValueOfTheRoadLuminaire) { expect_every_value("street-lamp.ies"); }
TEST(LightMaps, KeepEveryValueOfTheLowBeam) { expect_every_value("low-beam.csv"); }
TEST(LightMaps, KeepEveryValueOfTheHighBeam) { expect_every_value("high-beam.csv"); }

TEST(LightMaps, GoOnAroundStayAtThePolesAndEndWhereTheTableEnds) {
    Distribution d;
    d.horizontal = {0, 90, 180, 270, 360}, d.vertical = {0, 45, 90};
    for (double plane : {1.0, 2.0, 3.0, 4.0, 1.0}) d.candela.insert(d.candela.end(), {10, 10 * plane, 10});
    const LightMaps maps = light_maps(with(d));
    const auto& map = maps.intensities.at(0);
    ASSERT_EQ(map.cells, glm::uvec2(6, 4));  // four azimuths and two angles, and one cell before and behind each
    for (uint32_t j = 0; j < 4; ++j) {
        EXPECT_EQ(cell(maps, map, 0, j), cell(maps, map, 4, j));
        EXPECT_EQ(cell(maps, map, 5, j), cell(maps, map, 1, j));
    }
    EXPECT_EQ(cell(maps, map, 2, 0), glm::vec4(0.25f));  // before gamma 0: the value there
    EXPECT_EQ(cell(maps, map, 2, 3), glm::vec4(0));      // beyond gamma 90: nothing
}

TEST(LightMaps, AnEnvelopeIsNeverBelowAnyValue) {
    for (const char* file : {"street-lamp.ies", "low-beam.csv", "high-beam.csv"}) {
        const Distribution d = read_distribution(kData / file);
        const LightMaps maps = light_maps(with(d));
        const auto& map = maps.intensities.at(0);
        std::array<double, shared::kEnvelope> largest{};  // of each ring
        for (uint32_t k = 0; k < 4 * shared::kEnvelope; ++k) {
            const double angle = 2 * std::asin((k + 0.5) / (4 * shared::kEnvelope));
            for (double turn = 0; turn < 6.28; turn += 0.01)
                largest[k / 4] = std::max(largest[k / 4], intensity(d, {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), -std::cos(angle)}));
        }
        for (uint32_t row = 0; row < shared::kEnvelopeRows; ++row)
            for (uint32_t k = 0; k + (1u << row) <= shared::kEnvelope; ++k) {
                const double bound = double(maps.texels[map.envelope + row * shared::kEnvelope + k].x) * double(map.largest);
                const double seen = *std::max_element(&largest[k], &largest[k] + (1u << row));
                ASSERT_LE(seen, bound) << file << ", rings " << k << " and " << (1u << row) - 1 << " more";
                EXPECT_GE(4 * seen + 0.02 * double(map.largest), bound) << file << ", rings " << k << " and " << (1u << row) - 1 << " more: no use";
            }
    }
}

/// A direction by its two angles, deg, as Goniometry says.
glm::dvec3 direction(Goniometry goniometry, double horizontal, double vertical) {
    const double h = glm::radians(horizontal), v = glm::radians(vertical);
    if (goniometry == Goniometry::CGamma) return {std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), -std::cos(v)};
    if (goniometry == Goniometry::TypeB) return {std::sin(h), std::cos(h) * std::sin(v), -std::cos(h) * std::cos(v)};
    return {std::cos(v) * std::sin(h), std::sin(v), -std::cos(v) * std::cos(h)};
}

// A few bright values among dark ones, cells from a degree to half a turn: they bulge, hold the axis, its opposite or a pole, or lie behind.
TEST(LightMaps, AnEnvelopeHoldsCellsOfEverySize) {
    std::mt19937 random(1);
    const auto any = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const auto angles = [&](double low, double high) {
        const double steps[] = {1, 2.5, 7.5, 22.5, 45, 90, 180};
        double step = steps[random() % 7];
        while (step > high - low) step = steps[random() % 7];
        std::vector<double> made{low + step * std::floor(any(0, (high - low) / step))};
        for (int i = 0; i < 12 && (made.size() < 2 || any(0, 1) < 0.8); ++i)
            if (made.back() + step <= high) made.push_back(made.back() + step);
            else if (made.front() - step >= low) made.insert(made.begin(), made.front() - step);
        return made;
    };
    for (int turn = 0; turn < 300; ++turn) {
        Distribution d;
        d.goniometry = Goniometry(turn % 3);
        const bool c = d.goniometry == Goniometry::CGamma, b = d.goniometry == Goniometry::TypeB;
        d.horizontal = c ? std::vector<double>{0, 90, 180, 270, 360} : b ? angles(-90, 90) : angles(-180, 180);
        d.vertical = c ? angles(0, 180) : b ? angles(-180, 180) : angles(-90, 90);
        if (turn % 6 == 0) d.horizontal = {0};
        for (size_t i = 0; i < d.horizontal.size() * d.vertical.size(); ++i) d.candela.push_back(any(0, 1) < 0.8 ? 0 : any(1, 100));
        if (d.horizontal.size() == 5 && c) std::copy_n(d.candela.begin(), d.vertical.size(), d.candela.end() - std::ptrdiff_t(d.vertical.size()));
        const LightMaps maps = light_maps(with(d));
        const auto& map = maps.intensities.at(0);
        for (int i = 0; i < 3000 && map.largest > 0; ++i) {
            const double h = any(d.horizontal.front(), d.horizontal.back()), v = any(d.vertical.front(), d.vertical.back());
            const glm::dvec3 to = direction(d.goniometry, h, v);
            const auto ring = std::min(uint32_t(std::sqrt((1 + to.z) / 2) * shared::kEnvelope), shared::kEnvelope - 1);
            ASSERT_LE(intensity(d, to), double(maps.texels[map.envelope + ring].x) * double(map.largest)) << turn << ": " << h << ", " << v;
        }
    }
}

TEST(LightMaps, OddAnglesGetNodesATenthOfADegreeApart) {
    Distribution d;
    d.horizontal = {0}, d.vertical = {0, 10.0037, 90}, d.candela = {100, 80, 20};
    const LightMaps maps = light_maps(with(d));
    EXPECT_FALSE(maps.intensities[0].exact);
    EXPECT_NEAR(glm::degrees(maps.intensities[0].step.y), 0.1, 1e-9);
}

TEST(LightMaps, ADarkLampAndNoLampAreNothing) {
    EXPECT_FALSE(light_maps({}).texels.empty());
    Distribution d;
    d.horizontal = {0}, d.vertical = {0, 90}, d.candela = {0, 0};
    EXPECT_EQ(light_maps(with(d)).intensities.at(0).largest, 0.0f);
}

TEST(LightMaps, RoadsKeepEveryTabulatedValue) {
    Scene scene;
    for (const std::string& name : standard_reflection_tables()) scene.reflection_tables.push_back(find_reflection_table(name));
    const LightMaps maps = light_maps(scene);
    for (size_t k = 0; k < scene.reflection_tables.size(); ++k) {
        const ReflectionTable& table = scene.reflection_tables[k];
        const glm::vec4 head = maps.texels.at(maps.roads[k] - 1);
        EXPECT_EQ(head.x * head.y, float(shared::kRoadTanCells));
        for (size_t t = 1; t < table.tan_gamma.size(); ++t)
            for (size_t b = 1; b < table.beta.size(); ++b) {
                if (table.at(t, b) == 0) continue;
                const double at = table.tan_gamma[t] * double(head.x);
                ASSERT_EQ(at, std::round(at));
                const size_t cell = (size_t(at) - 1) * shared::kRoadBetaCells + size_t(table.beta[b]) - 1;
                const double value = 1e-4 * double(maps.texels.at(maps.roads[k] + cell).w);
                ASSERT_NEAR(value, table.at(t, b), table.at(t, b) * std::exp2(-22)) << table.name << " " << table.tan_gamma[t] << " " << table.beta[b];
            }
    }
}

}  // namespace
}  // namespace vesper
