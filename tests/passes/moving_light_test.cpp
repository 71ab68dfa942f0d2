// The pass of what moves near surfaces on the device, against the reference. SPDX-License-Identifier: MIT
#include "passes/moving_light_reference.h"

#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "render/passes/moving_light.h"
#include "shared/moving_light.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::moving_light_test {
namespace {

using glm::dvec3;

// Devices may round halves that they store to either side.
constexpr double kUlp16 = 2 * kHalfUlp16, kLeastHalf = 0x1p-24;

/// Surfaces near and far, of all directions that can be seen, and sky.
Surfaces noise(VkExtent2D extent, uint32_t seed) {
    Noise random(seed);
    Surfaces s{extent, {}, {}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        s.reflectance.emplace_back(0.5f);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(random.facing(0.1))),
                               i % 7 == 1 ? 0.0f : 0.3f + 12 * random.unit(), 1);
    }
    return s;
}

/// Bodies all around a place, some behind it; three shapes of any values.
struct Street {
    transport::MovingBodies bodies;
    gpu_scene::SceneFrame poses;
    std::vector<transport::LitPatch> patches;
};
Street street(dvec3 middle, uint32_t count, uint32_t patches, uint32_t seed) {
    Noise random(seed);
    Street s;
    for (const glm::uvec3 places : {glm::uvec3(5, 4, 3), glm::uvec3(2, 2, 2), glm::uvec3(9, 3, 6)}) {
        const auto first = uint32_t(s.bodies.hidden.size());
        s.bodies.volumes.push_back(
            {dvec3(random.normal(), random.normal(), 0), 0.6 + double(random.unit()), places, first});
        for (uint32_t i = 0; i < places.x * places.y * places.z; ++i) {
            auto& parts = s.bodies.hidden.emplace_back();
            for (uint32_t side = 0; side < 6; ++side)
                parts[side] = uint8_t(transport::MovingBodies::kAll * random.unit());
        }
    }
    const auto somewhere = [&] { return dvec3(random.normal(), random.normal(), random.normal()); };
    for (uint32_t i = 0; i < count; ++i) {
        s.bodies.bodies.push_back({i, i % 3});
        const glm::dmat4 at = glm::translate(glm::dmat4(1), middle + 1.5 * somewhere());
        s.poses.world.push_back(glm::rotate(at, 6 * double(random.unit()), glm::normalize(somewhere())));
    }
    for (uint32_t i = 0; i < patches; ++i)
        s.patches.push_back({.position = middle + 3.0 * somewhere(),
                             .normal = glm::normalize(somewhere()),
                             .radius = i % 3 ? double(random.unit()) : 0,
                             .intensity = dvec3(random.unit(), random.unit(), random.unit()) * 150.0});
    return s;
}

gpu_scene::View looking(VkExtent2D extent, dvec3 from) {
    const glm::dmat4 turned = glm::rotate(glm::rotate(glm::dmat4(1), 0.35, {1, 0, 0}), 0.6, {0, 1, 0});
    return gpu_scene::View::symmetric(extent, 1.1f, glm::translate(turned, -from));
}

std::vector<glm::vec4> light(PassRig& rig, const Surfaces& s, const Street& street, const gpu_scene::View& view) {
    graph::FrameGraph graph;
    render::MovingLight moving{.volumes = {},
                               .things = gpu_scene::moving_things(street.bodies, street.patches, street.poses, view)};
    if (!street.bodies.hidden.empty())
        moving.volumes = graph.upload("volumes", gpu_scene::volume_texels(street.bodies), VK_FORMAT_R32G32B32A32_UINT);
    const graph::Resource found = render::add_moving_light(rig.frame(graph, view), upload(graph, s), moving);
    if (!found) return {};
    const graph::Resource wanted = rig.want<uint64_t>(graph, found, s.surface.size());
    rig.run(graph);
    return from_halves(rig.got<uint64_t>(wanted));
}

