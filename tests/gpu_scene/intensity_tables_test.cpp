// Tables of measured intensities and of roads against the tables they were made from. SPDX-License-Identifier: MIT
#include "gpu_scene/intensity_tables.h"
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "places.h"
#include "shared/tables.h"

namespace vesper::test {
namespace {

using gpu_scene::IntensityTables, gpu_scene::intensity_tables;
using photometry::Goniometry;

const std::filesystem::path kData = std::filesystem::path(VESPER_SOURCE_DIR) / "data/photometry";

scene::Scene with(photometry::Distribution d) {
    scene::Scene scene;
    scene.distributions.push_back(std::move(d));
    return scene;
}

glm::vec4 cell(const IntensityTables& tables, const IntensityTables::Intensities& table, uint32_t i, uint32_t j) {
    return tables.texels.at(table.first + size_t(i) * table.cells.y + j);
}

/// Every tabulated value is a corner of a cell, within what floats round: 2^-22, or 2^-24 of the largest.
void expect_every_value(const std::string& file) {
    const photometry::Distribution d = photometry::read_distribution(kData / file);
    const IntensityTables tables = intensity_tables(with(d));
    const auto& table = tables.intensities.at(0);
    EXPECT_TRUE(table.exact);
    for (size_t h = 0; h < d.horizontal.size(); ++h)
        for (size_t v = 0; v < d.vertical.size(); ++v) {
            double azimuth = d.horizontal[h], polar = d.vertical[v];
            if (d.goniometry == Goniometry::CGamma && azimuth > 180) azimuth -= 360;
            if (d.goniometry == Goniometry::TypeA) polar = 90 - polar;
            const glm::dvec2 at = (glm::radians(glm::dvec2(azimuth, polar)) - table.low) / table.step;
            ASSERT_LT(glm::length(at - glm::round(at)), 1e-6);
            const glm::uvec2 node(glm::round(at));
            const bool first = node.x == 0;  // the cell before the first nodes may be dark
            const glm::vec4 corners = cell(tables, table, std::max(node.x, 1u), std::max(node.y, 1u));
            const double value =
                double(node.y == 0 ? (first ? corners.x : corners.y) : (first ? corners.z : corners.w)) *
                double(table.largest);
            ASSERT_NEAR(value, d.at(h, v), d.at(h, v) * std::exp2(-22) + double(table.largest) * std::exp2(-24))
                << azimuth << " " << polar;
        }
}

TEST(IntensityTables, KeepEveryValueOfTheRoadLuminaire) { expect_every_value("street-lamp.ies"); }
TEST(IntensityTables, KeepEveryValueOfTheLowBeam) { expect_every_value("low-beam.csv"); }
TEST(IntensityTables, KeepEveryValueOfTheHighBeam) { expect_every_value("high-beam.csv"); }

TEST(IntensityTables, GoOnAroundStayAtThePolesAndEndWhereTheTableEnds) {
    photometry::Distribution d;
    d.horizontal = {0, 90, 180, 270, 360}, d.vertical = {0, 45, 90};
    for (double plane : {1.0, 2.0, 3.0, 4.0, 1.0}) d.candela.insert(d.candela.end(), {10, 10 * plane, 10});
    const IntensityTables tables = intensity_tables(with(d));
    const auto& table = tables.intensities.at(0);
    ASSERT_EQ(table.cells, glm::uvec2(6, 4));  // four azimuths and two angles, and one cell before and behind each
    for (uint32_t j = 0; j < 4; ++j) {
        EXPECT_EQ(cell(tables, table, 0, j), cell(tables, table, 4, j));
        EXPECT_EQ(cell(tables, table, 5, j), cell(tables, table, 1, j));
    }
    EXPECT_EQ(cell(tables, table, 2, 0), glm::vec4(0.25f));  // before gamma 0: the value there
    EXPECT_EQ(cell(tables, table, 2, 3), glm::vec4(0));      // beyond gamma 90: nothing
}

/// The frame of a measurement (shared/lamp.h): azimuth 0, azimuth 90 degrees, and the pole.
glm::dmat3 frame_of(Goniometry goniometry) {
    switch (goniometry) {
        case Goniometry::CGamma:
            return {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
        case Goniometry::TypeA:
            return {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
        case Goniometry::TypeB:
            break;
    }
    return {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}};
}

/// Windows of `count` bins: where each begins, in bins, and how long it is.
struct Window {
    uint32_t first, length;
};
std::vector<Window> windows_of(uint32_t count) {
    std::vector<Window> windows;
    for (uint32_t length = 1; length <= count; length *= 2)
        for (uint32_t first = 0; first < count; first += std::max(length / 2, 1u)) windows.push_back({first, length});
    for (int i = 0; i < 2; ++i) windows.push_back({0, count});
    return windows;
}

/// The bound of a ring window and a sector window, cd.
double bound_of(const IntensityTables& tables, size_t ring, size_t sector) {
    const auto& table = tables.intensities.at(0);
    const size_t k = ring * 3 * shared::kSectors + sector;
    return double(tables.texels.at(table.first - shared::kWindowTexels + k / 4)[int(k % 4)]) * double(table.largest);
}

TEST(IntensityTables, NoWindowIsBelowAnyValueInItOrMuchAbove) {
    const std::vector<Window> rings = windows_of(shared::kRings), sectors = windows_of(shared::kSectors);
    ASSERT_EQ(rings.size() * sectors.size(), 4 * shared::kWindowTexels);
    for (const char* file : {"street-lamp.ies", "low-beam.csv", "high-beam.csv"}) {
        const photometry::Distribution d = photometry::read_distribution(kData / file);
        const IntensityTables tables = intensity_tables(with(d));
        const glm::dmat3 frame = frame_of(d.goniometry);
        double seen[shared::kRings][shared::kSectors]{};  // the largest in a bin
        constexpr uint32_t kFine = 6;
        for (uint32_t r = 0; r < kFine * shared::kRings; ++r)
            for (uint32_t s = 0; s < kFine * shared::kSectors; ++s) {
                const double polar = 2 * std::asin((r + 0.5) / (kFine * shared::kRings)),
                             azimuth = (s + 0.5) / (kFine * shared::kSectors) * 2 * std::numbers::pi - std::numbers::pi;
                double& largest = seen[r / kFine][s / kFine];
                largest = std::max(
                    largest,
                    photometry::intensity(d, frame * glm::dvec3(std::sin(polar) * std::cos(azimuth),
                                                                std::sin(polar) * std::sin(azimuth), std::cos(polar))));
            }
        for (size_t i = 0; i < rings.size(); ++i)
            for (size_t j = 0; j < sectors.size(); ++j) {
                double largest = 0;
                for (uint32_t r = rings[i].first; r < std::min(rings[i].first + rings[i].length, shared::kRings); ++r)
                    for (uint32_t s = 0; s < sectors[j].length; ++s)
                        largest = std::max(largest, seen[r][(sectors[j].first + s) % shared::kSectors]);
                const double bound = bound_of(tables, i, j);
                ASSERT_LE(largest, bound) << file << ", windows " << i << " and " << j;
                if (rings[i].first + rings[i].length > shared::kRings) continue;  // never asked for
                EXPECT_GE(1.5 * largest + 0.03 * photometry::largest_intensity(d), bound)
                    << file << ", windows " << i << " and " << j << ": no use";
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

// A few bright values among dark ones, cells from a degree to half a turn: they bulge, hold the axis, its opposite or a
// pole, or lie behind.
TEST(IntensityTables, WindowsHoldCellsOfEverySize) {
    std::mt19937 random(1);
    const auto any = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    const auto angles = [&](double low, double high) {
        const double steps[] = {1, 2.5, 7.5, 22.5, 45, 90, 180};
        double step = steps[random() % 7];
        while (step > high - low) step = steps[random() % 7];
        std::vector<double> made{low + step * std::floor(any(0, (high - low) / step))};
        for (int i = 0; i < 12 && (made.size() < 2 || any(0, 1) < 0.8); ++i)
            if (made.back() + step <= high)
                made.push_back(made.back() + step);
            else if (made.front() - step >= low)
                made.insert(made.begin(), made.front() - step);
        return made;
    };
    for (int turn = 0; turn < 300; ++turn) {
        photometry::Distribution d;
        d.goniometry = Goniometry(turn % 3);
        const bool c = d.goniometry == Goniometry::CGamma, b = d.goniometry == Goniometry::TypeB;
        d.horizontal = c ? std::vector<double>{0, 90, 180, 270, 360} : b ? angles(-90, 90) : angles(-180, 180);
        d.vertical = c ? angles(0, 180) : b ? angles(-180, 180) : angles(-90, 90);
        if (turn % 6 == 0) d.horizontal = {0};
        for (size_t i = 0; i < d.horizontal.size() * d.vertical.size(); ++i)
            d.candela.push_back(any(0, 1) < 0.8 ? 0 : any(1, 100));
        if (d.horizontal.size() == 5 && c)
            std::copy_n(d.candela.begin(), d.vertical.size(), d.candela.end() - std::ptrdiff_t(d.vertical.size()));
        const IntensityTables tables = intensity_tables(with(d));
        const auto& table = tables.intensities.at(0);
        for (int i = 0; i < 3000 && table.largest > 0; ++i) {
            const double h = any(d.horizontal.front(), d.horizontal.back()),
                         v = any(d.vertical.front(), d.vertical.back());
            const glm::dvec3 to = direction(d.goniometry, h, v);
            const glm::dvec3 at = glm::transpose(frame_of(d.goniometry)) * to;
            const auto ring =
                std::min(uint32_t(std::sqrt(std::max((1 - at.z) / 2, 0.0)) * shared::kRings), shared::kRings - 1);
            const auto sector = std::min(
                uint32_t((std::atan2(at.y, at.x) / std::numbers::pi + 1) / 2 * shared::kSectors), shared::kSectors - 1);
            ASSERT_LE(photometry::intensity(d, to), bound_of(tables, ring, sector)) << turn << ": " << h << ", " << v;
        }
    }
}

TEST(IntensityTables, OddAnglesGetNodesATenthOfADegreeApart) {
    photometry::Distribution d;
    d.horizontal = {0}, d.vertical = {0, 10.0037, 90}, d.candela = {100, 80, 20};
    const IntensityTables tables = intensity_tables(with(d));
    EXPECT_FALSE(tables.intensities[0].exact);
    EXPECT_NEAR(glm::degrees(tables.intensities[0].step.y), 0.1, 1e-9);
}

TEST(IntensityTables, ADarkLampAndNoLampAreNothing) {
    EXPECT_FALSE(intensity_tables({}).texels.empty());
    photometry::Distribution d;
    d.horizontal = {0}, d.vertical = {0, 90}, d.candela = {0, 0};
    EXPECT_EQ(intensity_tables(with(d)).intensities.at(0).largest, 0.0f);
}

/// What a road's head says, and its cells.
struct RoadCells {
    double per_tan, columns;  // cells per unit of tan(gamma); of beta
    size_t first;
};
RoadCells road_cells(const IntensityTables& tables, size_t table) {
    const glm::vec4 head = tables.texels.at(tables.roads + table);
    return {double(head.x), std::round(double(head.z) * std::numbers::pi), size_t(head.w)};
}

/// Every tabulated value is a corner of a cell.
void expect_every_value(const IntensityTables& tables, size_t number, const photometry::ReflectionTable& table) {
    const RoadCells road = road_cells(tables, number);
    for (size_t t = 1; t < table.tan_gamma.size(); ++t)
        for (size_t b = 1; b < table.beta.size(); ++b) {
            if (table.at(t, b) == 0) continue;  // extended
            const double along = table.tan_gamma[t] * road.per_tan, across = table.beta[b] * road.columns / 180;
            ASSERT_NEAR(along, std::round(along), 1e-4);  // of a cell: floats round the head
            ASSERT_NEAR(across, std::round(across), 1e-9);
            const size_t cell = (size_t(std::round(along)) - 1) * size_t(road.columns) + size_t(std::round(across)) - 1;
            const double value = gpu_scene::reflectance_in_diffuse(photometry::extended(table)) / std::numbers::pi *
                                 double(tables.texels.at(road.first + cell).w);
            ASSERT_NEAR(value, table.at(t, b), table.at(t, b) * std::exp2(-22))
                << table.name << " " << table.tan_gamma[t] << " " << table.beta[b];
        }
}

TEST(IntensityTables, RoadsKeepEveryTabulatedValue) {
    scene::Scene scene;
    for (const std::string& name : photometry::standard_reflection_tables())
        scene.reflection_tables.push_back(photometry::find_reflection_table(name));
    const IntensityTables tables = intensity_tables(scene);
    for (size_t i = 0; i < scene.reflection_tables.size(); ++i)
        expect_every_value(tables, i, scene.reflection_tables[i]);
}

TEST(IntensityTables, RoadsHaveTheNodesOfAnyTable) {
    photometry::ReflectionTable far = photometry::find_reflection_table("R3"), odd = far;
    for (double& t : far.tan_gamma) t *= 2.5;
    odd.tan_gamma[1] = 0.1, odd.tan_gamma[2] = 0.45, odd.beta[1] = 1.5;
    scene::Scene scene;
    scene.reflection_tables = {far, odd, photometry::find_reflection_table("W4")};
    const IntensityTables tables = intensity_tables(scene);
    for (size_t i = 0; i < 3; ++i) expect_every_value(tables, i, scene.reflection_tables[i]);
    EXPECT_EQ(road_cells(tables, 0).columns, 180);
    EXPECT_EQ(road_cells(tables, 1).columns, 360);
    EXPECT_EQ(road_cells(tables, 2).columns, 180);
}

// Darker and brighter than half floats can be.
TEST(IntensityTables, RoadsOfAnyBrightnessAreFinite) {
    for (const double r : {1e-10, 1e4}) {
        scene::Scene scene;
        scene.reflection_tables = {{.name = "even", .tan_gamma = {0, 5}, .beta = {0, 180}, .r = {r, r, r, r}}};
        photometry::check_reflection_table(scene.reflection_tables[0], "even");
        const IntensityTables tables = intensity_tables(scene);
        const float reflectance = gpu_scene::reflectance_in_diffuse(gpu_scene::rendered_table(scene, 0));
        const double stands_for =
            double(tables.texels.at(road_cells(tables, 0).first).x) * double(reflectance) / std::numbers::pi;
        EXPECT_NEAR(stands_for / r, 1, 1e-5);
    }
}

TEST(IntensityTables, NodesOfRoadsThatDivideNothingAreHalfACellOff) {
    scene::Scene scene;
    scene.reflection_tables = {photometry::find_reflection_table("R3")};
    photometry::ReflectionTable& table = scene.reflection_tables[0];
    table.tan_gamma[1] = 0.2501, table.beta[1] = 1.0007;
    const IntensityTables tables = intensity_tables(scene);
    const RoadCells road = road_cells(tables, 0);
    EXPECT_EQ(std::round(road.per_tan * table.tan_gamma.back()), shared::kMostRoadCells.x);
    EXPECT_EQ(road.columns, shared::kMostRoadCells.y);
}

}  // namespace
}  // namespace vesper::test
