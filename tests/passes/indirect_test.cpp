// The pass of light from cells on the device, against the reference. SPDX-License-Identifier: MIT
#include "passes/indirect_reference.h"

#include <cmath>
#include <limits>
#include <map>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "gpu_scene/irradiance_cells.h"
#include "render/passes/indirect.h"
#include "shared/indirect.h"
#include "support/made_cells.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::indirect_test {
namespace {

using glm::dvec3, glm::vec3;
constexpr float kLambert = 0.318309886f;
const vec3 kAbove(9, 10, 11), kBelow(3, 2, 1);  // lx, where there are no cells

/// Surfaces, and what lamps gave them.
struct Lit : Surfaces {
    std::vector<glm::vec4> scene;
};

/// Noise: surfaces near and far, of all directions that can be seen, roads, sky.
Lit noise(VkExtent2D extent, uint32_t seed) {
    Noise random(seed);
    Lit s{{extent, {}, {}, {}}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        s.reflectance.emplace_back(random.fine(), random.fine(), random.fine(),
                                   i % 5 == 2 ? -1.0f - float(i % 2) : float(i % 3));
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(random.facing(0.1))),
                               i % 7 == 1 ? 0.0f : 0.3f + 12 * random.unit(),
                               i % 5 == 2 ? -1.5f * random.unit() : random.unit());
        s.scene.emplace_back(random.unit(), random.unit(), random.unit(), 1);
    }
    return s;
}

/// Of a value in lx that halves of kCellUnit hold.
float exact(Noise& random) { return shared::kCellUnit * random.fine(); }

/// A grid of 20 x 12 x 20 m about a place, of which a part of all cells is there, with walls to a quarter of those
/// around them, cuts through a quarter, and cells of air in half of it.
MadeCells cells_around(dvec3 middle, uint32_t seed, double part) {
    Noise random(seed);
    MadeCells made{{.origin = middle - dvec3(10, 6, 10), .size = 0.8, .count = {25, 15, 25}}, {}};
    const auto light = [&] { return vec3(exact(random), exact(random), exact(random)); };
    for (int z = 0; z < 25; ++z)
        for (int y = 0; y < 15; ++y)
            for (int x = 0; x < 25; ++x)
                for (uint32_t facing = 0; facing < transport::kFacings; ++facing) {
                    const bool there = double(random.unit()) < part;
                    const double height = 0.8 * glm::unpackHalf1x16(glm::packHalf1x16(random.unit() - 0.5f));
                    const auto byte = [&] { return std::round(double(random.unit()) * 254 - 127) / 127; };
                    const vec3 normal(reference::octahedral_decode({byte(), byte()}));
                    uint8_t walls = 0;
                    for (uint32_t bit = 0; bit < 8; ++bit) walls |= uint8_t((random.unit() < 0.25f ? 1u : 0u) << bit);
                    transport::CellCut cut;
                    if (random.unit() < 0.25f)
                        cut = transport::CellCut::across(uint32_t(random.unit() * 4) % 4, double(random.unit()),
                                                         random.unit() < 0.5f);
                    if (there) made.add({x, y, z}, facing, normal, height, light(), walls, cut);
                }
    for (int z = 0; z < 5; ++z)  // of five cubes each
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x)
                for (uint32_t side = 0; side < 6; ++side)
                    if (random.unit() < 0.8f) made.add_air({x, y, z}, side, light());
    return made;
}

gpu_scene::View looking(VkExtent2D extent, dvec3 from) {
    const glm::dmat4 turned = glm::rotate(glm::rotate(glm::dmat4(1), 0.35, {1, 0, 0}), 0.6, {0, 1, 0});
    return gpu_scene::View::symmetric(extent, 1.1f, glm::translate(turned, -from));
}

std::vector<glm::vec4> add(PassRig& rig, const Lit& s, const MadeCells& made, const gpu_scene::View& view) {
    const gpu_scene::IrradianceCells table = gpu_scene::irradiance_cells(made.radiosity(), made.light());
    graph::FrameGraph graph;
    const render::GBuffer g = upload(graph, s);
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, s.extent, s.scene);
    const graph::Resource texels = graph.upload("cells", table.texels, VK_FORMAT_R32G32B32A32_UINT);
    const graph::Resource wanted = keep<glm::vec4>(
        graph, render::add_indirect(rig.frame(graph, view), g, scene,
                                    {texels, table.log2_places, made.grid, kAbove, kBelow}, {}, kLambert));
    rig.run(graph);
    return rig.got<glm::vec4>(wanted);
}

