// Visibility of directional lamps from pixels, on the device. SPDX-License-Identifier: MIT
#include "passes/shadows/directional_visibility_reference.h"

#include <cmath>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "passes/shade_reference.h"
#include "passes/shadows/penumbra_reference.h"
#include "support/lit.h"
#include "support/noise.h"
#include "support/occluders.h"
#include "support/ray_caster.h"
#include "support/snapping.h"

namespace vesper::test::directional_visibility_test {
namespace {

constexpr uint32_t kPixels = 500;  // over 10 m of ground
constexpr double kMetres = 10;
const glm::quat kDown = glm::angleAxis(float(-kPi / 2), glm::vec3(1, 0, 0));

scene::Lamp light_of(double degrees, float lux = 100) {
    scene::Lamp lamp;
    lamp.kind = scene::Lamp::Kind::Directional;
    lamp.intensity = lux, lamp.angular_diameter = float(degrees * kRadiansPerDegree);
    return lamp;
}

OccluderScene ground() {
    OccluderScene s;
    s.plate({0, 0, 0}, {20, 0, 0}, {0, 0, -20});
    return s;
}

// Calls `visit(x, z, share)` for pixels of the ground, lit by 100 lx from above.
template <class Visit>
void shares(OccluderScene& s, Visit visit) {
    PassRig rig;
    Lit lit(rig, s.scene());
    const Lit::Picture p = lit.render(view_of_the_ground(kPixels, kMetres));
    for (size_t i = 0; i < p.pixels.size(); ++i) {
        const glm::dvec3 at = p.place(i, kPixels);
        if (at.z < -19.99) visit(at.x, -at.y, double(p.pixels[i].y) * kPi / 100);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// The edge of a plate: a disc is uncovered as x grows. Texels are 16 mm, pixels 20 mm.
TEST(DirectionalVisibility, PenumbraIsThatOfADiscPastAnEdge) {
    struct Case {
        double height, degrees;
    };
    for (const Case& c : {Case{2, 5}, {10, 2}, {15, 0.53}, {8, 0.53}}) {
        SCOPED_TRACE("edge at " + std::to_string(c.height) + " m, " + std::to_string(c.degrees) + " degrees");
        const double radius = c.height * std::tan(c.degrees / 2 * kRadiansPerDegree);
        OccluderScene s = ground();
        s.lamp(light_of(c.degrees), {0, 0, 0}, kDown);
        s.plate({-10, float(c.height), 0}, {10, 0, 0}, {0, 0, -12});
        double mean = 0, spread = 0, largest = 0;
        size_t pixels = 0, wrong = 0;
        shares(s, [&](double x, double, double share) {
            const double expected = reference::disc_beyond(-x / radius), off = share - expected;
            if (x < -1.3 * radius - 0.04) wrong += share != 0 ? 1 : 0;
            if (x > 1.3 * radius + 0.04) wrong += std::abs(share - 1) > 1e-4 ? 1 : 0;
            largest = std::max(largest, std::abs(off));
            if (expected < 0.001 || expected > 0.999) return;
            mean += off, spread += expected < 0.5 ? -off : off, ++pixels;
        });
        EXPECT_GE(pixels, 1000u);
        EXPECT_EQ(wrong, 0u);
        // Of the 32 points up to three are at the same place across an edge; a texel is up to a quarter of the width.
        EXPECT_LT(std::abs(mean / double(pixels)), 0.025);
        EXPECT_LT(std::abs(spread / double(pixels)), 0.04);
        EXPECT_LT(largest, 0.25);
    }
}

// A lamp without a size: a shadow ends within a texel of where the ray by the edge does.
TEST(DirectionalVisibility, AShadowEndsWhereTheRayByTheEdgeDoes) {
    OccluderScene s = ground();
    constexpr double kTilt = 0.6;  // towards +x
    s.lamp(light_of(0), {0, 0, 0}, glm::angleAxis(float(kTilt), glm::vec3(0, 0, 1)) * kDown);
    s.plate({-1, 3, 0}, {0.9f, 0, 0}, {0, 0, -0.6f});
    size_t dark = 0, wrong = 0;
    shares(s, [&](double x, double z, double share) {
        const double from_middle = std::abs(x + 1 - 3 * std::tan(kTilt)),
                     inside = std::min(0.9 - from_middle, 0.6 - std::abs(z));
        if (std::abs(inside) < 0.03) return;
        dark += share == 0 ? 1 : 0;
        wrong += std::abs(share - (inside > 0 ? 0 : std::cos(kTilt))) > 1e-3 ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(dark, 3000u);
}

// A thin wall 1 m high, light at 45 degrees over it. At d behind the wall the ground is 1.41 d of the light's way from
// it: a shadow begins where that is more than 1/64 m and half a texel of 16 mm, at 17 mm, but for a texel.
TEST(DirectionalVisibility, ShadowsBeginAtTheFootOfAWall) {
    PassRig rig;
    OccluderScene s = ground();
    s.lamp(light_of(0), {0, 0, 0}, glm::angleAxis(float(kPi / 4), glm::vec3(0, 0, 1)) * kDown);
    s.plate({0, 0.5f, 0}, {0, 0.5f, 0}, {0, 0, -5});
    Lit all(rig, s.scene());
    const Lit::Picture p = all.render(view_of_the_ground(300, 0.3));
    double leak = 0;  // m of lit ground behind the wall, the mean over rows
    size_t far = 0;
    for (size_t i = 0; i < p.pixels.size(); ++i) {
        const double x = p.place(i, 300).x, share = double(p.pixels[i].g) * kPi / 100 / std::sqrt(0.5);
        if (p.place(i, 300).z > -19.99 || x < 0) continue;
        leak += share * 1e-3 / 300;
        far += x > 0.05 && share > 0 ? 1 : 0;
    }
    EXPECT_EQ(far, 0u);
    EXPECT_GT(leak, 0.006);
    EXPECT_LT(leak, 0.028);
    RecordProperty("leak_mm", std::to_string(1e3 * leak));
    EXPECT_EQ(rig.complaints(), "");
}

// Maps of noise: shares are those of the reference, for several lamps, and at a size that is no whole number of blocks.
TEST(DirectionalVisibility, SharesAreThoseOfTheReference) {
    PassRig rig;
    Noise noise(8);
    constexpr uint32_t kLamps = 6, kLevels = 3;
    const gpu_scene::View view =
        gpu_scene::View::symmetric({83, 61}, 0.7f, glm::translate(glm::dmat4(1), glm::dvec3(-3e4, 2, 0)));
    const render::ClipmapPlan plan{.lamps = kLamps, .side = 64};
    Surfaces s{view.extent, {}, {}, {}};
    for (uint32_t i = 0; i < view.extent.width * view.extent.height; ++i) {  // a road and a wall, and bumps on them
        const glm::dvec2 ray =
            glm::dvec2(view.ray_scale()) * (glm::dvec2(s.pixel(i)) + 0.5) + glm::dvec2(view.ray_offset());
        const double road = ray.y < 0 ? 1.2 / -ray.y : 1e6, depth = std::min(road, 40.0);
        const glm::dvec3 normal =
            glm::normalize((road < 40 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1)) + 0.2 * noise.facing(0.1));
        s.reflectance.emplace_back(0.5f, 0.25f, 0.75f, 0.0f);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(normal)), float(depth), i % 3 == 0 ? 0.4f : 1.0f);
        s.emission.emplace_back(0);
    }
    gpu_scene::LampList list;
    list.counts.directional = kLamps;
    const glm::dvec3 eye = gpu_scene::eye_of(view);
    std::vector<reference::DirectionalLamp> lamps;
    std::vector<shared::Clipmap> maps;
    std::vector<uint16_t> texels;
    for (uint32_t k = 0; k < kLamps; ++k) {
        const double angle = 0.03 * k;  // rad
        const glm::dmat3 rotation =
            render::map_frame(glm::mat4_cast(glm::angleAxis(-1.0 - 0.1 * k, glm::normalize(glm::dvec3(1, 0.2, 0.4)))))
                .rotation;
        shared::Lamp lamp{};
        lamp.intensity = 100, lamp.colour = {1 + 0.1f * float(k), 1, 0.2f * float(k)},
        lamp.axis = glm::vec3(glm::transpose(rotation)[2]);
        list.lamps.push_back(lamp), list.indices.push_back(k);
        maps.push_back(render::clipmap(plan, k, rotation, angle, view));
        lamps.push_back({.levels = {}, .distances = {}, .radius = std::tan(angle / 2)});
        for (uint32_t l = 0; l < kLevels; ++l) {
            lamps[k].levels.push_back(
                {rotation, render::level_middle(rotation, eye, l), render::level_half_width(l), 64});
            std::vector<double>& distances = lamps[k].distances.emplace_back();
            for (uint32_t i = 0; i < 64 * 64; ++i) {
                const float value =
                    noise.unit() < 0.2f ? std::numeric_limits<float>::infinity() : 40 * noise.fine() - 25;
                texels.push_back(glm::packHalf1x16(value));
                distances.push_back(double(glm::unpackHalf1x16(texels.back())));
            }
        }
        texels.resize(texels.size() + (shared::kClipmapLevels - kLevels) * 64 * 64);
    }
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, view);
    const render::GBuffer g = upload(graph, s);
    const LitBlocks lit =
        light(frame, g, list, upload(graph, gpu_scene::IntensityTables{.texels = {glm::vec4(0)}}), {}, {},
              {graph.upload("maps", maps, VK_FORMAT_R32G32B32A32_SFLOAT),
               graph.upload("distances", texels, VK_FORMAT_R16_SFLOAT), kLevels, plan.side});
    const graph::Resource words = keep<uint32_t>(graph, lit.blocks.directional_shares),
                          scene = keep<glm::vec4>(graph, lit.scene);
    rig.run(graph);
    const std::vector<uint32_t> got = rig.got<uint32_t>(words);
    const std::vector<glm::vec4> pixels = rig.got<glm::vec4>(scene);
    // Vulkan promises cosines within 2^-11 only. On a device that keeps to no more in other things either one of the
    // lookups rarely lands in the next texel.
    const bool rough = snaps_coarsely(rig.device());
    size_t compared = 0, partly = 0, exact = 0, astray = 0;
    for (size_t i = 0; i < s.surface.size(); ++i) {
        const glm::uvec2 pixel = s.pixel(i), in_block = pixel % 8u;
        const uint32_t block = pixel.y / 8 * ((view.extent.width + 7) / 8) + pixel.x / 8;
        const glm::dvec3 seen_from_eye =
            reference::view_position(lit.clusters.push.grid, glm::dvec2(pixel) + 0.5, double(s.surface[i].z));
        const glm::dvec3 normal = reference::octahedral_decode(glm::dvec2(s.surface[i]));
        const double roughness = double(s.surface[i].w);
        const glm::dvec3 base(s.reflectance[i]);
        reference::Shaded light;
        for (uint32_t k = 0; k < kLamps; ++k) {
            const uint32_t word = got[(block * 2 + k / 4) * 64 + in_block.y * 8 + in_block.x];
            const double share = double(word >> 8 * (k % 4) & 255) / 255,
                         cosine = -glm::dot(normal, glm::dvec3(list.lamps[k].axis));
            reference::Shaded whole;
            reference::add_lamp(list.lamps[k], reference::LampKind::Directional, seen_from_eye, normal, base / kPi,
                                reference::normal_reflectance(base, 0, roughness), roughness, 0.001, whole);
            light.luminance += share * whole.luminance, light.rounding += share * whole.rounding;
            const reference::DirectionalShare want =
                reference::directional_share(lamps[k], eye, eye + seen_from_eye, normal);
            if (cosine <= 0 || want.uncertain > 8) continue;
            ++compared, partly += want.share > 0 && want.share < 1 ? 1 : 0;
            // Where a row or a block of pixels finds all or nothing, some of the 32 lookups may still differ.
            const double missed = share == 0 || share == 1 ? 8 : 0.1;
            const double off = std::abs(share - want.share), allowed = (want.uncertain + missed) / 32;
            EXPECT_LE(off, allowed + (rough ? 1.0 / 32 : 0)) << i << " lamp " << k;
            astray += off > allowed ? 1 : 0;
            exact += std::abs(share - want.share) < 0.002 ? 1 : 0;
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(double(pixels[i][c]), light.luminance[c], 1e-4 * light.luminance[c] + light.rounding[c] + 1e-9)
                << i << ": shading takes other shares";
    }
    EXPECT_LE(astray, rough ? compared / 1000 : 0);
    EXPECT_GT(compared, 8000u);
    EXPECT_GT(partly, 4000u);
    EXPECT_GT(double(exact), 0.9 * double(compared));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(DirectionalVisibility, MapsThatNoDeviceCanReadAreRefused) {
    PassRig rig;
    const gpu_scene::View view = gpu_scene::View::symmetric({8, 8}, 0.7f, glm::dmat4(1));
    Surfaces s{view.extent, {}, {}, {}};
    s.reflectance.resize(64), s.surface.resize(64), s.emission.resize(64);
    gpu_scene::LampList list;
    list.counts.directional = 1, list.lamps.resize(1), list.indices.resize(1);
    graph::FrameGraph graph;
    const gpu::OwnedBuffer none;
    const LitBlocks lit = light(rig.frame(graph, view), upload(graph, s), list,
                                upload(graph, gpu_scene::IntensityTables{.texels = {glm::vec4(0)}}), {}, {},
                                {graph.upload("maps", std::vector<shared::Clipmap>(1), VK_FORMAT_R32G32B32A32_SFLOAT),
                                 graph.external("distances", none, uint64_t{1} << 40, VK_FORMAT_R16_SFLOAT), 1, 64});
    keep<glm::vec4>(graph, lit.scene);
    try {
        rig.run(graph);
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("'distances' has "), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what())
                      .find(rig.device().has_long_texel_buffers() ? "maxTexelBufferElements" : "maxStorageBufferRange"),
                  std::string::npos)
            << error.what();
    }
}

// Against rays through boxes and plates at random, away from edges.
TEST(DirectionalVisibility, AgreesWithRays) {
    PassRig rig;
    Noise noise(21);
    OccluderScene s = ground();
    for (int i = 0; i < 25; ++i) {
        const glm::vec3 middle{8 * noise.unit() - 4, 6 * noise.unit(), 8 * noise.unit() - 4};  // {}: in this order
        s.box(middle, glm::vec3{0.2f + noise.unit(), 0.1f + noise.unit(), 0.1f + 0.5f * noise.unit()});
    }
    const glm::quat turn = glm::angleAxis(-1.0f, glm::normalize(glm::vec3(1, 0.3f, 0.2f)));
    s.lamp(light_of(0), {0, 0, 0}, turn);
    Lit lit(rig, s.scene());
    const RayCaster rays(s.scene(), scene::world_transforms(s.scene(), 0));
    const glm::dvec3 towards = -glm::dvec3(turn * glm::vec3(0, 0, -1));
    const Lit::Picture p = lit.render(view_of_the_ground(kPixels, kMetres));
    size_t compared = 0, dark = 0, wrong = 0;
    for (size_t i = 0; i < p.pixels.size(); i += 3) {
        const glm::dvec3 from_eye = p.place(i, kPixels);
        const glm::dvec3 at(from_eye.x, 20 + from_eye.z, -from_eye.y);
        const glm::dvec3 n = reference::octahedral_decode(glm::dvec2(p.surfaces[i])), normal(n.x, n.z, -n.y);
        if (glm::dot(normal, towards) < 0.05) continue;
        // 0.045 m beside: the bias of 16 mm and half a texel, and a texel.
        const auto lit_at = [&](glm::dvec3 aside) {
            const glm::dvec3 start = at + 0.03 * normal + aside;
            return std::isinf(rays.hit(start, start + 100.0 * towards, 0, 1, [](uint32_t) { return true; }));
        };
        const bool expected = lit_at(glm::dvec3(0));
        bool certain = true;
        for (const glm::dvec3 aside :
             {glm::dvec3(0.045, 0, 0), {-0.045, 0, 0}, {0, 0, 0.045}, {0, 0, -0.045}, {0, 0.045, 0}})
            certain = certain && lit_at(aside) == expected;
        if (!certain) continue;
        ++compared, dark += expected ? 0 : 1;
        wrong += (p.pixels[i].y > 0) == expected ? 0 : 1;
    }
    EXPECT_GT(compared, 40000u);
    EXPECT_GT(dark, 8000u);
    EXPECT_LT(double(wrong), 1e-3 * double(compared));
    EXPECT_EQ(rig.complaints(), "");
}

// Light that grazes a plane, at 1 degree: it is lit all over.
TEST(DirectionalVisibility, APlaneNeverHidesItself) {
    for (const double elevation : {1.0, 3.0, 10.0}) {
        OccluderScene s = ground();
        s.lamp(
            light_of(0.53), {0, 0, 0},
            glm::angleAxis(float((90 - elevation) * kRadiansPerDegree), glm::normalize(glm::vec3(0.3f, 0, 1))) * kDown);
        size_t wrong = 0, pixels = 0;
        const double lit = std::sin(elevation * kRadiansPerDegree);
        shares(s, [&](double, double, double share) { ++pixels, wrong += std::abs(share - lit) > 1e-3 * lit ? 1 : 0; });
        EXPECT_GT(pixels, 200000u);
        EXPECT_EQ(wrong, 0u) << elevation << " degrees";
    }
}

// A bar that is narrower than the disc behind it has no umbra: 0.1 m, 15 m above the ground.
TEST(DirectionalVisibility, OfANarrowBarHasNoUmbra) {
    OccluderScene s = ground();
    constexpr double kTilt = 0.2;  // towards +x, so that the eye sees its shadow beside it
    s.lamp(light_of(2), {0, 0, 0}, glm::angleAxis(float(kTilt), glm::vec3(0, 0, 1)) * kDown);
    s.plate({0, 15, 0}, {0.05f, 0, 0}, {0, 0, -12});
    const double radius = 15 * std::tan(1 * kRadiansPerDegree) / std::pow(std::cos(kTilt), 2);
    double sum = 0, expected_sum = 0, least = 1;
    size_t pixels = 0;
    shares(s, [&](double x, double, double lit) {
        const double from_middle = x - 15 * std::tan(kTilt), share = lit / std::cos(kTilt);
        if (std::abs(from_middle) > 1) return;
        ++pixels, sum += 1 - share, least = std::min(least, share);
        expected_sum += reference::disc_beyond((-0.05 - from_middle) / radius) -
                        reference::disc_beyond((0.05 - from_middle) / radius);
    });
    EXPECT_GT(pixels, 40000u);
    EXPECT_NEAR(sum, expected_sum, 0.15 * expected_sum) << "some pixels do not find the bar";
    EXPECT_GT(least, 0.5) << "three quarters of the disc are seen in the middle";
}

// Seen from far away a small scene has its shadows.
TEST(DirectionalVisibility, ReachesFromAFarEye) {
    PassRig rig;
    OccluderScene s;
    s.plate({0, 0, 0}, {5, 0, 0}, {0, 0, -5});
    s.plate({0, 2, 0}, {2, 0, 0}, {0, 0, -2});
    s.lamp(light_of(0.53), {0, 0, 0}, glm::angleAxis(0.7f, glm::vec3(0, 0, 1)) * kDown);
    Lit lit(rig, s.scene());
    const Lit::Picture p =
        lit.render(gpu_scene::View::symmetric({200, 200}, float(2 * std::atan(5.0 / 300)),
                                              glm::mat4_cast(glm::angleAxis(kPi / 2, glm::dvec3(1, 0, 0))) *
                                                  glm::translate(glm::dmat4(1), glm::dvec3(0, -300, 0))));
    size_t dark = 0;
    for (const glm::vec4& pixel : p.pixels) dark += pixel.y == 0 ? 1 : 0;
    // 4 m x 4 m of shadow, 1.7 m of it beside the plate; the picture shows 20 px a metre, and texels are 0.5 m.
    EXPECT_NEAR(double(dark), 4 * 1.68 * 400, 0.3 * 4 * 1.68 * 400);
    EXPECT_EQ(rig.complaints(), "");
}

// Clipmaps are never out of date, whether the eye, a body or the lamp has moved; if nothing has, none is drawn again.
TEST(DirectionalVisibility, IsNeverOutOfDate) {
    PassRig rig;
    OccluderScene s = ground();
    const uint32_t body = s.box({0, 1, 0}, {0.5f, 0.5f, 0.5f});
    const uint32_t sun = s.lamp(light_of(0.53), {0, 0, 0}, glm::angleAxis(0.4f, glm::vec3(0, 0, 1)) * kDown);
    Lit lit(rig, s.scene());
    gpu_scene::View view = view_of_the_ground(kPixels, kMetres);
    const uint32_t all = lit.render(view).levels;
    EXPECT_EQ(all, 3u) << "the ground's farthest corner is within 58 m";
    EXPECT_EQ(lit.render(view).levels, 0u) << "nothing has moved";
    const auto as_afresh = [&](const char* what, uint32_t least, uint32_t most) {
        const Lit::Picture now = lit.render(view);
        EXPECT_GE(now.levels, least) << what;
        EXPECT_LE(now.levels, most) << what;
        Lit again(rig, s.scene());
        again.poses = lit.poses;
        EXPECT_EQ(now.pixels, again.render(view).pixels) << what;
    };
    view.world_to_view = view.world_to_view * glm::translate(glm::dmat4(1), glm::dvec3(-1.5, 0, 0));
    as_afresh("the eye, by less than the steps of most levels", 1, all - 1);
    lit.poses.world[body] = glm::translate(glm::dmat4(1), glm::dvec3(1, 0.3, 0.2));
    as_afresh("a body", all, all);
    lit.poses.world[sun] = glm::mat4_cast(glm::angleAxis(-0.3, glm::dvec3(0, 0, 1))) * lit.poses.world[sun];
    as_afresh("the lamp", all, all);
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::directional_visibility_test
