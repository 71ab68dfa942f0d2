// Visibility of lamps from pixels, on the device: closed forms, and rays through the whole night street.
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "base/angle.h"
#include "gpu_scene/cameras.h"
#include "passes/shade_reference.h"
#include "passes/shadows/visibility_reference.h"
#include "places.h"
#include "scene/convert.h"
#include "scene/scene_files.h"
#include "support/lit.h"
#include "support/noise.h"
#include "support/occluders.h"
#include "support/ray_caster.h"

namespace vesper::test::visibility_test {
namespace {

// A lamp 6 m above the ground and a plate 2 m above it: the edge of the shadow is where the ray by the plate's edge
// ends, half as far out again. Texels of the map are 2 mm there.
TEST(Visibility, AShadowEndsWhereTheRayByTheEdgeDoes) {
    PassRig rig;
    OccluderScene s;
    s.plate({0, 0, 0}, {20, 0, 0}, {0, 0, -20});
    s.plate({0, 2, 0}, {1, 0, 0}, {0, 0, -0.6f});
    scene::Lamp lamp;
    lamp.intensity = 1000;
    for (const bool spot : {false, true}) {
        SCOPED_TRACE(spot ? "spot" : "point");
        lamp.kind = spot ? scene::Lamp::Kind::Spot : scene::Lamp::Kind::Point;
        lamp.inner_cone = 1.1f, lamp.outer_cone = 1.2f;
        OccluderScene lit = s;
        lit.lamp(lamp, {0, 6, 0}, glm::angleAxis(float(-kPi / 2), glm::vec3(1, 0, 0)));
        Lit all(rig, lit.scene());
        // From straight above the lamp; 500 px over 10 m of ground, the plate in the middle.
        const gpu_scene::View view = view_of_the_ground(500, 10);
        const Lit::Picture p = all.render(view);
        size_t wrong = 0, dark = 0;
        for (size_t i = 0; i < p.pixels.size(); ++i) {
            const glm::dvec3 at = p.place(i, 500);
            const double x = at.x, z = -at.y, away = std::hypot(x, 6.0, z);
            if (at.z > -19) continue;  // the plate
            // Half a pixel of 20 mm, half a texel and rounding.
            const double inside = std::min(1.5 - std::abs(x), 0.9 - std::abs(z));
            if (std::abs(inside) < 0.02) continue;
            const double bright = double(p.pixels[i].x + p.pixels[i].y + p.pixels[i].z);
            dark += bright == 0 ? 1 : 0;
            if (inside > 0) {
                wrong += bright != 0 ? 1 : 0;
            } else if (!spot || std::acos(6 / away) < 1.05) {
                const double light = 3 * 1000 * 6 / (away * away * away) / kPi;
                wrong += std::abs(bright - light) > 2e-3 * light ? 1 : 0;
            }
        }
        EXPECT_EQ(wrong, 0u);
        EXPECT_GT(dark, 500u);
        EXPECT_GT(p.pairs.dark, 2u);
        EXPECT_GT(p.pairs.mixed, 10u);
        EXPECT_GT(p.pairs.lit, 3000u);
        // Pixel by pixel, without blocks, it is the same; shares of pixels at edges are rounded to fifteenths of it.
        const Lit::Picture slow = all.render(view, true);
        for (size_t i = 0; i < p.pixels.size(); ++i) {
            const double most = 1000 / (6 * 6 * kPi) / 15;
            ASSERT_NEAR(p.pixels[i].y, slow.pixels[i].y, 2e-3 * slow.pixels[i].y + most) << i % 500 << " " << i / 500;
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A thin wall 1 m high on the ground, 2 m from a lamp 2 m up. On the ground behind it the way from the wall is d of the
// 2 m + d from the lamp, and so 2 d of the norm |x| + |y| + |z| = 4 m + d; a shadow begins where that is more than 1/64
// m
// + (1/1024 + half a texel) 4 m. Maps have 256 to 2,048 texels: that is at 10 to 18 mm; and a texel across is up to 8
// mm.
TEST(Visibility, ShadowsBeginAtTheFootOfAWall) {
    PassRig rig;
    OccluderScene s;
    s.plate({0, 0, 0}, {20, 0, 0}, {0, 0, -20});
    s.plate({0, 0.5f, 0}, {0, 0.5f, 0}, {0, 0, -5});
    scene::Lamp lamp;
    lamp.intensity = 1000;
    s.lamp(lamp, {-2, 2, 0}, glm::angleAxis(float(-kPi / 2), glm::vec3(1, 0, 0)));
    Lit all(rig, s.scene());
    constexpr uint32_t kPixels = 400;  // of 0.5 mm
    for (const bool all_lamps : {false, true}) {
        const Lit::Picture p = all.render(view_of_the_ground(kPixels, 0.2), all_lamps);
        size_t dark_before = 0, lit_behind = 0;
        double leak = 0;  // m of lit ground behind the wall, the mean over rows
        for (size_t i = 0; i < p.pixels.size(); ++i) {
            const double x = p.place(i, kPixels).x, bright = double(p.pixels[i].g);
            if (p.place(i, kPixels).z > -19.99) continue;  // the wall
            dark_before += x < -0.002 && bright == 0 ? 1 : 0;
            lit_behind += x > 0.03 && bright > 0 ? 1 : 0;
            leak += x > 0 && bright > 0 ? 0.2 / kPixels / kPixels : 0;
        }
        EXPECT_EQ(dark_before, 0u);
        EXPECT_EQ(lit_behind, 0u);
        EXPECT_GT(leak, 0.006);
        EXPECT_LT(leak, 0.020);
        RecordProperty("leak_mm", std::to_string(1e3 * leak));
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Maps of noise: every lookup of a pixel is that of the reference.
TEST(Visibility, PixelsLookAtTheTexelsOfTheReference) {
    PassRig rig;
    constexpr uint32_t kSide = 64;
    Noise noise(5);
    const gpu_scene::View view = gpu_scene::View::symmetric({83, 61}, 0.7f, glm::mat4(1));
    Surfaces s{view.extent, {}, {}, {}};
    for (uint32_t i = 0; i < view.extent.width * view.extent.height; ++i) {  // a road and a wall, and bumps on them
        const glm::dvec2 ray =
            glm::dvec2(view.ray_scale()) * (glm::dvec2(s.pixel(i)) + 0.5) + glm::dvec2(view.ray_offset());
        const double road = ray.y < 0 ? 1.2 / -ray.y : 1e6, depth = std::min(road, 12.0);
        const glm::dvec3 normal =
            glm::normalize((road < 12 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1)) + 0.2 * noise.facing(0.1));
        s.reflectance.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(normal)), float(depth), 1.0f);
        s.emission.emplace_back(0);
    }
    for (const auto& [zoom, hemispheres, flat] : {std::tuple{1.0, 2u, false}, {1.7, 1u, false}, {0.6, 1u, true}}) {
        SCOPED_TRACE("zoom " + std::to_string(zoom));
        gpu_scene::LampList list;
        shared::Lamp lamp{};
        lamp.position = {0.7f, 1.5f, -5}, lamp.intensity = 1000, lamp.axis = {0, -1, 0}, lamp.lobe_b = 1,
        lamp.colour = glm::vec3(1);
        list.lamps = {lamp}, list.indices = {0}, list.counts = {1, 0, 0, 0};
        const render::MapFrame turned =
            render::map_frame(glm::mat4_cast(glm::angleAxis(-1.2, glm::normalize(glm::dvec3(1, 0.2, 0.4)))));
        std::vector<uint16_t> texels;
        reference::HemisphereMap maps[2]{{kSide, {}}, {kSide, {}}};
        for (uint32_t k = 0; k < hemispheres * kSide * kSide; ++k) {
            const float value = k % 97 == 0 ? std::numeric_limits<float>::infinity() : 1 + 12 * noise.fine();
            texels.push_back(glm::packHalf1x16(value));
            maps[k / (kSide * kSide)].norms.push_back(double(glm::unpackHalf1x16(texels.back())));
        }
        graph::FrameGraph graph;
        const render::FrameContext frame = rig.frame(graph, view);
        const render::GBuffer g = upload(graph, s);
        const std::vector map{render::shadow_map({.side = kSide,
                                                  .hemispheres = hemispheres,
                                                  .zoom = float(zoom),
                                                  .flat = flat,
                                                  .range = 1,
                                                  .radius = 0,
                                                  .first = 0},
                                                 turned, view)};
        const render::FrameShadowMaps seen{graph.upload("maps", map, VK_FORMAT_R32G32B32A32_SFLOAT),
                                           graph.upload("distances", texels, VK_FORMAT_R16_SFLOAT)};
        const LitBlocks shaded = light(frame, g, list, no_tables(graph), {}, {.all_lamps = true, .maps = seen});
        const graph::Resource picture = keep<glm::vec4>(graph, shaded.scene);
        rig.run(graph);
        const std::vector<glm::vec4> pixels = rig.got<glm::vec4>(picture);
        graph::FrameGraph without;
        const graph::Resource unshadowed = keep<glm::vec4>(
            without,
            light(rig.frame(without, view), upload(without, s), list, no_tables(without), {}, {.all_lamps = true})
                .scene);
        rig.run(without);
        const std::vector<glm::vec4> whole = rig.got<glm::vec4>(unshadowed);
        size_t dark = 0, lit = 0, between = 0;
        for (size_t i = 0; i < pixels.size(); ++i) {
            const glm::dvec3 point = reference::view_position(shaded.clusters.push.grid, glm::dvec2(s.pixel(i)) + 0.5,
                                                              double(s.surface[i].z));
            const glm::dvec3 normal = reference::octahedral_decode(glm::dvec2(s.surface[i]));
            if (glm::dot(normal, glm::dvec3(lamp.position) - point) < 0.01) continue;
            const double away = glm::dot(normal, point);
            if (std::abs(away) < 0.03 * -point.z) continue;  // seen from its edge
            const auto step = [&](glm::dvec2 pixel) {        // along the surface, m
                constexpr double kPart = 1e-5;
                const glm::dvec3 ray = point / -point.z + kPart * glm::dvec3(glm::dvec2(view.ray_scale()) * pixel, 0);
                return (ray * (away / glm::dot(normal, ray)) - point) / kPart;
            };
            glm::dvec3 in_map = turned.rotation * (point - glm::dvec3(lamp.position)),
                       facing = turned.rotation * normal;
            const bool second = in_map.z < 0;
            glm::dvec3 right = turned.rotation * step({1, 0}), down = turned.rotation * step({0, 1});
            if (second && hemispheres == 2) in_map.z *= -1, facing.z *= -1, right.z *= -1, down.z *= -1;
            const reference::MapLookup found =
                reference::lookup(maps[second && hemispheres == 2 ? 1 : 0], zoom, in_map, facing, flat, right, down);
            if (!found.certain) continue;
            (found.share == 1 ? lit : found.share == 0 ? dark : between) += 1;
            EXPECT_NEAR(double(pixels[i].x / whole[i].x), found.share, 1.0 / 30 + 0.01)
                << i % view.extent.width << " " << i / view.extent.width;
        }
        EXPECT_GT(dark, 30u);
        EXPECT_GT(lit, 300u);
        EXPECT_GT(between, 300u);

        // Block by block it is the same; but a lamp that gives little counts with a mean.
        const auto by_blocks = [&](float faint, shared::VisibilityReport& pairs, float radius = 0) {
            graph::FrameGraph again;
            std::vector<shared::ShadowMap> wide = map;
            wide[0].radius = radius;
            const render::FrameShadowMaps same{again.upload("maps", wide, VK_FORMAT_R32G32B32A32_SFLOAT),
                                               again.upload("distances", texels, VK_FORMAT_R16_SFLOAT)};
            const LitBlocks lit_blocks = light(rig.frame(again, view), upload(again, s), list, no_tables(again), {},
                                               {.merge_error = 0, .maps = same, .shadow_error = faint});
            const graph::Resource seen_picture = keep<glm::vec4>(again, lit_blocks.scene),
                                  report = keep<shared::VisibilityReport>(again, lit_blocks.blocks.visibility);
            rig.run(again);
            pairs = rig.got<shared::VisibilityReport>(report).at(0);
            return rig.got<glm::vec4>(seen_picture);
        };
        shared::VisibilityReport pairs{};
        const std::vector<glm::vec4> exact = by_blocks(0, pairs);
        size_t other = 0;
        for (size_t i = 0; i < pixels.size(); ++i)
            other += std::abs(exact[i].x - pixels[i].x) > 0.2f * whole[i].x ? 1 : 0;
        EXPECT_LE(other, pixels.size() / 200) << "blocks whose probes agree and other pixels do not";
        EXPECT_GT(pairs.mixed, 30u);
        EXPECT_EQ(pairs.faint, 0u);
        // The middle of a column says how wide its edges are: where it is not finite, other pixels stay as they are.
        const Surfaces finite = s;
        const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
        for (uint32_t y = 4; y < view.extent.height; y += 8)
            for (uint32_t x = y % 3; x < view.extent.width; x += 3)
                s.surface[size_t(y) * view.extent.width + x].z = x % 2 ? nan : inf;
        const std::vector<glm::vec4> broken = by_blocks(0, pairs);
        size_t changed = 0;
        for (size_t i = 0; i < pixels.size(); ++i) {
            const bool drawn = std::isfinite(s.surface[i].z);
            changed += drawn && std::abs(broken[i].x - exact[i].x) > 0.5f * whole[i].x ? 1 : 0;
            if (drawn) {
                ASSERT_TRUE(broken[i].x >= 0 && broken[i].x <= 1.001f * whole[i].x) << i;
            }
        }
        EXPECT_LE(changed, pixels.size() / 100) << "blocks whose probes are others";
        s = finite;
        const std::vector<glm::vec4> mean = by_blocks(100, pairs);
        EXPECT_LT(pairs.mixed, 30u) << "blocks of which no probe sees anything";
        EXPECT_GT(pairs.faint, 20u);
        double sum = 0, truth = 0;
        for (size_t i = 0; i < pixels.size(); ++i) sum += double(mean[i].x), truth += double(exact[i].x);
        // Probes take one texel, pixels what most of four say: in noise that is more often the likelier answer.
        EXPECT_NEAR(sum, truth, 0.1 * truth);
        // With a size every pixel gets a part of what it would get of the whole lamp, whatever the maps hold.
        const std::vector<glm::vec4> soft = by_blocks(0, pairs, 0.4f);
        size_t parts = 0;
        for (size_t i = 0; i < pixels.size(); ++i) {
            ASSERT_TRUE(soft[i].x >= 0 && soft[i].x < 1e6f) << i;
            EXPECT_LE(soft[i].x, whole[i].x * 1.001f) << i;
            parts += soft[i].x < 0.99f * whole[i].x ? 1 : 0;
        }
        EXPECT_GT(parts, 300u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A lamp that gives little counts with the share of a block that sees it, whether it is merged with others or not.
TEST(Visibility, MergedLampsKeepTheShareThatIsSeen) {
    PassRig rig;
    constexpr uint32_t kSide = 64;
    Noise noise(9);
    const gpu_scene::View view = gpu_scene::View::symmetric({83, 61}, 0.7f, glm::mat4(1));
    Surfaces s{view.extent, {}, {}, {}};
    for (uint32_t i = 0; i < view.extent.width * view.extent.height; ++i) {  // a wall
        s.reflectance.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode({0, 0, 1})), 12.0f, 1.0f);
        s.emission.emplace_back(0);
    }
    gpu_scene::LampList list;
    shared::Lamp lamp{};
    lamp.position = {0.7f, 1.5f, -2}, lamp.intensity = 1000, lamp.axis = {0, 0, -1}, lamp.lobe_b = 1;
    lamp.colour = {1, 0.7f, 0.4f};
    list.lamps = {lamp}, list.indices = {0}, list.counts = {1, 0, 0, 0};
    std::vector<uint16_t> texels;
    for (uint32_t k = 0; k < 2 * kSide * kSide; ++k) texels.push_back(glm::packHalf1x16(4 + 12 * noise.fine()));
    const std::vector map{render::shadow_map(
        {.side = kSide, .hemispheres = 2, .zoom = 1, .flat = false, .range = 1, .radius = 0, .first = 0},
        render::map_frame(glm::mat4(1)), view)};
    const auto picture = [&](float merge_error) {
        graph::FrameGraph graph;
        const render::FrameShadowMaps maps{graph.upload("maps", map, VK_FORMAT_R32G32B32A32_SFLOAT),
                                           graph.upload("distances", texels, VK_FORMAT_R16_SFLOAT)};
        const LitBlocks lit = light(rig.frame(graph, view), upload(graph, s), list, no_tables(graph), {},
                                    {.merge_error = merge_error, .maps = maps, .shadow_error = 100});
        const graph::Resource scene = keep<glm::vec4>(graph, lit.scene),
                              report = keep<shared::VisibilityReport>(graph, lit.blocks.visibility);
        rig.run(graph);
        EXPECT_GT(rig.got<shared::VisibilityReport>(report).at(0).faint, 20u);
        return rig.got<glm::vec4>(scene);
    };
    const std::vector<glm::vec4> alone = picture(0), merged = picture(0.05f);
    size_t differ = 0;
    for (size_t i = 0; i < alone.size(); ++i) {
        differ += alone[i] == merged[i] ? 0 : 1;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(merged[i][c], alone[i][c], 0.01f * alone[i][c] + 1e-6f) << i;
    }
    EXPECT_GT(differ, alone.size() / 4) << "merged lamps are interpolated";
}

const VkExtent2D kBoards{83, 61};
constexpr float kFarLamp = 1000;  // m, of two lamps at one place: so far that each gives all pixels the same light

/// Two lamps; the fainter gives a tenth of the light and is hidden from a few pixels of most blocks, before boards
/// that stand out of a wall: no block is a plane.
class Boards {
public:
    explicit Boards(PassRig& rig) : rig_(rig) {
        for (uint32_t i = 0; i < kBoards.width * kBoards.height; ++i) {
            const bool out = (s_.pixel(i).x / 3) % 2 == 1;
            s_.reflectance.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
            s_.surface.emplace_back(glm::vec2(reference::octahedral_encode({0, 0, 1})), out ? 11.9f : 12.0f, 1.0f);
            s_.emission.emplace_back(0);
        }
        shared::Lamp lamp{};
        lamp.position = {0, 0, kFarLamp - 12}, lamp.axis = {0, 0, -1}, lamp.lobe_b = 1, lamp.colour = glm::vec3(1);
        lamp.intensity = 9e8f;
        list_.lamps = {lamp, lamp}, list_.lamps[1].intensity = 1e8f;
        list_.indices = {0, 1}, list_.counts = {2, 0, 0, 0};
        Noise noise(11);
        for (uint32_t k = 0; k < kSide * kSide; ++k)
            texels_.push_back(glm::packHalf1x16(noise.unit() < 0.02f ? 0.5f * kFarLamp : shared::kMapFar));
    }

    std::vector<glm::vec4> picture(float probe_error, bool shadows = true) {
        const gpu_scene::View view = gpu_scene::View::symmetric(kBoards, 0.7f, glm::mat4(1));
        const render::MapFrame ahead = render::map_frame(glm::mat4(1));
        const double forward = (ahead.rotation * glm::dvec3(0, 0, -1)).z;
        EXPECT_NEAR(forward, 1, 1e-9);
        const std::vector maps{
            render::shadow_map(
                {.side = 0, .hemispheres = 1, .zoom = kZoom, .flat = false, .range = 1, .radius = 0, .first = 0}, ahead,
                view),
            render::shadow_map(
                {.side = kSide, .hemispheres = 1, .zoom = kZoom, .flat = false, .range = 1, .radius = 0, .first = 0},
                ahead, view)};
        graph::FrameGraph graph;
        render::FrameShadowMaps seen;
        if (shadows)
            seen = {graph.upload("maps", maps, VK_FORMAT_R32G32B32A32_SFLOAT),
                    graph.upload("distances", texels_, VK_FORMAT_R16_SFLOAT)};
        const LitBlocks lit =
            light(rig_.frame(graph, view), upload(graph, s_), list_, no_tables(graph), {},
                  {.merge_error = 0, .maps = seen, .shadow_error = 0.001f, .probe_error = probe_error});
        const graph::Resource scene = keep<glm::vec4>(graph, lit.scene);
        rig_.run(graph);
        return rig_.got<glm::vec4>(scene);
    }

private:
    static constexpr uint32_t kSide = 256;
    static constexpr float kZoom = 90;  // the map is as wide as the wall

    PassRig& rig_;
    Surfaces s_{kBoards, {}, {}, {}};
    gpu_scene::LampList list_;
    std::vector<uint16_t> texels_;
};

// Shares of 0.098 and 0.102 are on either side of the lamp's.
TEST(Visibility, FaintLampsAreSeenAsTheProbesSeeThem) {
    PassRig rig;
    Boards boards(rig);
    const std::vector<glm::vec4> all = boards.picture(0, false), exact = boards.picture(0),
                                 below = boards.picture(0.098f), above = boards.picture(0.102f);
    EXPECT_EQ(exact, below) << "the lamp gives more";
    size_t same = 0, evened = 0, other = 0;
    for (uint32_t y = 0; y + 8 <= kBoards.height; y += 8)
        for (uint32_t x = 0; x + 8 <= kBoards.width; x += 8) {
            size_t hidden = 0, differ = 0, dark = 0;  // pixels
            for (uint32_t k = 0; k < 64; ++k) {
                const size_t i = size_t(y + k / 8) * kBoards.width + x + k % 8;
                hidden += exact[i].g < 0.95f * all[i].g ? 1 : 0;
                dark += above[i].g < 0.95f * all[i].g ? 1 : 0;
                differ += above[i] == exact[i] ? 0 : 1;
            }
            if (hidden == 0) continue;
            same += differ == 0 ? 1 : 0, evened += differ > 0 && dark == 0 ? 1 : 0;
            other += differ > 0 && dark > 0 ? 1 : 0;
        }
    EXPECT_GT(evened, 10u) << "all of the block sees the lamp, as its probes do";
    EXPECT_GT(same, 10u) << "a probe does not see it, and all pixels look";
    EXPECT_EQ(other, 0u);
    EXPECT_EQ(rig.complaints(), "");
}

// The view of a part of a picture, in pixels from its top left corner.
gpu_scene::View part_of(gpu_scene::View view, glm::dvec2 corner, VkExtent2D extent) {
    const glm::vec2 size(float(view.extent.width), float(view.extent.height));
    const glm::vec2 per_pixel = (view.tangent_high - view.tangent_low) / size;
    view.tangent_low.x += per_pixel.x * float(corner.x);
    view.tangent_high.y -= per_pixel.y * float(corner.y);
    view.tangent_high.x = view.tangent_low.x + per_pixel.x * float(extent.width);
    view.tangent_low.y = view.tangent_high.y - per_pixel.y * float(extent.height);
    view.extent = extent;
    return view;
}

// Of matt pixels: luminance for a reflectance of 1, cd/m^2, added up.
struct StreetLight {
    double got = 0, truth = 0, leaked = 0, lost = 0;
    size_t pixels = 0, within = 0;  // with 1.3 lx and more; within 5 % of the truth
};

void compare_with_rays(Lit& street, const RayCaster& rays, const gpu_scene::View& view, StreetLight& light) {
    const Lit::Picture p = street.render(view);
    const glm::dmat4 to_world = glm::inverse(view.world_to_view);
    for (size_t i = 0; i < p.pixels.size(); ++i) {
        const glm::vec4 surface = p.surfaces[i], colour = p.colours[i];
        if (!(surface.z > 0) || surface.w < 1 || colour.w != 0) continue;  // matt alone
        const glm::dvec3 point = reference::view_position(
            p.grid, glm::dvec2(i % view.extent.width, i / view.extent.width) + 0.5, double(surface.z));
        const glm::dvec3 normal = reference::octahedral_decode(glm::dvec2(surface));
        // Four places of the pixel, on the plane of its surface.
        std::array<glm::dvec3, 4> places;
        for (size_t k = 0; k < places.size(); ++k) {
            const glm::dvec2 aside(k % 2 ? 0.25 : -0.25, k / 2 ? 0.25 : -0.25);
            const glm::dvec3 ray = point / -point.z + glm::dvec3(glm::dvec2(view.ray_scale()) * aside, 0);
            const double share = glm::dot(normal, point) / glm::dot(normal, ray) / -point.z;
            const glm::dvec3 place = share > 0.5 && share < 2 ? ray * (share * -point.z) : point;
            places[k] = glm::dvec3(to_world * glm::dvec4(place + 2e-3 * normal, 1));
        }
        double expected = 0;  // lx, times reflectance over pi
        for (uint32_t l = 0; l < p.list.placed(); ++l) {
            reference::Shaded sum;
            reference::add_lamp(p.list.lamps[l], reference::kind_of(l, p.list.counts), point, normal,
                                glm::dvec3(colour) / kPi, {}, 1, 0.001, sum);
            if (!(sum.luminance.y > 0)) continue;
            const std::vector<uint32_t>& fixture = street.plan.fixtures[p.list.indices[l]];
            const glm::dvec3 lamp(street.poses.world[street.lamps[p.list.indices[l]].node][3]);
            for (const glm::dvec3 place : places) {
                const double hit = rays.hit(lamp, place, 0, 1, [&](uint32_t node) {
                    return std::ranges::none_of(
                        fixture, [&](uint32_t f) { return street.resident.placements()[f].node == node; });
                });
                if (!(hit < 1)) expected += 0.25 * sum.luminance.y;
            }
        }
        const double got = double(p.pixels[i].y);
        light.got += got, light.truth += expected;
        light.leaked += std::max(got - expected, 0.0), light.lost += std::max(expected - got, 0.0);
        if (std::max(got, expected) < 1.3 * double(colour.y) / kPi) continue;
        ++light.pixels;
        light.within += std::abs(got - expected) <= 0.05 * expected ? 1 : 0;
    }
}

// The light of all lamps on matt pixels of the night street, with rays deciding which of them each pixel sees.
TEST(Visibility, NightStreetAgreesWithRays) {
    TempFolder folder;
    const std::filesystem::path data = std::filesystem::path(VESPER_SOURCE_DIR) / "data/rivoli";
    scene::convert(data / "rivoli.gltf", data / "rivoli.photometry.json", folder / "night.gltf");
    const scene::Scene scene = scene::read_scene(folder / "night.gltf").scene;
    PassRig rig;
    Lit street(rig, scene);
    const RayCaster rays(scene, street.poses.world);
    ASSERT_EQ(rays.size(), street.resident.triangles());

    for (const char* camera : {"driver", "crossing"}) {
        StreetLight light;
        const gpu_scene::View whole = gpu_scene::camera_view(scene, street.poses, camera, {1680, 1050});
        for (const double x : {0.1, 0.45, 0.8})
            for (const double y : {0.35, 0.55, 0.75})
                compare_with_rays(street, rays, part_of(whole, {1680 * x, 1050 * y}, {32, 24}), light);
        // Without maps the light is 1.4 to 1.9 times as much. What differs are edges of shadows, by less than a texel:
        // of their pixels the rays know quarters.
        EXPECT_NEAR(light.got, light.truth, 0.01 * light.truth) << camera;
        EXPECT_LT(light.leaked, 0.0075 * light.truth) << camera;
        EXPECT_LT(light.lost, 0.008 * light.truth) << camera;
        EXPECT_GT(double(light.within), 0.90 * double(light.pixels)) << camera;
        EXPECT_GT(light.pixels, 2000u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::visibility_test