/// Sums of four to twelve positive terms in float: 4e-6. Places are rounded by 3e-7 of how far the eye and the surface
/// are from the grid's corner, and normals by 1e-6: what that changes is right too, also where it is another cube, side
/// or surface, or there is none.
void expect_reference(const std::vector<glm::vec4>& got, const Lit& s, const MadeCells& made,
                      const gpu_scene::View& view) {
    std::vector<reference::LitCell> list;
    for (const auto& [number, cell] : made.cells) {
        list.push_back({number, dvec3(cell.light), double(cell.height), dvec3(cell.normal), cell.walls});
        reference::set_cut(list.back(), cell.cut.bits);
    }
    const reference::CellList cells(made.grid, list, dvec3(kAbove), dvec3(kBelow));
    const dvec3 eye = made.grid.place(gpu_scene::eye_of(view));
    size_t jumps = 0;
    expect_light("indirect", s.extent, got, {4e-6, 1e-6}, [&](size_t i) {
        const dvec3 was(s.scene[i]);
        const reference::SurfaceTexel texel = s.texel(i);
        if (!(texel.surface.z > 0)) return reference::Shaded{was, dvec3(0)};
        const glm::dvec2 centre = glm::dvec2(s.pixel(i)) + 0.5;
        const reference::CellPlace at = reference::cell_place(made.grid, texel, centre, view);
        const auto light = [&](dvec3 place, uint32_t side) {
            return reference::sent(texel, centre, view, reference::illuminance_on(cells, place, at.normal, side),
                                   double(kLambert));
        };
        const std::vector<uint32_t> sides = reference::facings_of(at.normal, 1e-6);
        const dvec3 here = light(at.place, sides[0]);
        const double off = 3e-7 * (glm::length(eye) + glm::distance(at.place, eye));
        dvec3 rounding(0);
        for (const uint32_t side : sides)
            for (int corner = 0; corner < 8; ++corner) {
                const dvec3 moved = off * (2.0 * dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 1.0);
                rounding = glm::max(rounding, glm::abs(light(at.place + moved, side) - here));
            }
        jumps += glm::length(rounding) > 1e-3 * glm::length(here) + 1e-9;
        return reference::Shaded{was + here, rounding};
    });
    EXPECT_LE(jumps, 2 + got.size() / 200) << "few pixels have two right results";
}

TEST(Indirect, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {97, 61}})
        for (const dvec3 from : {dvec3(1, 2, -3), dvec3(-81'234.5, 312, 1.2e6)}) {
            SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
            const MadeCells made = cells_around(from, extent.width, 0.5);
            const gpu_scene::View view = looking(extent, from + dvec3(0.3, 0.2, 4));
            const Lit s = noise(extent, extent.height);
            expect_reference(add(rig, s, made, view), s, made, view);
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Few surfaces: the air and nothing; and all of them, in a table of 2^17 places.
TEST(Indirect, MatchesTheReferenceOfFewAndOfAllCells) {
    PassRig rig;
    const VkExtent2D extent{64, 48};
    for (const double part : {0.0, 0.02, 1.0}) {
        const MadeCells made = cells_around({0, 0, 0}, 3, part);
        const gpu_scene::View view = looking(extent, {-1, 1, 5});
        const Lit s = noise(extent, 8);
        expect_reference(add(rig, s, made, view), s, made, view);
    }
    EXPECT_EQ(rig.complaints(), "");
}

/// A floor of one light before the eye; all pixels see it from 1 m above.
struct Ground {
    MadeCells made{{.origin = {-50, -2.5, -100}, .size = 1, .count = {100, 3, 100}}, {}};
    Lit s{{{16, 8}, {}, {}, {}}, {}};
    gpu_scene::View view = gpu_scene::View::symmetric(s.extent, 0.2f, glm::rotate(glm::dmat4(1), 0.5, {1, 0, 0}));

    Ground() {
        for (int x = 0; x < 100; ++x)
            for (int z = 0; z < 100; ++z) made.add({x, 1, z}, 2, 0, {160, 320, 80});
        const dvec3 up = glm::dmat3(view.world_to_view) * dvec3(0, 1, 0);
        for (size_t i = 0; i < 16 * 8; ++i) {
            const dvec3 ray(view.ray_scale() * (glm::vec2(s.pixel(i)) + 0.5f) + view.ray_offset(), -1);
            s.reflectance.emplace_back(0.5f, 0.25f, 1, 0);
            s.surface.emplace_back(glm::vec2(reference::octahedral_encode(up)), float(-1 / glm::dot(ray, up)), 1);
            s.scene.emplace_back(0, 0, 0, 1);
        }
    }
};

TEST(Indirect, AnEvenFloorSendsRhoEOverPi) {
    PassRig rig;
    const Ground ground;
    for (const glm::vec4 pixel : add(rig, ground.s, ground.made, ground.view))
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], 80 * kLambert, 80 * kLambert * 2e-6f);
    EXPECT_EQ(rig.complaints(), "");
}

// A street of 5 lx beside a yard of 120 lx, with a wall between them along x and a gate in it: no light crosses the
// wall.
TEST(Indirect, WallsKeepTheLightOfTheirSide) {
    PassRig rig;
    Ground ground;
    for (int x = 0; x < 100; ++x)
        for (int z = 0; z < 100; ++z) {
            // Bits 0, 3 and 5 are the cells at z - 1, and bits 2, 4 and 7 those at z + 1.
            const bool yard = z >= 98, gate = x % 4 == 1;
            const uint8_t hidden = gate ? 0 : z == 97 ? 0b10010100 : z == 98 ? 0b00101001 : 0;
            ground.made.add({x, 1, z}, 2, 0, glm::vec3(yard ? 120 : 5), hidden);
        }
    const auto got = add(rig, ground.s, ground.made, ground.view);
    expect_reference(got, ground.s, ground.made, ground.view);
    size_t street = 0, yard = 0, mixed = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        const double lux = double(got[i].y) / 0.25 / double(kLambert);
        (std::abs(lux - 5) < 1e-3 ? street : std::abs(lux - 120) < 1e-3 ? yard : mixed) += 1;
    }
    EXPECT_GT(street, 10u);
    EXPECT_GT(yard, 10u);
    EXPECT_GT(mixed, 5u) << "at gates";
    EXPECT_EQ(rig.complaints(), "");
}

