// Distance maps on the device: against rays through the middle of each texel. SPDX-License-Identifier: MIT
#include "passes/distance_map_reference.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>

#include "render/passes/distance_map.h"
#include "support/map_texels.h"
#include "support/occluders.h"
#include "support/ray_caster.h"
#include "support/snapping.h"
#include "support/texels.h"

namespace vesper::test::distance_map_test {
namespace {

// `maps` with all placements.
std::vector<float> draw(PassRig& rig, const scene::Scene& scene, std::span<const render::MapToDraw> given,
                        uint32_t texels) {
    const gpu_scene::GpuScene resident(rig.device(), scene);
    std::vector<render::MapToDraw> maps(given.begin(), given.end());
    std::vector<uint32_t> all(resident.placements().size());
    std::iota(all.begin(), all.end(), 0u);
    for (render::MapToDraw& map : maps) map.placements = all;
    return drawn_texels(rig, texels, [&](const render::FrameContext& frame, graph::Resource words) {
        render::MapScratch scratch = render::add_map_scratch(frame, resident);
        render::add_distance_maps(frame, resident, {scene::world_transforms(scene, 0), {}, {}, {}, {}}, maps, words,
                                  scratch);
    });
}

OccluderScene room() {
    OccluderScene s;
    s.plate({0, -4, 0}, {30, 0, 0}, {0, 0, 30});
    s.box({3, -3, -2}, {0.9f, 1, 2});
    s.box({-4, -2, 1}, {0.2f, 2, 0.2f});
    s.box({0.5f, 2, 0.3f}, {0.6f, 0.1f, 0.6f});
    s.plate({-8, 0, 0}, {0, 6, 0}, {0, 0.5f, 9});
    for (int i = 0; i < 150; ++i) {  // of a few texels, on all sides and so across the border of every map
        const double up = (i + 0.5) / 75 - 1, turn = 2.4 * i, out = 6 * std::sqrt(1 - up * up);
        s.box({float(out * std::cos(turn)), float(6 * up), float(out * std::sin(turn))}, glm::vec3(0.25f));
    }
    return s;
}

// Texels agree with rays but for those where a ray a hair beside meets something else. `coarse`: see snaps_coarsely();
// no texel may be left out there either.
void expect_rays(const RayCaster& rays, const render::MapToDraw& map, bool second, const float* texels, double snap,
                 bool coarse) {
    const gpu_scene::MapLayout& layout = map.layout;
    const gpu_scene::MapFrame& frame = map.frame;
    const std::span<const uint32_t> fixture = map.fixture;
    const auto norm_at = [&](glm::dvec2 texel) {
        glm::dvec3 o = reference::map_direction(texel, layout.side, double(layout.zoom), layout.flat);
        o.z = second ? -o.z : o.z;
        const glm::dvec3 way = glm::transpose(frame.rotation) * o;
        return rays.hit(frame.position, frame.position + way, double(shared::kMapNear), 1e9, [&](uint32_t node) {
            return std::find(fixture.begin(), fixture.end(), node) == fixture.end();
        });
    };
    size_t compared = 0, covered = 0;
    for (uint32_t y = 0; y < layout.side; ++y)
        for (uint32_t x = 0; x < layout.side; ++x) {
            const glm::dvec2 middle(x + 0.5, y + 0.5);
            const double norm = norm_at(middle);
            bool certain = true;
            double steep = 0;  // how much the surface changes
            for (const glm::dvec2 aside : {glm::dvec2(snap, 0), {-snap, 0}, {0, snap}, {0, -snap}}) {
                const double other = norm_at(middle + aside);
                certain = certain && (std::isinf(norm) ? std::isinf(other) : std::abs(other - norm) < 2 * snap * norm);
                steep = std::max(steep, std::abs(other - norm));
            }
            if (!certain) continue;
            ++compared;
            const double got = double(texels[size_t(y) * layout.side + x]);
            // A half has 11 bits; snapping of vertices moves steep surfaces.
            if (std::isinf(norm) || norm > 5e4) {
                EXPECT_TRUE(got >= 5e4 || coarse) << x << " " << y;
                covered += got >= 5e4 ? 0 : 1;
            } else {
                // All corners of a surface are moved on a coarse grid, and those that clipping makes once more.
                EXPECT_NEAR(got, norm, coarse ? 0.02 * norm + 4 * steep : 2e-3 * norm + steep)
                    << x << " " << y << (second ? " second" : "");
            }
        }
    EXPECT_LE(covered, 3u);
    EXPECT_GT(compared, size_t(layout.side) * layout.side * 9 / 10);
}

TEST(DistanceMap, HoldsTheFirstSurfaceAlongEachRay) {
    PassRig rig;
    OccluderScene s = room();
    const RayCaster rays(s.scene(), scene::world_transforms(s.scene(), 0));
    const glm::dmat4 tilted = glm::translate(glm::dmat4(1), glm::dvec3(0.2, 1, -0.3)) *
                              glm::mat4_cast(glm::angleAxis(-1.4, glm::normalize(glm::dvec3(1, 0.1, 0.2))));
    const uint32_t own[] = {3};  // the box above is its fixture
    // Two hemispheres, two beams, the second on a flat map, and a lamp with a fixture, in one image.
    render::MapToDraw maps[] = {
        {{.side = 64, .hemispheres = 2, .zoom = 1, .range = 100, .radius = 0, .first = 0},
         gpu_scene::map_frame(tilted),
         {},
         {}},
        {{.side = 128, .hemispheres = 1, .zoom = 3, .range = 100, .radius = 0, .first = 8192},
         gpu_scene::map_frame(tilted),
         {},
         {}},
        {{.side = 128, .hemispheres = 1, .zoom = 1.2f, .flat = true, .range = 100, .radius = 0, .first = 32768},
         gpu_scene::map_frame(tilted),
         {},
         {}},
        {{.side = 64, .hemispheres = 2, .zoom = 1, .range = 100, .radius = 0, .first = 8192 + 16384},
         gpu_scene::map_frame(glm::translate(glm::dmat4(1), glm::dvec3(0.5, 1.9, 0.3))),
         own,
         {}}};
    for (uint32_t i = 0; i < 4; ++i) maps[i].lamp = i;
    const std::vector<float> drawn = draw(rig, s.scene(), maps, 32768 + 16384);
    for (const render::MapToDraw& map : maps)
        for (uint32_t h = 0; h < map.layout.hemispheres; ++h) {
            const uint32_t side = map.layout.side, first = map.layout.first + h * side * side;
            SCOPED_TRACE("map from " + std::to_string(first));
            expect_rays(rays, map, h == 1, &drawn[first], std::max(2.5 * snapped(rig.device()), 0.01),
                        snaps_coarsely(rig.device()));
        }
    EXPECT_EQ(rig.complaints(), "");
}

// 40 maps, of which some have the same place in an image.
TEST(DistanceMap, ManyMapsTakeSeveralImages) {
    PassRig rig;
    OccluderScene s;
    s.box({0, 0, 0}, glm::vec3(10));  // all around, at 10 m along the axes
    std::vector<render::MapToDraw> maps;
    uint32_t first = 0;
    for (uint32_t i = 0; i < 40; ++i) {
        const uint32_t side = i % 3 == 0 ? 512u : 64u << i % 3u;
        maps.push_back({{.side = side, .hemispheres = 1, .zoom = 1, .range = 100, .radius = 0, .first = first},
                        gpu_scene::map_frame(glm::dmat4(1)),
                        {},
                        {}});
        maps.back().lamp = i / 2;
        first += side * side;
    }
    const std::vector<float> drawn = draw(rig, s.scene(), maps, first);
    for (const render::MapToDraw& map : maps) {
        const uint32_t side = map.layout.side;
        EXPECT_NEAR(drawn[map.layout.first + side / 2 * side + side / 2], 10,
                    12.0 / side);                     // half a texel off the axis
        for (uint32_t i = 0; i < side * side; ++i) {  // a box has no holes
            ASSERT_GE(drawn[map.layout.first + i], 9.9f) << i << " of " << side;
            ASSERT_LE(drawn[map.layout.first + i], 30.1f) << i << " of " << side;
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// So a frame does not depend on what the frames before it drew.
TEST(DistanceMap, TexelsDoNotDependOnWhatElseIsDrawn) {
    PassRig rig;
    OccluderScene s = room();
    std::vector<render::MapToDraw> maps;
    uint32_t first = 0;
    for (uint32_t i = 0; i < 12; ++i) {
        const glm::quat turned = glm::angleAxis(0.7f * float(i), glm::normalize(glm::vec3(1, 0.3f * float(i), -0.5f)));
        const uint32_t side = 64u << i % 3u;
        maps.push_back({{.side = side, .hemispheres = 2, .zoom = 1, .range = 100, .radius = 0, .first = first},
                        gpu_scene::map_frame(glm::mat4_cast(glm::dquat(turned))),
                        {},
                        {}});
        maps.back().lamp = i;
        first += 2 * side * side;
    }
    const std::vector<float> together = draw(rig, s.scene(), maps, first);
    for (const render::MapToDraw& map : maps) {
        const std::vector<float> alone = draw(rig, s.scene(), {&map, 1}, first);
        size_t differ = 0;
        for (size_t i = map.layout.first; i < map.layout.first + map.layout.texels(); ++i)
            differ += alone[i] != together[i] ? 1 : 0;
        EXPECT_EQ(differ, 0u) << "lamp " << map.lamp;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// The opacity of a mask's texture decides texel by texel.
TEST(DistanceMap, MasksLetLightThrough) {
    PassRig rig;
    OccluderScene s;
    s.plate({0, 0, -2}, {2, 0, 0}, {0, 2, 0});
    s.scene().images = {{"half", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}}};
    scene::Material& m = s.scene().materials[0];
    m.alpha = scene::Material::Alpha::Mask;
    m.base_colour_texture = {.image = 0, .wrap_u = scene::Wrap::Clamp, .wrap_v = scene::Wrap::Clamp, .nearest = true};
    const render::MapToDraw map{{.side = 64, .hemispheres = 1, .zoom = 1, .range = 100, .radius = 0, .first = 0},
                                gpu_scene::map_frame(glm::dmat4(1)),
                                {},
                                {}};
    const std::vector<float> drawn = draw(rig, s.scene(), {&map, 1}, 4096);
    const auto at = [&](glm::dvec3 p) {
        const glm::ivec2 t(reference::map_texel(map.frame.rotation * p, 64, 1));
        return drawn[size_t(t.y) * 64 + size_t(t.x)];
    };
    EXPECT_NEAR(at({-0.5, 0.3, -2}), 2.8, 0.1);
    EXPECT_GT(at({0.5, 0.3, -2}), 5e4f);
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::distance_map_test