/// Places and normals are rounded by 1e-6 of how far they are from the eye; values are halves.
void expect_reference(const std::vector<glm::vec4>& got, const Surfaces& s, const Street& street,
                      const gpu_scene::View& view) {
    ASSERT_EQ(got.size(), s.surface.size());
    const glm::dmat4 world = glm::inverse(view.world_to_view);
    size_t hidden = 0, lit = 0, edges = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        const glm::dvec4 surface(s.surface[i]);
        double open = 1, rounding = 0;
        dvec3 rgb(0), least(1e300), most(0);
        if (surface.z > 0) {
            const dvec3 ray(view.ray_scale() * (glm::vec2(s.pixel(i)) + 0.5f) + view.ray_offset(), -1);
            const dvec3 normal = glm::dmat3(world) * reference::octahedral_decode(glm::dvec2(surface));
            const auto at = [&](dvec3 off) { return dvec3(world * glm::dvec4(surface.z * ray, 1)) + off; };
            open = reference::left_open(street.bodies, street.poses, at(dvec3(0)), normal);
            for (const transport::LitPatch& patch : street.patches)
                rgb += reference::light_of(patch, at(dvec3(0)), normal);
            for (int corner = 0; corner < 8; ++corner) {
                const dvec3 off = 2e-6 * surface.z * (2.0 * dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 1.0);
                rounding = std::max(
                    rounding, std::abs(reference::left_open(street.bodies, street.poses, at(off), normal) - open));
                dvec3 sum(0);
                for (const transport::LitPatch& patch : street.patches)
                    sum += reference::light_of(patch, at(off), normal);
                least = glm::min(least, sum), most = glm::max(most, sum);
            }
        }
        EXPECT_NEAR(double(got[i].a), open, rounding + 1e-5 + kUlp16 * open) << "pixel " << i;
        for (int c = 0; c < 3 && surface.z > 0; ++c) {
            EXPECT_NEAR(double(got[i][c]), rgb[c], most[c] - least[c] + (1e-5 + kUlp16) * rgb[c] + kLeastHalf)
                << "pixel " << i;
        }
        hidden += open<0.99, lit += rgb.g> 1, edges += rounding > 1e-3;
    }
    if (got.size() < 1000) return;
    EXPECT_GE(hidden, street.bodies.bodies.empty() ? 0 : got.size() / 40);
    EXPECT_GE(lit, street.patches.empty() ? 0 : got.size() / 20);
    EXPECT_LT(edges, got.size() / 200 + 3) << "few pixels have two right results";
}

TEST(MovingLight, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {97, 61}})
        for (const dvec3 from : {dvec3(1, 2, -3), dvec3(-81'234.5, 312, 1.2e6)}) {
            SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
            const Street things = street(from, 9, 7, extent.width);
            const gpu_scene::View view = looking(extent, from + dvec3(0.3, 0.2, 4));
            const Surfaces s = noise(extent, extent.height);
            expect_reference(light(rig, s, things, view), s, things, view);
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(MovingLight, OneKindIsEnough) {
    PassRig rig;
    const VkExtent2D extent{50, 40};
    const gpu_scene::View view = looking(extent, {0, 0, 4});
    const Surfaces s = noise(extent, 3);
    Street bodies = street({0, 0, 0}, 12, 0, 5), patches = street({0, 0, 0}, 0, 12, 6);
    patches.bodies = {};
    expect_reference(light(rig, s, bodies, view), s, bodies, view);
    expect_reference(light(rig, s, patches, view), s, patches, view);
    EXPECT_TRUE(light(rig, s, {}, view).empty());
    EXPECT_EQ(rig.complaints(), "");
}

// The nearest bodies, the strongest patches.
TEST(MovingLight, OfManyTheFirstCount) {
    const gpu_scene::View view = gpu_scene::View::symmetric({64, 64}, 1, glm::dmat4(1));
    Street many = street({0, 0, -20}, 90, 90, 7);
    for (uint32_t i = 0; i < 90; ++i) {
        many.poses.world[i] = glm::translate(glm::dmat4(1), {0, 0, -4.0 - (i * 37 % 90)});
        many.patches[i].position = {0, 0, -5}, many.patches[i].radius = 0;
        many.patches[i].intensity = dvec3(1 + i * 37 % 90);
    }
    const gpu_scene::MovingThings things = gpu_scene::moving_things(many.bodies, many.patches, many.poses, view);
    EXPECT_EQ(things.bodies.size(), shared::kMostBodies);
    ASSERT_EQ(things.patches.size(), shared::kMostPatches * shared::kPatchTexels);
    for (uint32_t k = 0; k < shared::kMostPatches; ++k)
        EXPECT_EQ(things.patches[k * shared::kPatchTexels + 2].x, float(90 - k));
}

TEST(MovingLight, WhatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const VkExtent2D extent{40, 16};
    Street things = street({0, 0, 0}, 5, 5, 3);
    things.poses.world[2] = glm::dmat4(std::numeric_limits<double>::quiet_NaN());
    things.poses.world[3][3].x = std::numeric_limits<double>::infinity();
    const gpu_scene::View view = looking(extent, {0, 0, 4});
    const Surfaces clean = noise(extent, 4);
    Surfaces s = clean;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const float depths[]{kNan, 5, kInf, 3e38f};
    for (size_t i = 3; i < s.surface.size(); i += 7) s.surface[i] = {i % 3 ? kNan : kInf, kNan, depths[i % 4], kNan};
    const auto got = light(rig, s, things, view), want = light(rig, clean, things, view);
    expect_others_equal(got, want);
    for (size_t i = 0; i < got.size(); ++i)
        if (i % 7 != 3) {
            EXPECT_TRUE(std::isfinite(got[i].a)) << "pixel " << i;
        }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::moving_light_test