// Where no place is free cells are looked for all round the table; a small one, as CPU devices end loops of 65,535
// turns.
TEST(Indirect, FindsCellsBehindOthers) {
    PassRig rig;
    Ground ground;
    std::erase_if(ground.made.cells, [&](const auto& cell) {
        const dvec3 place = ground.made.grid.place(ground.made.grid.middle(cell.first));
        return std::abs(place.x - 50) > 10 || place.z < 90;
    });
    const gpu_scene::IrradianceCells table = gpu_scene::irradiance_cells(ground.made.radiosity(), ground.made.light());
    // Cells that nobody asks for, and those of the ground from the first place on: most lie before theirs.
    std::vector<glm::uvec4> full;
    for (const glm::uvec4 cell : table.texels)
        if (cell.x != shared::kNoCell) full.push_back(cell);
    ASSERT_EQ(full.size(), ground.made.cells.size());
    while (full.size() < table.texels.size())
        full.push_back({4'000'000'000u + uint32_t(full.size()), 0x7bff7bffu, 0x7bffu, 0});

    graph::FrameGraph graph;
    const render::GBuffer g = upload(graph, ground.s);
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, ground.s.extent, ground.s.scene);
    const graph::Resource texels = graph.upload("cells", full, VK_FORMAT_R32G32B32A32_UINT);
    const graph::Resource wanted = keep<glm::vec4>(
        graph, render::add_indirect(rig.frame(graph, ground.view), g, scene,
                                    {texels, table.log2_places, ground.made.grid, kAbove, kBelow}, {}, kLambert));
    rig.run(graph);
    const auto got = rig.got<glm::vec4>(wanted);  // before the rig runs another
    EXPECT_EQ(got, add(rig, ground.s, ground.made, ground.view));
    EXPECT_EQ(rig.complaints(), "");
}

// E open + that of the image, in each pixel.
TEST(Indirect, AddsWhatMoves) {
    PassRig rig;
    const Ground ground;
    std::vector<glm::vec4> moving;
    for (size_t i = 0; i < ground.s.surface.size(); ++i)
        moving.emplace_back(float(i), 2.0f * float(i), 0.5f * float(i), float(i % 9) / 8);
    const auto without = add(rig, ground.s, ground.made, ground.view);
    graph::FrameGraph graph;
    const gpu_scene::IrradianceCells table = gpu_scene::irradiance_cells(ground.made.radiosity(), ground.made.light());
    const render::GBuffer g = upload(graph, ground.s);
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, ground.s.extent, ground.s.scene);
    const graph::Resource texels = graph.upload("cells", table.texels, VK_FORMAT_R32G32B32A32_UINT);
    const graph::Resource image =
        rig.image(graph, "moving", VK_FORMAT_R16G16B16A16_SFLOAT, ground.s.extent, to_halves(moving));
    const graph::Resource wanted = keep<glm::vec4>(
        graph, render::add_indirect(rig.frame(graph, ground.view), g, scene,
                                    {texels, table.log2_places, ground.made.grid, kAbove, kBelow}, image, kLambert));
    rig.run(graph);
    const auto got = rig.got<glm::vec4>(wanted);
    for (size_t i = 0; i < got.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double want = double(without[i][c]) * double(moving[i].a) +
                                double(kLambert) * double(ground.s.reflectance[i][c]) * double(moving[i][c]);
            EXPECT_NEAR(double(got[i][c]), want, 1e-6 * want + 1e-6) << i;
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Rows of pixels of one place, that face other sides of its cube.
TEST(Indirect, MatchesTheReferenceWhereOnlySidesDiffer) {
    PassRig rig;
    const VkExtent2D extent{16, 24};
    MadeCells made = cells_around({0, 0, 0}, 3, 1);
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 1e-4f, glm::dmat4(1));
    Lit s = noise(extent, 8);
    for (size_t i = 0; i < s.surface.size(); ++i) {
        const dvec3 normals[]{{0, 0, 1}, {0.9, 0, 0.1}, {0, -0.9, 0.2}, {0, 0.9, 0.3}, {-0.9, 0.2, 0.1}};
        const glm::vec2 normal(reference::octahedral_encode(glm::normalize(normals[s.pixel(i).y % 5])));
        s.surface[i] = {normal, 4, s.surface[i].w};
    }
    // In the upper half of a cube along all axes, so that the cubes around it are the same for all sides.
    made.grid.origin += made.grid.size * (glm::fract(made.grid.place({0, 0, -4})) - 0.7);
    expect_reference(add(rig, s, made, view), s, made, view);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Indirect, WhatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const VkExtent2D extent{40, 16};
    const MadeCells made = cells_around({0, 0, 0}, 3, 0.4);
    const gpu_scene::View view = looking(extent, {0, 0, 4});
    const Lit clean = noise(extent, 4);
    Lit s = clean;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const float depths[]{kNan, 5, kInf, 3e38f};
    for (size_t i = 3; i < s.scene.size(); i += 7) {
        s.surface[i] = {i % 3 ? kNan : kInf, kNan, depths[i % 4], kNan};
        s.reflectance[i] = glm::vec4(kNan), s.scene[i].g = kInf;
    }
    const auto got = add(rig, s, made, view), want = add(rig, clean, made, view);
    expect_others_equal(got, want);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Indirect, WithoutCellsThereIsNoPass) {
    expect_no_pass([](const render::FrameContext& frame, graph::Resource scene) {
        return render::add_indirect(frame, {}, scene, {}, {}, 1);
    });
}

std::vector<glm::vec4> add_known(PassRig& rig, const Lit& s, const std::vector<glm::vec4>& lux,
                                 const gpu_scene::View& view) {
    graph::FrameGraph graph;
    const render::GBuffer g = upload(graph, s);
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, s.extent, s.scene),
                          known = rig.image(graph, "lux", VK_FORMAT_R32G32B32A32_SFLOAT, s.extent, lux);
    const graph::Resource wanted =
        keep<glm::vec4>(graph, render::add_illuminance(rig.frame(graph, view), g, scene, known, kLambert));
    rig.run(graph);
    return rig.got<glm::vec4>(wanted);
}

