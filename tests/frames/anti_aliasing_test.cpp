// Whole frames at edges: areas that are known, light that must not come or go, and the mean of many samples.
// SPDX-License-Identifier: MIT
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "passes/samples_reference.h"
#include "render/renderer.h"
#include "support/rooms.h"

namespace vesper::test::anti_aliasing_test {
namespace {

using gpu_scene::View;
using scene::Scene;

constexpr uint32_t kSide = 64;          // px
constexpr double kPixel = 1.0 / kSide;  // m of the plane at 1 m that the view covers exactly

View view() { return View::symmetric({kSide, kSide}, 2 * std::atan(0.5f), glm::dmat4(1)); }

/// A sheet that emits, in the plane at 1 m: corners in px from the middle of the picture, y down.
void add_sheet(Scene& scene, uint32_t material, std::array<glm::dvec2, 4> corners) {
    add_rectangle(scene, material, {0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    for (size_t k = 0; k < 4; ++k)
        scene.meshes.back().primitives[0].vertices[k].position = {float(kPixel * corners[k].x),
                                                                  float(-kPixel * corners[k].y), -1};
    scene.materials[material].double_sided = true;
}

class Frames {
public:
    Frames()
        : device_({.select = "", .validation = true, .on_message = [this](const std::string& m) { complaints += m; }}) {
    }
    ~Frames() { EXPECT_EQ(complaints, ""); }

    /// Luminance of every pixel, cd/m^2.
    std::vector<double> of(const Scene& scene, uint32_t samples, bool anti_aliasing = true) {
        render::Renderer renderer(device_, scene);
        render::RenderSettings settings;
        settings.samples = samples, settings.anti_aliasing = anti_aliasing;
        const render::Frame frame = renderer.render(settings, view(), {scene::world_transforms(scene, 0)}, 0,
                                                    {.display = false, .scene = true});
        std::vector<double> light;
        for (size_t i = 0; i < frame.scene.size(); i += 4) light.push_back(double(frame.scene[i + 1]));
        return light;
    }

    std::string complaints;

private:
    gpu::Device device_;
};

double sum_of(const std::vector<double>& light) {
    double sum = 0;
    for (const double l : light) sum += l;
    return sum;
}

/// A sheet of 100 cd/m^2 over the half of the plane where normal . place <= off, px.
class HalfPlane {
public:
    explicit HalfPlane(std::mt19937& random) {
        std::uniform_real_distribution<double> unit(-1, 1);
        const double angle = 3.1 * unit(random);
        off_ = 5 * unit(random), normal_ = {std::cos(angle), std::sin(angle)};
    }
    Scene scene() const {
        const glm::dvec2 along = 300.0 * glm::dvec2(-normal_.y, normal_.x), edge = off_ * normal_,
                         far = (off_ - 300) * normal_;
        Scene scene;
        add_sheet(scene, add_material(scene, 0, 100), {edge - along, edge + along, far + along, far - along});
        return scene;
    }
    /// Part of a pixel.
    double covers(uint32_t i) const {
        const glm::dvec2 middle = glm::dvec2(i % kSide, i / kSide) + 0.5 - kSide / 2.0;
        return reference::covered_by_half_plane(normal_, off_ - glm::dot(normal_, middle));
    }

private:
    double off_;
    glm::dvec2 normal_;
};

// A half plane at random places and angles: each pixel holds the part of it that is covered, to the steps that points
// of a net allow, whose number on one side of a line is off by a few.
TEST(AntiAliasing, AHalfPlaneCoversWhatItDoes) {
    Frames frames;
    std::mt19937 random(1);
    for (int round = 0; round < 6; ++round) {
        const HalfPlane half(random);
        const Scene scene = half.scene();
        for (const auto& [samples, most] : {std::pair(1u, 0.14), {64u, 0.06}}) {  // two points, four
            const std::vector<double> got = frames.of(scene, samples);
            double sum = 0;
            for (uint32_t i = 0; i < kSide * kSide; ++i) {
                const double want = half.covers(i);
                sum += got[i] / 100 - want;
                // Rounding of the sum where there is one surface, or nothing.
                ASSERT_NEAR(got[i] / 100, want, want == 0 || want == 1 ? 1e-6 : most) << "round " << round;
            }
            EXPECT_NEAR(sum / kSide, 0, 0.02) << "light, px of each row";
        }
    }
}

// The same before a wall, where both surfaces are seen.
TEST(AntiAliasing, AHalfPlaneBeforeAWallCoversWhatItDoes) {
    Frames frames;
    std::mt19937 random(2);
    for (int round = 0; round < 6; ++round) {
        const HalfPlane half(random);
        Scene scene = half.scene();
        add_rectangle(scene, add_material(scene, 0, 10), {-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
        const std::vector<double> got = frames.of(scene, 1), jagged = frames.of(scene, 1, false);
        double largest = 0, sum = 0, before = 0;
        for (uint32_t i = 0; i < kSide * kSide; ++i) {
            const double want = half.covers(i);
            largest = std::max(largest, std::abs((got[i] - 10) / 90 - want));
            sum += (got[i] - 10) / 90 - want, before = std::max(before, std::abs((jagged[i] - 10) / 90 - want));
        }
        EXPECT_LT(largest, 0.14) << "round " << round;  // two of 16 points
        EXPECT_NEAR(sum / kSide, 0, 0.02) << "light, px of each row";
        EXPECT_GT(before, 0.4) << "without it there are steps";
    }
}

// Light of a bright square, 10^4 cd/m^2 on 1, does not change as it moves by sixteenths of a pixel.
TEST(AntiAliasing, ABrightSquareKeepsItsLightAsItMoves) {
    Frames frames;
    for (const auto& [samples, most] : {std::pair(1u, 0.03), {64u, 0.001}}) {
        std::vector<double> sums;
        for (int step = 0; step <= 16; ++step) {
            const glm::dvec2 low(-1.37 + step / 16.0, 0.2 + step / 32.0), high = low + 3.0;
            Scene scene;
            add_sheet(scene, add_material(scene, 0, 1e4f), {low, {high.x, low.y}, high, {low.x, high.y}});
            add_rectangle(scene, add_material(scene, 0, 1), {-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
            sums.push_back(sum_of(frames.of(scene, samples)) - kSide * kSide);
        }
        const auto [least, largest] = std::ranges::minmax(sums);
        EXPECT_LT(largest / least, 1 + most) << samples << " samples";
        EXPECT_NEAR(sums[0], 9 * 9999.0, 9 * 9999.0 * std::max(most, 0.02)) << "its area";
    }
}

// Strips of a third of a pixel, at all angles: with samples they keep their area.
TEST(AntiAliasing, AThinStripKeepsItsArea) {
    Frames frames;
    for (const double angle : {0.0, 0.3, 0.8, 1.5}) {
        const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
        Scene scene;
        add_sheet(scene, add_material(scene, 0, 1000),
                  {0.07 * across - 20.0 * along, 0.4 * across - 20.0 * along, 0.4 * across + 20.0 * along,
                   0.07 * across + 20.0 * along});
        EXPECT_NEAR(sum_of(frames.of(scene, 64)), 1000 * 0.33 * 40, 1000 * 0.33 * 40 * 0.02) << angle;
    }
}

// A panel of 10.4 x 10.4 px before a wall, in pieces of a quarter of a pixel, lit or emitting; and one of 40 x 40 px
// whose texture has holes of 3 px. Not all that they are made of is seen by the middle of some pixel: light must not be
// lost for that. What emits is drawn by its area, and so is what has holes.
TEST(AntiAliasing, FineMeshesAndHolesKeepTheirLight) {
    Frames frames;
    for (const auto& [what, masked, lit] :
         {std::tuple("fine mesh", false, true), {"fine mesh that emits", false, false}, {"holes", true, false}}) {
        SCOPED_TRACE(what);
        Scene scene;
        scene.ambient_illuminance = lit ? float(1000 * kPi) : 0;
        const uint32_t panel = add_material(scene, lit ? 1 : 0, lit ? 0 : 1000), pieces = masked ? 1 : 40;
        const double side = masked ? 40 : 10.4;
        if (masked) {
            scene.images = {{"fence", 16, 1, {}}};
            for (int i = 0; i < 16; ++i)
                scene.images[0].rgba.insert(scene.images[0].rgba.end(), {0, 0, 0, uint8_t(i % 2 ? 255 : 0)});
            scene.materials[panel].base_colour = {1, 1, 1, 1};
            scene.materials[panel].base_colour_texture.image = 0;
            scene.materials[panel].alpha = scene::Material::Alpha::Mask, scene.materials[panel].alpha_cutoff = 0.5f;
        }
        for (uint32_t y = 0; y < pieces; ++y)
            for (uint32_t x = 0; x < pieces; ++x) {
                const glm::dvec2 low = glm::dvec2(0.3) + side * (glm::dvec2(x, y) / double(pieces) - 0.5),
                                 high = low + side / pieces;
                add_sheet(scene, panel, {low, {high.x, low.y}, high, {low.x, high.y}});
                std::vector<scene::Vertex>& v = scene.meshes.back().primitives[0].vertices;
                v[1].uv = {1, 0}, v[2].uv = {1, 1}, v[3].uv = {0, 1};
            }
        add_rectangle(scene, add_material(scene, 0, 1), {-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
        const double with = sum_of(frames.of(scene, 1)), without = sum_of(frames.of(scene, 1, false)),
                     many = sum_of(frames.of(scene, 64));
        if (lit) {
            EXPECT_NEAR(with, without, 0.01 * without);
        }
        EXPECT_NEAR(with, many, (lit ? 0.25 : 0.02) * many);
    }
}

// Signs and windows that are about as small as a pixel: as they move by eighths of a pixel, their
// light does not change.
TEST(AntiAliasing, SmallEmittersKeepTheirLightAsTheyMove) {
    Frames frames;
    for (const glm::dvec2 size : {glm::dvec2(0.3, 0.3), {2.5, 0.4}, {3, 4}}) {
        SCOPED_TRACE(std::to_string(size.x) + " x " + std::to_string(size.y) + " px");
        std::vector<double> sums, jagged;
        for (int step = 0; step <= 8; ++step) {
            const glm::dvec2 low(-4.37 + step / 8.0, 0.2 + step / 16.0), high = low + size;
            Scene scene;
            add_sheet(scene, add_material(scene, 0, 1e4f), {low, {high.x, low.y}, high, {low.x, high.y}});
            add_rectangle(scene, add_material(scene, 0, 1), {-5, -5, -2}, {10, 0, 0}, {0, 10, 0});
            sums.push_back(sum_of(frames.of(scene, 1)) - kSide * kSide);
            if (step % 4 == 0 && size.y == 0.4) jagged.push_back(sum_of(frames.of(scene, 1, false)) - kSide * kSide);
        }
        const auto [least, largest] = std::ranges::minmax(sums);
        EXPECT_LT(largest / least, 1.001);
        EXPECT_NEAR(sums[0], 1e4 * size.x * size.y, 1e2 * size.x * size.y);
        if (!jagged.empty()) {
            EXPECT_GT(std::ranges::max(jagged), 1.5 * std::ranges::min(jagged)) << "without it comes and goes";
        }
    }
}

// Behind a post of strips that are all narrower than a pixel, as round ones are.
TEST(AntiAliasing, SmallEmittersAreHiddenByFineMeshes) {
    Frames frames;
    Scene scene;
    const uint32_t sign = add_material(scene, 0, 1e4f), dark = add_material(scene, 0, 0);
    add_rectangle(scene, sign, {-0.03f, 0, -1}, {0.03f, 0, 0}, {0, 0.015f, 0});  // 1.9 px wide
    const double all = sum_of(frames.of(scene, 1));
    EXPECT_NEAR(all, 1e4 * 1.92 * 0.96, 100);
    for (int i = 0; i < 80; ++i)
        add_rectangle(scene, dark, {-0.05f + 0.001f * float(i), -0.2f, -0.5f}, {0.001f, 0, 0}, {0, 0.4f, 0});
    EXPECT_NEAR(sum_of(frames.of(scene, 1)), 0, 1e-3 * all);
}

// One that a post hides to a third, and one behind a wall.
TEST(AntiAliasing, SmallEmittersAreHidden) {
    Frames frames;
    Scene scene;
    const uint32_t sign = add_material(scene, 0, 1e4f);
    add_rectangle(scene, sign, {-0.03f, 0, -1}, {0.015f, 0, 0}, {0, 0.015f, 0});
    add_rectangle(scene, sign, {0.03f, 0, -1}, {0.015f, 0, 0}, {0, 0.015f, 0});
    const uint32_t dark = add_material(scene, 0, 0);
    const auto visible = [&] { return sum_of(frames.of(scene, 1)); };
    const double all = visible();
    EXPECT_NEAR(all, 2 * 1e4 * 0.96 * 0.96, 100);
    add_rectangle(scene, dark, {-0.125f, -0.2f, -0.5f}, {0.12f, 0, 0}, {0, 0.4f, 0});  // to -0.01 at 1 m
    EXPECT_NEAR(visible(), all / 2, 0.01 * all);
    add_rectangle(scene, dark, {-0.2f, -0.2f, -1.02f}, {0.4f, 0, 0}, {0, 0.4f, 0});
    EXPECT_NEAR(visible(), all / 2, 0.01 * all) << "a wall behind hides nothing";
    scene.meshes[2].primitives[0].vertices[1].position.x = scene.meshes[2].primitives[0].vertices[2].position.x =
        -0.0125f;  // to -0.025 at 1 m: a third of it
    EXPECT_NEAR(visible(), all * 5 / 6, 0.04 * all);
    scene.nodes[3].translation.z = 0.022;
    EXPECT_NEAR(visible(), 0, 1e-3 * all) << "the wall 2 mm before it";
    scene.materials[dark].alpha = scene::Material::Alpha::Mask;
    EXPECT_NEAR(visible(), 0, 1e-3 * all) << "the same as if it could have holes";
}

// A grating of 0.37 px, half of it bright: its mean.
TEST(AntiAliasing, AGratingTooFineIsItsMean) {
    Frames frames;
    Scene scene;
    const uint32_t bright = add_material(scene, 0, 100);
    for (int i = -60; i < 60; ++i)
        add_sheet(scene, bright, {{{0.37 * i, -20}, {0.37 * i + 0.185, -20}, {0.37 * i + 0.185, 20}, {0.37 * i, 20}}});
    const std::vector<double> got = frames.of(scene, 64);
    for (uint32_t y = 15; y < 49; ++y)
        for (uint32_t x = 15; x < 49; ++x)
            EXPECT_NEAR(got[kSide * y + x], 50, 8) << x << ", " << y;  // of whole periods
    double sum = 0;
    for (uint32_t y = 15; y < 49; ++y)
        for (uint32_t x = 15; x < 49; ++x) sum += got[kSide * y + x] / (34 * 34);
    EXPECT_NEAR(sum, 50, 1);
}

// Lamps, a road and a box: the sum has the same bits on every run, and one sample is the frame itself.
TEST(AntiAliasing, TheSameBitsOnEveryRun) {
    Frames frames;
    Scene scene = lit_room();
    add_box(scene, 0, {0.2f, 0.3f, 0.1f}, {0.1f, -0.2f, -1});
    EXPECT_EQ(frames.of(scene, 7), frames.of(scene, 7));
    EXPECT_EQ(frames.of(scene, 1), frames.of(scene, 1));
}

// The frame's edges are those of the mean of many samples, within what a net of 16 points leaves.
TEST(AntiAliasing, EdgesAreNearTheMeanOfManySamples) {
    Frames frames;
    Scene scene = lit_room();
    add_box(scene, 0, {0.2f, 0.3f, 0.1f}, {0.1f, -0.2f, -1});
    const std::vector<double> many = frames.of(scene, 256), one = frames.of(scene, 1),
                              none = frames.of(scene, 1, false);
    double with = 0, without = 0;
    for (size_t i = 0; i < many.size(); ++i) with += std::abs(one[i] - many[i]), without += std::abs(none[i] - many[i]);
    EXPECT_LT(with, 0.5 * without);
}

}  // namespace
}  // namespace vesper::test::anti_aliasing_test
