// Shadow maps on the device: against rays through the middle of each texel. SPDX-License-Identifier: MIT
#include "passes/shadows/draw_shadow_maps_reference.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>

#include "render/shadows/draw_shadow_maps.h"
#include "support/map_texels.h"
#include "support/occluders.h"
#include "support/ray_caster.h"
#include "support/snapping.h"
#include "support/texels.h"

namespace vesper::test::draw_shadow_maps_test {
namespace {

// `maps` with all placements or groups, at rest but for nodes that `world` puts elsewhere.
std::vector<float> draw(PassRig& rig, const scene::Scene& scene, std::span<const render::ShadowMapToDraw> given,
                        uint32_t texels, const std::vector<glm::dmat4>& world) {
    const gpu_scene::GpuScene resident(rig.device(), scene);
    std::vector<render::ShadowMapToDraw> maps(given.begin(), given.end());
    std::vector<uint32_t> all(resident.placements().size());
    std::iota(all.begin(), all.end(), 0u);
    for (render::ShadowMapToDraw& map : maps)
        if (map.caster_error == 0) map.placements = all;
    return drawn_texels(rig, texels, [&](const render::FrameContext& frame, graph::Resource words) {
        const render::ShadowMapScratch scratch = render::add_shadow_map_scratch(frame, resident);
        const gpu_scene::SceneFrame poses{world, {}, {}, {}, {}};
        const render::CasterGroups groups(resident, all, poses);
        render::add_shadow_maps(frame, resident, poses, &groups, maps, words, scratch);
    });
}
std::vector<float> draw(PassRig& rig, const scene::Scene& scene, std::span<const render::ShadowMapToDraw> given,
                        uint32_t texels) {
    return draw(rig, scene, given, texels, scene::world_transforms(scene, 0));
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

// Texels agree with rays but for those where a ray a hair beside meets something else, and for `few`. `coarse`: see
// snaps_coarsely(); no texel may be left out there either.
void expect_rays(const RayCaster& rays, const render::ShadowMapToDraw& map, bool second, const float* texels,
                 double snap, bool coarse, size_t few = 0) {
    const render::ShadowMapLayout& layout = map.layout;
    const render::MapFrame& frame = map.frame;
    const std::span<const uint32_t> fixture = map.fixture;
    const auto norm_at = [&](glm::dvec2 texel) {
        glm::dvec3 o = reference::map_direction(texel, layout.side, double(layout.zoom), layout.flat);
        o.z = second ? -o.z : o.z;
        const glm::dvec3 way = glm::transpose(frame.rotation) * o;
        return rays.hit(frame.position, frame.position + way, double(shared::kMapNear), 1e9, [&](uint32_t node) {
            return std::find(fixture.begin(), fixture.end(), node) == fixture.end();
        });
    };
    size_t compared = 0, covered = 0, astray = 0;
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
                continue;
            }
            // All corners of a surface are moved on a coarse grid, and those that clipping makes once more.
            const double allowed = coarse ? 0.02 * norm + 4 * steep : 2e-3 * norm + steep;
            if (!(std::abs(got - norm) <= allowed) && astray++ >= few)
                ADD_FAILURE() << x << " " << y << (second ? " second: " : ": ") << got << ", want " << norm << " +- "
                              << allowed;
        }
    EXPECT_LE(covered, 3u);
    EXPECT_GT(compared, size_t(layout.side) * layout.side * 9 / 10);
}

TEST(ShadowMap, HoldsTheFirstSurfaceAlongEachRay) {
    PassRig rig;
    OccluderScene s = room();
    const RayCaster rays(s.scene(), scene::world_transforms(s.scene(), 0));
    const glm::dmat4 tilted = glm::translate(glm::dmat4(1), glm::dvec3(0.2, 1, -0.3)) *
                              glm::mat4_cast(glm::angleAxis(-1.4, glm::normalize(glm::dvec3(1, 0.1, 0.2))));
    const uint32_t own[] = {3};  // the box above is its fixture
    // Two hemispheres, two beams, the second on a flat map, and a lamp with a fixture, drawn together.
    render::ShadowMapToDraw maps[] = {
        {{.side = 64, .hemispheres = 2, .zoom = 1, .range = 100, .radius = 0, .first = 0},
         render::map_frame(tilted),
         {},
         {}},
        {{.side = 128, .hemispheres = 1, .zoom = 3, .range = 100, .radius = 0, .first = 8192},
         render::map_frame(tilted),
         {},
         {}},
        {{.side = 128, .hemispheres = 1, .zoom = 1.2f, .flat = true, .range = 100, .radius = 0, .first = 32768},
         render::map_frame(tilted),
         {},
         {}},
        {{.side = 64, .hemispheres = 2, .zoom = 1, .range = 100, .radius = 0, .first = 8192 + 16384},
         render::map_frame(glm::translate(glm::dmat4(1), glm::dvec3(0.5, 1.9, 0.3))),
         own,
         {}}};
    const std::vector<float> drawn = draw(rig, s.scene(), maps, 32768 + 16384);
    for (const render::ShadowMapToDraw& map : maps)
        for (uint32_t h = 0; h < map.layout.hemispheres; ++h) {
            const uint32_t side = map.layout.side, first = map.layout.first + h * side * side;
            SCOPED_TRACE("map from " + std::to_string(first));
            expect_rays(rays, map, h == 1, &drawn[first], std::max(2.5 * snapped(rig.device()), 0.01),
                        snaps_coarsely(rig.device()));
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Boxes of 2 m, 30 to 60 m away, some of them in one cell; the lamp's own, and one that has moved, are drawn by parts.
// Of maps in which all groups of cells are, and of narrow ones.
TEST(ShadowMap, CellsHideWhatTheirPartsHide) {
    PassRig rig;
    OccluderScene s;
    for (int i = 0; i < 60; ++i) {
        const double turn = 2.4 * i, out = 30 + 0.5 * i;
        s.box({float(out * std::cos(turn)), float(i % 5 * 2 - 4), float(out * std::sin(turn))}, glm::vec3(1));
    }
    s.lamp({}, {});
    std::vector<glm::dmat4> world = scene::world_transforms(s.scene(), 0);
    const render::ShadowMapLayout layouts[]{
        {.side = 256, .hemispheres = 2, .zoom = 1, .range = 200, .radius = 0, .first = 0},
        {.side = 128, .hemispheres = 1, .zoom = 3, .range = 200, .radius = 0, .first = 131072},
        {.side = 128, .hemispheres = 1, .zoom = 1.2f, .flat = true, .range = 200, .radius = 0, .first = 147456}};
    const uint32_t own[] = {7};
    for (const bool moved : {false, true}) {
        SCOPED_TRACE(moved);
        if (moved) world[12] = glm::translate(world[12], glm::dvec3(0, 5, 0));
        const RayCaster rays(s.scene(), world);
        for (const double error : {0.0, 0.5}) {
            std::vector<render::ShadowMapToDraw> maps;
            for (const render::ShadowMapLayout& layout : layouts)
                maps.push_back({.layout = layout,
                                .frame = render::map_frame(glm::dmat4(1)),
                                .fixture = own,
                                .caster_error = error});
            const std::vector<float> drawn = draw(rig, s.scene(), maps, 163840, world);
            for (const render::ShadowMapToDraw& map : maps)
                for (uint32_t h = 0; h < map.layout.hemispheres; ++h)
                    expect_rays(rays, map, h == 1, &drawn[map.layout.first + h * map.layout.side * map.layout.side],
                                std::max(2.5 * snapped(rig.device()), 0.01), snaps_coarsely(rig.device()));
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A finely curved wall, 5 mm off a plane: as the plane from afar, as it is from near.
TEST(ShadowMap, FarCellsAreSimplifiedByLessThanTheErrorOfTheMap) {
    PassRig rig;
    OccluderScene s;
    for (int i = 0; i < 60; ++i)
        s.plate({-6 + 0.2f * float(i), 0, -41 - 0.005f * float(i % 2)}, {0.1f, 0, 0}, {0, 3, 0});
    s.lamp({}, {});
    const render::ShadowMapLayout layout{
        .side = 64, .hemispheres = 1, .zoom = 4, .range = 200, .radius = 0, .first = 0};
    const gpu_scene::GpuScene resident(rig.device(), s.scene());
    ASSERT_EQ(resident.cells().size(), 2u);  // on both sides of x = 0
    const RayCaster rays(s.scene(), scene::world_transforms(s.scene(), 0));
    for (const double z : {0.0, -30.0}) {
        const glm::dmat4 lamp = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, z));
        const render::ShadowMapToDraw map{.layout = layout, .frame = render::map_frame(lamp), .caster_error = 0.5};
        const std::vector<float> drawn = draw(rig, s.scene(), {&map, 1}, layout.texels());
        expect_rays(rays, map, false, drawn.data(), std::max(2.5 * snapped(rig.device()), 0.01),
                    snaps_coarsely(rig.device()));
    }
}

TEST(ShadowMap, ManyMapsAreDrawnAtOnce) {
    PassRig rig;
    OccluderScene s;
    s.box({0, 0, 0}, glm::vec3(10));  // all around, at 10 m along the axes
    std::vector<render::ShadowMapToDraw> maps;
    uint32_t first = 0;
    for (uint32_t i = 0; i < 40; ++i) {
        const uint32_t side = i % 3 == 0 ? 512u : 64u << i % 3u;
        maps.push_back({{.side = side, .hemispheres = 1, .zoom = 1, .range = 100, .radius = 0, .first = first},
                        render::map_frame(glm::dmat4(1)),
                        {},
                        {}});
        first += side * side;
    }
    const std::vector<float> drawn = draw(rig, s.scene(), maps, first);
    for (const render::ShadowMapToDraw& map : maps) {
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
TEST(ShadowMap, TexelsDoNotDependOnWhatElseIsDrawn) {
    PassRig rig;
    OccluderScene s = room();
    std::vector<render::ShadowMapToDraw> maps;
    uint32_t first = 0;
    for (uint32_t i = 0; i < 12; ++i) {
        const glm::quat turned = glm::angleAxis(0.7f * float(i), glm::normalize(glm::vec3(1, 0.3f * float(i), -0.5f)));
        const uint32_t side = 64u << i % 3u;
        maps.push_back({{.side = side, .hemispheres = 2, .zoom = 1, .range = 100, .radius = 0, .first = first},
                        render::map_frame(glm::mat4_cast(glm::dquat(turned))),
                        {},
                        {}});
        first += 2 * side * side;
    }
    const std::vector<float> together = draw(rig, s.scene(), maps, first);
    for (const render::ShadowMapToDraw& map : maps) {
        const std::vector<float> alone = draw(rig, s.scene(), {&map, 1}, first);
        size_t differ = 0;
        for (size_t i = map.layout.first; i < map.layout.first + map.layout.texels(); ++i)
            differ += alone[i] != together[i] ? 1 : 0;
        EXPECT_EQ(differ, 0u) << "map from " << map.layout.first;
    }
    EXPECT_EQ(rig.complaints(), "");
}

/// An empty list of the changed tiles of maps of so many texels.
graph::Resource no_changed_tiles(graph::FrameGraph& graph, uint32_t texels) {
    const uint32_t tiles = texels / shared::kTileTexels;
    const graph::Resource changed = graph.transient(
        "changed", graph::buffer_shape((shared::kChangedHead + tiles) * 4 + tiles * sizeof(shared::ChangedTile)));
    graph.clear("clear changed", changed);
    graph.copy("begin changed", graph.upload("head", std::vector<uint32_t>{0, 1, 1, tiles}), changed,
               {{0, 0, shared::kChangedHead * 4}});
    return changed;
}

// Half of a room is drawn over the other half: as if all were drawn at once, and it goes away again without a trace.
TEST(ShadowMap, WhatIsDrawnOverAMapIsTheNearerAndGoesAway) {
    PassRig rig;
    OccluderScene s = room();
    const gpu_scene::GpuScene resident(rig.device(), s.scene());
    const gpu_scene::SceneFrame poses{scene::world_transforms(s.scene(), 0), {}, {}, {}, {}};
    std::vector<uint32_t> all, even, odd;
    for (uint32_t p = 0; p < resident.placements().size(); ++p) all.push_back(p), (p % 2 ? odd : even).push_back(p);
    std::vector<render::ShadowMapToDraw> maps{
        {{.side = 128, .hemispheres = 2, .zoom = 1, .range = 100, .radius = 0, .first = 0},
         render::map_frame(glm::translate(glm::dmat4(1), glm::dvec3(0.2, 1, -0.3))),
         {},
         {}},
        {{.side = 64, .hemispheres = 1, .zoom = 1.2f, .flat = true, .range = 100, .radius = 0, .first = 32768},
         render::map_frame(glm::mat4_cast(glm::angleAxis(-1.4, glm::normalize(glm::dvec3(1, 0.1, 0.2))))),
         {},
         {}}};
    constexpr uint32_t kTexels = 32768 + 4096;
    const auto with = [&](const std::vector<uint32_t>& placements) {
        for (render::ShadowMapToDraw& map : maps) map.placements = placements;
        return std::span<const render::ShadowMapToDraw>(maps);
    };
    const auto drawn = [&](const std::vector<uint32_t>& first, const std::vector<uint32_t>& over, bool goes_away) {
        return drawn_texels(rig, kTexels, [&](const render::FrameContext& frame, graph::Resource words) {
            const render::ShadowMapScratch scratch =
                render::add_shadow_map_scratch(frame, resident, no_changed_tiles(frame.graph, kTexels));
            const graph::Resource still = frame.graph.transient("still", graph::buffer_shape(kTexels * 2));
            frame.graph.clear("clear still", still);
            render::add_shadow_maps(frame, resident, poses, nullptr, with(first), still, scratch);
            frame.graph.copy("copy still", still, words, {{0, 0, kTexels * 2}});
            render::add_over_shadow_maps(frame, resident, poses, with(over), words, scratch);
            if (goes_away) render::restore_shadow_maps(frame, still, words, scratch);
        });
    };
    const std::vector<float> together = drawn(all, {}, false), alone = drawn(even, {}, false);
    EXPECT_NE(together, alone);
    EXPECT_EQ(drawn(even, odd, false), together);
    EXPECT_EQ(drawn(even, odd, true), alone);
    EXPECT_EQ(rig.complaints(), "");
}

// The opacity of a mask's texture decides texel by texel.
TEST(ShadowMap, MasksLetLightThrough) {
    PassRig rig;
    OccluderScene s;
    s.plate({0, 0, -2}, {2, 0, 0}, {0, 2, 0});
    s.scene().images = {{"half", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}}};
    scene::Material& m = s.scene().materials[0];
    m.alpha = scene::Material::Alpha::Mask;
    m.base_colour_texture = {.image = 0, .wrap_u = scene::Wrap::Clamp, .wrap_v = scene::Wrap::Clamp, .nearest = true};
    const render::ShadowMapToDraw map{{.side = 64, .hemispheres = 1, .zoom = 1, .range = 100, .radius = 0, .first = 0},
                                      render::map_frame(glm::dmat4(1)),
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

/// A box of 10 m about the origin, of squares that are by turns 200 small triangles, their corners at random, and a fan
/// of 40 long ones that share the corners on its border.
scene::Scene patched_box() {
    constexpr int kCells = 8, kParts = 10;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> jitter(-0.3f, 0.3f);
    scene::Scene scene;
    scene.materials.emplace_back().double_sided = true;
    scene::Primitive& p = scene.meshes.emplace_back().primitives.emplace_back();
    const auto add = [&](const auto& place, glm::vec2 at) {
        p.vertices.emplace_back().position = place(at);
        p.bounds.add(p.vertices.back().position);
        return uint32_t(p.vertices.size() - 1);
    };
    for (int face = 0; face < 6; ++face)
        for (int cell = 0; cell < kCells * kCells; ++cell) {
            const int x = cell % kCells, y = cell / kCells;
            const auto place = [&](glm::vec2 at) {  // from 0 to 1 over the cell; on borders the same bits for both
                const glm::vec2 on = (glm::vec2(x, y) + at) * (10.0f / kCells) - 5.0f;
                glm::vec3 position;
                position[face / 2] = face % 2 ? 5.0f : -5.0f;
                position[(face / 2 + 1) % 3] = on.x, position[(face / 2 + 2) % 3] = on.y;
                return position;
            };
            if ((x + y) % 2) {
                std::vector<uint32_t> border;
                const auto side = [&](glm::vec2 from, glm::vec2 step) {
                    for (int k = 0; k < kParts; ++k)
                        border.push_back(add(place, from + step * float(k) / float(kParts)));
                };
                side({0, 0}, {1, 0}), side({1, 0}, {0, 1}), side({1, 1}, {-1, 0}), side({0, 1}, {0, -1});
                const uint32_t middle = add(place, glm::vec2(0.5f) + 0.1f * glm::vec2(jitter(random), jitter(random)));
                for (size_t k = 0; k < border.size(); ++k)
                    p.indices.insert(p.indices.end(), {middle, border[k], border[(k + 1) % border.size()]});
                continue;
            }
            const auto first = uint32_t(p.vertices.size());
            for (int j = 0; j <= kParts; ++j)
                for (int i = 0; i <= kParts; ++i) {
                    const bool within = i % kParts != 0 && j % kParts != 0;
                    const glm::vec2 moved = within ? glm::vec2(jitter(random), jitter(random)) : glm::vec2(0);
                    add(place, (glm::vec2(i, j) + moved) / float(kParts));
                }
            for (int j = 0; j < kParts; ++j)
                for (int i = 0; i < kParts; ++i) {
                    const uint32_t a = first + uint32_t(j * (kParts + 1) + i), b = a + 1, c = a + kParts + 1, d = c + 1;
                    p.indices.insert(p.indices.end(), {a, b, d, a, d, c});
                }
        }
    scene.nodes.emplace_back().mesh = 0;
    return scene;
}

// Triangles of less than a texel to 60 texels, side by side: no texel is left empty between them, nor drawn from
// farther or nearer than the sheet.
TEST(ShadowMap, SheetsOfSmallAndLargeTrianglesHaveNoGaps) {
    PassRig rig;
    const scene::Scene scene = patched_box();
    const render::MapFrame frame =
        render::map_frame(glm::translate(glm::dmat4(1), glm::dvec3(0.3, -0.2, 0.1)) *
                          glm::mat4_cast(glm::angleAxis(0.8, glm::normalize(glm::dvec3(1, 0.4, -0.3)))));
    const double off = snaps_coarsely(rig.device()) ? 0.05 : 0.01;
    for (const bool flat : {false, true})
        for (const uint32_t side : {64u, 256u, 1024u}) {
            SCOPED_TRACE(std::to_string(side) + (flat ? " flat" : ""));
            const render::ShadowMapToDraw map{{.side = side,
                                               .hemispheres = flat ? 1u : 2u,
                                               .zoom = flat ? 1.3f : 1.0f,
                                               .flat = flat,
                                               .range = 100,
                                               .radius = 0,
                                               .first = 0},
                                              frame,
                                              {},
                                              {}};
            const std::vector<float> drawn = draw(rig, scene, {&map, 1}, map.layout.texels());
            size_t wrong = 0;
            for (uint32_t i = 0; i < map.layout.texels(); ++i) {
                const uint32_t in_map = i % (side * side);
                glm::dvec3 way = reference::map_direction({in_map % side + 0.5, in_map / side + 0.5}, side,
                                                          double(map.layout.zoom), flat);
                if (i >= side * side) way.z = -way.z;
                way = glm::transpose(frame.rotation) * way;
                double want = 1e30;
                for (int axis = 0; axis < 3; ++axis)
                    want = std::min(want, ((way[axis] < 0 ? -5 : 5) - frame.position[axis]) / way[axis]);
                if (std::abs(double(drawn[i]) - want) > off * want && ++wrong < 5)
                    ADD_FAILURE() << in_map % side << ", " << in_map / side << ": " << drawn[i] << ", want " << want;
            }
            EXPECT_EQ(wrong, 0u);
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Each map has the leaves that its lamp sees, and none of those of others.
TEST(ShadowMap, LeavesHideWhatTheyHideInEveryMap) {
    PassRig rig;
    OccluderScene s = leaves();
    s.box({0, 0, 0}, glm::vec3(9));
    s.scene().meshes.back().primitives[0].material = opaque(s);
    const RayCaster rays(s.scene(), scene::world_transforms(s.scene(), 0));
    std::vector<render::ShadowMapToDraw> maps;
    uint32_t first = 0;
    for (uint32_t i = 0; i < 7; ++i) {
        const bool flat = i == 2, beam = i == 4;
        const glm::dmat4 pose =
            glm::translate(glm::dmat4(1), glm::dvec3(0.2 * i - 0.6, 0.15 * i - 0.5, 0.5 - 0.15 * i)) *
            glm::mat4_cast(glm::angleAxis(0.9 * i, glm::normalize(glm::dvec3(1, 0.3 * i, -0.5))));
        maps.push_back({{.side = i % 2 ? 128u : 64u,
                         .hemispheres = flat || beam ? 1u : 2u,
                         .zoom = flat   ? 1.2f
                                 : beam ? 2.5f
                                        : 1.0f,
                         .flat = flat,
                         .range = 100,
                         .radius = 0,
                         .first = first},
                        render::map_frame(pose),
                        {},
                        {}});
        first += maps.back().layout.texels();
    }
    const std::vector<float> drawn = draw(rig, s.scene(), maps, first);
    size_t leaf = 0;
    for (const render::ShadowMapToDraw& map : maps)
        for (uint32_t h = 0; h < map.layout.hemispheres; ++h) {
            const uint32_t side = map.layout.side, begin = map.layout.first + h * side * side;
            SCOPED_TRACE("map from " + std::to_string(begin));
            // Where opacity passes the cutoff between two corners float may have it beside: 1 of 5,000.
            expect_rays(rays, map, h == 1, &drawn[begin], std::max(2.5 * snapped(rig.device()), 0.01),
                        snaps_coarsely(rig.device()), 1 + side * side / 5000);
            for (uint32_t i = 0; i < side * side; ++i) leaf += drawn[begin + i] < 7 ? 1 : 0;
        }
    EXPECT_GT(leaf, first / 20);
    EXPECT_LT(leaf, first / 2);
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::draw_shadow_maps_test