std::vector<glm::vec4> illuminance(VkExtent2D extent, uint32_t seed) {
    Noise random(seed);
    std::vector<glm::vec4> lux;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i)
        lux.emplace_back(1e3f * random.unit(), random.unit(), 1e-3f * random.unit(), 7);
    return lux;
}

// A product of four factors, and of road surfaces a smooth step of the angle of sight: 2e-6.
TEST(Indirect, MatchesTheReferenceOfKnownIlluminance) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {97, 61}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        const gpu_scene::View view = looking(extent, {1, 2, -3});
        const Lit s = noise(extent, extent.width);
        const std::vector<glm::vec4> lux = illuminance(extent, extent.height);
        expect_light("illuminance", extent, add_known(rig, s, lux, view), {2e-6, 1e-6}, [&](size_t i) {
            return reference::Shaded{reference::add_illuminance(s.texel(i), dvec3(s.scene[i]), dvec3(lux[i]),
                                                                glm::dvec2(s.pixel(i)) + 0.5, view, double(kLambert)),
                                     dvec3(0)};
        });
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Indirect, KnownIlluminanceThatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const VkExtent2D extent{41, 17};
    const gpu_scene::View view = looking(extent, {0, 0, 4});
    const Lit clean = noise(extent, 4);
    const std::vector<glm::vec4> clean_lux = illuminance(extent, 5);
    Lit s = clean;
    std::vector<glm::vec4> lux = clean_lux;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    for (size_t i = 3; i < s.scene.size(); i += 7) {
        lux[i] = glm::vec4(i % 2 ? kNan : kInf);
        if (i % 3 == 0) s.surface[i] = {kNan, kInf, i % 2 ? kNan : kInf, kNan}, s.reflectance[i] = glm::vec4(kNan);
    }
    const auto got = add_known(rig, s, lux, view), want = add_known(rig, clean, clean_lux, view);
    expect_others_equal(got, want);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Indirect, WithoutIlluminanceThereIsNoPass) {
    expect_no_pass([](const render::FrameContext& frame, graph::Resource scene) {
        return render::add_illuminance(frame, {}, scene, {}, 1);
    });
}

}  // namespace
}  // namespace vesper::test::indirect_test
