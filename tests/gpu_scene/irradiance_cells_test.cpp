// The table of cells, read as shared/indirect.h says it. SPDX-License-Identifier: MIT
#include "gpu_scene/irradiance_cells.h"

#include <cmath>
#include <optional>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/gtc/packing.hpp>

#include "passes/shade_reference.h"
#include "shared/indirect.h"
#include "support/made_cells.h"

namespace vesper::test::irradiance_cells_test {
namespace {

using glm::dvec3, glm::vec3, gpu_scene::IrradianceCells;

struct Found {
    vec3 light;    // lx
    float height;  // cubes
    dvec3 normal;
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
        const glm::vec4 normal = glm::unpackSnorm4x8(texel.w);
        return Found{shared::kCellUnit * vec3(rg, b.x), glm::unpackHalf2x16(texel.w).x,
                     reference::octahedral_decode({normal.z, normal.w}), step};
    }
    ADD_FAILURE() << "no place is free";
    return std::nullopt;
}

TEST(IrradianceCells, ConstantsAreThoseOfTheLookupOnTheHost) {
    EXPECT_EQ(vec3(shared::kSideFactorX, shared::kSideFactorY, shared::kSideFactorZ), vec3(transport::kSideFactors));
    EXPECT_EQ(double(shared::kSameSurface), transport::Radiosity::kSameSurface);
    EXPECT_EQ(shared::kElsewhere, float(transport::Radiosity::kElsewhere));
    EXPECT_EQ(shared::kLeastWeight, float(transport::Radiosity::kLeastWeight));
}

TEST(IrradianceCells, EveryCellIsFoundWithItsLightAndPlane) {
    std::mt19937 random(1);
    for (const size_t count : {size_t(1), size_t(2), size_t(3), size_t(255), size_t(256), size_t(20'000)}) {
        MadeCells made{{.origin = {-5, 70, 3}, .size = 0.5, .count = {90, 40, 70}}, {}};
        while (made.cells.size() < count) {
            const dvec3 cube(random() % 90, random() % 40, random() % 70);
            const auto light = [&] { return std::exp2(float(random() % 2400) / 100 - 10); };
            if (random() % 9 == 0)
                made.add_air(glm::floor(cube / 8.0), uint32_t(random() % 6), {light(), light(), light()});
            else
                made.add(cube, uint32_t(random() % 6), glm::normalize(vec3(light(), -light(), light())),
                         (double(random() % 1001) / 1000 - 0.5) * 0.5, {light(), light(), light()});
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
            EXPECT_NEAR(at->height, cell.height / 0.5f, 2.5e-4f) << "a half";
            EXPECT_GE(glm::dot(at->normal, dvec3(cell.normal)), std::cos(0.02)) << "two bytes";
            for (int c = 0; c < 3; ++c)  // halves, truncated or rounded
                EXPECT_NEAR(at->light[c], cell.light[c], cell.light[c] / 1024 + 1e-6f);
            steps += at->steps;
        }
        EXPECT_LE(double(steps), 2.0 * double(count)) << "linear probing at half load: half a step more than one place";
    }
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
