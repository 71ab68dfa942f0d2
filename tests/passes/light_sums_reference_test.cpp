// Sums of light keep it and its place. SPDX-License-Identifier: MIT
#include "passes/light_sums_reference.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "passes/eye_scatter_reference.h"

namespace vesper::reference {
namespace {

// Every level has all the light, about its middle; what is not finite has none.
TEST(LightSumsReference, KeepsLightAndItsPlace) {
    std::mt19937 random(3);
    for (const ivec2 size : {ivec2(1, 1), {7, 5}, {2, 9}, {33, 20}, {64, 1}}) {
        const vision::ImageAngles image{size.x, size.y, {-0.4, -0.3}, {0.5, 0.2}};
        std::vector<float> pixels;
        double light = 0;
        dvec2 moment(0);
        for (int i = 0; i < size.x * size.y; ++i) {
            const bool bad = i % 5 == 3;
            const float value = std::pow(10.0f, float(random() % 900) / 100.0f - 2);
            for (const float c : {bad ? std::array{std::nanf(""), INFINITY, -INFINITY}[size_t(i / 5 % 3)] : value,
                                  0.5f * value, 0.25f * value, 1.0f})
                pixels.push_back(c);
            const dvec2 at = dvec2(i % size.x, i / size.x) + 0.5;
            const double lux = bad ? 0 : double(value) * solid_angle(image, direction_of(image, at));
            light += lux, moment += lux * at;
        }
        const LightSums sums(image, pixels);
        const vision::LightNodes& nodes = sums.nodes();
        for (int l = 0; l < nodes.levels(); ++l) {
            dvec3 sum(0);
            dvec2 middle(0);
            for (int y = 0; y < nodes.sizes[size_t(l)].y; ++y)
                for (int x = 0; x < nodes.sizes[size_t(l)].x; ++x) {
                    const dvec3 at(sums.at(nodes.index(l, {x, y})));
                    sum += at, middle += at.x * vision::LightNodes::place(l, {x, y});
                }
            EXPECT_NEAR(sum.x / light, 1, 1e-9) << size.x << " x " << size.y << ", level " << l;
            EXPECT_NEAR(sum.y / light, 0.5, 1e-7);
            EXPECT_LT(glm::distance(middle, moment), 1e-9 * glm::length(moment));
        }
    }
}

}  // namespace
}  // namespace vesper::reference
