// The table of cells, read as shared/indirect.h says it. SPDX-License-Identifier: MIT
#include "gpu_scene/irradiance_cells.h"

#include <bit>
#include <cmath>
#include <optional>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/gtc/packing.hpp>

#include "shared/indirect.h"
#include "support/made_cells.h"

namespace vesper::test::irradiance_cells_test {
namespace {

using glm::dvec3, glm::vec3, gpu_scene::IrradianceCells;

struct Found {
    vec3 light;    // lx
    float height;  // cubes
    size_t steps;  // to its place
};

/// From the place that the hash says to the next that is free.
std::optional<Found> found(const IrradianceCells& table, uint32_t number) {
    const size_t places = table.texels.size(), first = (number * shared::kCellHash) >> (32 - table.log2_places);
    for (size_t step = 0; step < places; ++step) {
        const glm::uvec4 texel = table.texels.at((first + step) % places);
        if (texel.x == shared::kNoCell) return std::nullopt;
        if (texel.x != number) continue;
        const glm::vec2 rg = glm::unpackHalf2x16(texel.y), b = glm::unpackHalf2x16(texel.z);
        return Found{shared::kCellUnit * vec3(rg, b.x), std::bit_cast<float>(texel.w), step};
    }
    ADD_FAILURE() << "no place is free";
    return std::nullopt;
}

TEST(IrradianceCells, ConstantsAreThoseOfTheLookupOnTheHost) {
    EXPECT_EQ(double(shared::kNearBorder), transport::Radiosity::kNearBorder);
    EXPECT_EQ(double(shared::kSameSurface), transport::Radiosity::kSameSurface);
    EXPECT_EQ(shared::kElsewhere, float(transport::Radiosity::kElsewhere));
    EXPECT_EQ(shared::kLeastWeight, float(transport::Radiosity::kLeastWeight));
}

TEST(IrradianceCells, EveryCellIsFoundWithItsLightAndHeight) {
    std::mt19937 random(1);
    for (const size_t count : {size_t(1), size_t(2), size_t(3), size_t(255), size_t(256), size_t(20'000)}) {
        MadeCells made{{.origin = {-5, 70, 3}, .size = 0.5, .count = {90, 40, 70}}, {}};
        while (made.cells.size() < count) {
            const dvec3 cube(random() % 90, random() % 40, random() % 70);
            const auto light = [&] { return std::exp2(float(random() % 2400) / 100 - 10); };
            if (random() % 9 == 0)
                made.add_air(glm::floor(cube / 4.0), uint32_t(random() % 6), {light(), light(), light()});
            else
                made.add(cube, uint32_t(random() % 6), (double(random() % 1001) / 1000 - 0.5) * 0.5,
                         {light(), light(), light()});
        }
        const IrradianceCells table = gpu_scene::irradiance_cells(made.radiosity(), made.light());
        EXPECT_EQ(table.texels.size(), size_t{1} << table.log2_places);
        size_t taken = 0, steps = 0;
        std::set<uint32_t> numbers;
        for (const glm::uvec4 texel : table.texels)
            if (texel.x != shared::kNoCell) {
                ++taken;
                EXPECT_TRUE(numbers.insert(texel.x).second) << "twice";
            }
        EXPECT_GE(taken, count);
        EXPECT_LE(2 * taken, table.texels.size()) << "so that few places are looked at";
        for (const auto& [number, cell] : made.cells) {
            const std::optional<Found> at = found(table, number);
            ASSERT_TRUE(at) << number;
            EXPECT_FLOAT_EQ(at->height, cell.height / 0.5f);
            for (int c = 0; c < 3; ++c)  // halves, truncated or rounded
                EXPECT_NEAR(at->light[c], cell.light[c], cell.light[c] / 1024 + 1e-6f);
            steps += at->steps;
        }
        EXPECT_LE(double(steps), 2.0 * double(count)) << "linear probing at half load: half a step more than one place";
    }
}

// As RadiosityAt.ASurfaceGoesOnBeyondANearBorder says of the host.
TEST(IrradianceCells, ACellNearABorderStandsForTheNextCube) {
    for (uint32_t side = 0; side < 6; ++side)
        for (const float height : {-0.45f, -0.3f, -0.2f, 0.0f, 0.2f, 0.3f, 0.45f}) {
            MadeCells made{{.origin = {-5, 70, 3}, .size = 2, .count = {9, 9, 9}}, {}};
            made.add({4, 4, 4}, side, 2 * double(height), {16, 32, 48});
            const IrradianceCells table = gpu_scene::irradiance_cells(made.radiosity(), made.light());
            const float upwards = side % 2 ? -height : height;  // along the axis
            for (const int step : {-1, 1}) {
                dvec3 cube(4);
                cube[int(side / 2)] += step;
                const std::optional<Found> at = found(table, made.grid.cell(cube, side).value());
                ASSERT_EQ(at.has_value(), float(step) * upwards > 0.25f) << side << " from " << height;
                if (!at) continue;
                EXPECT_EQ(at->light, vec3(16, 32, 48));
                // From the middle of that cube the surface is one cube the other way.
                EXPECT_FLOAT_EQ(at->height, height - (height > 0 ? 1.0f : -1.0f));
            }
        }
}

TEST(IrradianceCells, NoneStandsForACellThatIsThereNorBeyondTheGrid) {
    MadeCells made{{.origin = {0, 0, 0}, .size = 1, .count = {3, 3, 1}}, {}};
    made.add({1, 1, 0}, 2, 0.45, vec3(16)), made.add({1, 2, 0}, 2, 0.45, vec3(32));
    made.add({0, 0, 0}, 3, 0.45, vec3(64));                                         // stands for none below the grid
    made.add({2, 0, 0}, 0, 0.4, vec3(80)), made.add_air({0, 0, 0}, 2, vec3(96));    // nor beside it
    made.add({2, 0, 0}, 2, 0.4, vec3(112)), made.add({2, 2, 0}, 2, -0.4, vec3(8));  // for (2, 1, 0) both
    const IrradianceCells table = gpu_scene::irradiance_cells(made.radiosity(), made.light());
    EXPECT_EQ(found(table, *made.grid.cell({1, 2, 0}, 2))->light, vec3(32));
    EXPECT_EQ(found(table, *made.grid.cell({2, 1, 0}, 2))->light, vec3(112)) << "the lower, as on the host";
    size_t taken = 0;
    for (const glm::uvec4 texel : table.texels) taken += texel.x != shared::kNoCell;
    EXPECT_EQ(taken, made.cells.size() + 1);
}

TEST(IrradianceCells, LightBeyondHalvesIsTheirLargest) {
    MadeCells made{{.origin = {0, 0, 0}, .size = 1, .count = {1, 1, 1}}, {}};
    made.add({0, 0, 0}, 2, 0, {1e7f, 1e30f, 5});
    const IrradianceCells table = gpu_scene::irradiance_cells(made.radiosity(), made.light());
    EXPECT_EQ(found(table, 2)->light, vec3(65504 * 16, 65504 * 16, 5));
    EXPECT_FALSE(found(table, 0));
}

}  // namespace
}  // namespace vesper::test::irradiance_cells_test
