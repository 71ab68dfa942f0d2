// Means of samples on the device against their reference, and where samples lie. SPDX-License-Identifier: MIT
#include "passes/samples_reference.h"

#include <random>

#include "render/passes/samples.h"
#include "render/sample_buffers.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test::samples_test {
namespace {

using Pixels = std::vector<glm::vec4>;

Pixels mean_of(PassRig& rig, const std::vector<Pixels>& samples, VkExtent2D extent) {
    render::SampleBuffers buffers;
    buffers.resize(rig.device(), uint64_t(extent.width) * extent.height);
    for (size_t i = 0; i < samples.size(); ++i) {
        graph::FrameGraph graph;
        const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, extent, samples[i]);
        const render::FrameContext frame = rig.frame(graph, extent);
        const render::SampleSums sums = buffers.declare(graph);
        render::add_sample(frame, scene, sums, i == 0);
        if (i + 1 < samples.size()) {
            rig.run(graph);
            continue;
        }
        const graph::Resource kept =
            keep<glm::vec4>(graph, render::add_mean_of_samples(frame, sums, uint32_t(samples.size())));
        rig.run(graph);
        return rig.got<glm::vec4>(kept);
    }
    return {};
}

std::vector<Pixels> noise(VkExtent2D extent, size_t samples) {
    std::mt19937 random(extent.width + 7);
    std::uniform_real_distribution<float> exponent(-4, 6);
    std::vector<Pixels> pictures(samples);
    for (Pixels& picture : pictures)
        for (uint32_t i = 0; i < extent.width * extent.height; ++i)
            picture.emplace_back(std::pow(10.0f, exponent(random)), std::pow(10.0f, exponent(random)), 0.1f, 1);
    return pictures;
}

// Rounding of one float, 6e-8, and of what is left of the sums, whatever their number; and that of a quotient, which a
// device may be 2.5 units in the last place off.
constexpr double kRounding = 4e-7;

TEST(Samples, MatchTheReference) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 33}, {131, 3}})
        for (size_t count : {1u, 2u, 5u, 64u}) {
            const std::vector<Pixels> samples = noise(extent, count);
            const Pixels got = mean_of(rig, samples, extent);
            const std::vector<glm::dvec3> want = reference::mean_of_samples(samples);
            for (size_t i = 0; i < got.size(); ++i) {
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[i][c], want[i][c], kRounding * want[i][c]) << count;
                ASSERT_EQ(got[i].a, 1);
            }
        }
    EXPECT_EQ(rig.complaints(), "");
}

// More passes than a pool has sets of descriptors.
TEST(Samples, AFrameOfTheLeastDeviceMayTakeManyOfThem) {
    constexpr size_t kMany = 150;
    PassRig rig(true);
    render::SampleBuffers buffers;
    buffers.resize(rig.device(), 1);
    for (int again = 0; again < 5; ++again) {
        graph::FrameGraph graph;
        const render::FrameContext frame = rig.frame(graph, VkExtent2D{1, 1});
        const render::SampleSums sums = buffers.declare(graph);
        for (size_t i = 0; i < kMany; ++i)
            render::add_sample(frame,
                               rig.image(graph, "scene " + std::to_string(i), render::kSceneFormat, {1, 1},
                                         Pixels{glm::vec4(float(i))}),
                               sums, i == 0);
        const graph::Resource kept = keep<glm::vec4>(graph, render::add_mean_of_samples(frame, sums, kMany));
        rig.run(graph);
        EXPECT_NEAR(rig.got<glm::vec4>(kept)[0].x, (kMany - 1) / 2.0, kRounding * kMany);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// 1e8 cd/m^2 once, 0.1 two thousand times: floats alone would forget all of these.
TEST(Samples, ManyFaintOnesAreNotLostBesideABrightOne) {
    PassRig rig;
    const VkExtent2D extent{3, 2};
    std::vector<Pixels> samples(2001, Pixels(6, glm::vec4(0.1f, 0.1f, 0.1f, 1)));
    samples[0] = Pixels(6, glm::vec4(1e8f, 0.1f, 0.1f, 1));
    const Pixels got = mean_of(rig, samples, extent);
    const std::vector<glm::dvec3> want = reference::mean_of_samples(samples);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[5][c], want[5][c], kRounding * want[5][c]);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Samples, OneIsItself) {
    PassRig rig;
    const std::vector<Pixels> one = noise({33, 9}, 1);
    EXPECT_EQ(mean_of(rig, one, {33, 9}), one[0]);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Samples, WhatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const VkExtent2D extent{9, 3};
    const std::vector<Pixels> clean = noise(extent, 4);
    std::vector<Pixels> samples = clean;
    samples[1][4].g = std::numeric_limits<float>::quiet_NaN();
    samples[2][11].r = std::numeric_limits<float>::infinity();
    const Pixels got = mean_of(rig, samples, extent), want = mean_of(rig, clean, extent);
    for (size_t i = 0; i < got.size(); ++i) {
        if (i == 4)
            EXPECT_FALSE(std::isfinite(got[i].g));
        else if (i == 11)
            EXPECT_FALSE(std::isfinite(got[i].r));
        else
            EXPECT_EQ(got[i], want[i]);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Samples, APictureThatTheDeviceCannotHoldIsRefused) {
    PassRig rig;
    render::SampleBuffers buffers;
    EXPECT_THROW(buffers.resize(rig.device(), uint64_t{1} << 40), Error);
    EXPECT_EQ(buffers.bytes(), 0u);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Samples, LieEvenlyInThePixel) {
    EXPECT_EQ(render::sample_places(1), std::vector{glm::dvec2(0)});
    for (uint32_t count : {2u, 3u, 16u, 64u, 100u, 4096u}) {
        const std::vector<glm::dvec2> places = render::sample_places(count);
        ASSERT_EQ(places.size(), count);
        glm::dvec2 sum(0);
        std::vector<bool> columns(count);
        for (const glm::dvec2& place : places) {
            EXPECT_TRUE(std::abs(place.x) < 0.5 && std::abs(place.y) < 0.5);
            sum += place;
            columns[size_t((place.x + 0.5) * count)] = true;
        }
        EXPECT_EQ(std::ranges::count(columns, true), count) << "one in each column";
        EXPECT_NEAR(sum.x / count, 0, 1e-12);
        if (std::has_single_bit(count)) {
            EXPECT_NEAR(sum.y / count, 0, 1e-12);
        }
    }
}

// Every rectangle of 1/64 of the pixel whose sides are powers of two has one of 64.
TEST(Samples, AreANet) {
    const std::vector<glm::dvec2> places = render::sample_places(64);
    for (uint32_t wide = 1; wide <= 64; wide *= 2) {
        std::vector<int> count(64);
        for (const glm::dvec2& p : places)
            ++count[size_t((p.x + 0.5) * wide) + wide * size_t((p.y + 0.5) * (64 / wide))];
        EXPECT_EQ(std::ranges::count(count, 1), 64) << wide << " columns";
    }
}

}  // namespace
}  // namespace vesper::test::samples_test
