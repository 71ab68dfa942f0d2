// Maps of directional lamps on the device: against rays along the light. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>

#include "passes/shadows/draw_clipmaps_reference.h"
#include "render/shadows/draw_clipmaps.h"
#include "support/map_texels.h"
#include "support/occluders.h"
#include "support/ray_caster.h"
#include "support/snapping.h"
#include "support/texels.h"

namespace vesper::test::draw_clipmaps_test {
namespace {

std::vector<float> draw(PassRig& rig, const scene::Scene& scene, std::span<const render::LevelToDraw> levels,
                        uint32_t side, uint32_t texels) {
    const gpu_scene::GpuScene resident(rig.device(), scene);
    return drawn_texels(rig, texels, [&](const render::FrameContext& frame, graph::Resource words) {
        render::add_clipmaps(frame, resident, {scene::world_transforms(scene, 0), {}, {}, {}, {}}, levels, side, words,
                             render::add_level_scratch(frame.graph, side));
    });
}

OccluderScene yard() {
    OccluderScene s;
    s.plate({0, -4, 0}, {30, 0, 0}, {0, 0, 30});
    s.box({3, -3, -2}, {0.9f, 1, 2});
    s.box({-4, -2, 1}, {0.2f, 2, 0.2f});
    s.box({0.5f, 20, 0.3f}, {0.6f, 0.1f, 0.6f});
    s.plate({-8, 0, 0}, {0, 6, 0}, {0, 0.5f, 9});
    return s;
}

constexpr uint32_t kSide = 256;

struct Compared {
    size_t texels = 0, surfaces = 0, within = 0;  // within: nearer than the last argument
};

/// Texels of a level agree with rays but for those where a ray a hair beside meets something else, and for `few`.
Compared expect_rays(PassRig& rig, const RayCaster& rays, const render::LevelToDraw& l, const std::vector<float>& drawn,
                     size_t few = 0, double near = 0) {
    const double snap = std::max(snapped(rig.device()), 0.02);
    const reference::Level level{l.rotation, l.middle, l.half_width, kSide};
    const glm::dvec3 way = glm::transpose(l.rotation)[2];
    const auto distance_at = [&](glm::dvec2 texel) {
        const glm::dvec3 at = reference::on_level(level, texel);
        return 2000 * rays.hit(at - 1000.0 * way, at + 1000.0 * way, 0, 1, [](uint32_t) { return true; }) - 1000;
    };
    Compared compared;
    size_t astray = 0;
    for (uint32_t y = 0; y < kSide; y += 3)
        for (uint32_t x = 0; x < kSide; x += 3) {
            const glm::dvec2 middle(x + 0.5, y + 0.5);
            const double want = distance_at(middle);
            bool certain = true;
            for (const glm::dvec2 aside : {glm::dvec2(snap, 0), {-snap, 0}, {0, snap}, {0, -snap}}) {
                const double other = distance_at(middle + aside);
                certain = certain && (std::isinf(want) ? std::isinf(other) : std::abs(other - want) < 2.5 * snap);
            }
            if (!certain) continue;
            ++compared.texels, compared.surfaces += std::isinf(want) ? 0 : 1, compared.within += want < near ? 1 : 0;
            const double got = double(drawn[l.first + size_t(y) * kSide + x]);
            // A half has 11 bits.
            const bool right = std::isinf(want) ? got >= 5e4 : std::abs(got - want) <= 1e-3 * std::abs(want) + snap;
            if (!right && astray++ >= few) ADD_FAILURE() << x << " " << y << ": " << got << ", want " << want;
        }
    return compared;
}

TEST(Clipmap, HoldsTheFirstSurfaceAlongTheLight) {
    PassRig rig;
    OccluderScene s = yard();
    const RayCaster rays(s.scene(), scene::world_transforms(s.scene(), 0));
    for (const double tilt : {0.0, 0.9}) {
        SCOPED_TRACE("tilt " + std::to_string(tilt));
        const glm::dmat4 pose = glm::mat4_cast(glm::angleAxis(tilt - 1.57, glm::normalize(glm::dvec3(1, 0.1, 0.2))));
        const glm::dmat3 rotation = render::map_frame(pose).rotation;
        const render::LevelToDraw levels[] = {{rotation, {1, 2, -3}, 16, kSide * kSide}, {rotation, {4, 0, 8}, 64, 0}};
        const std::vector<float> drawn = draw(rig, s.scene(), levels, kSide, 2 * kSide * kSide);
        for (const render::LevelToDraw& level : levels) {
            const Compared compared = expect_rays(rig, rays, level, drawn);
            EXPECT_GT(compared.texels, 6000u);
            EXPECT_GT(compared.surfaces, 500u);
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Holes of textures and what is clear by its vertices or its material let light through to the ground.
TEST(Clipmap, LeavesHideWhatTheyHide) {
    PassRig rig;
    OccluderScene s = leaves();
    s.plate({0, -6, 0}, {30, 0, 0}, {0, 0, 30});
    s.scene().meshes.back().primitives[0].material = opaque(s);
    const RayCaster rays(s.scene(), scene::world_transforms(s.scene(), 0));
    const glm::dmat4 pose = glm::mat4_cast(glm::angleAxis(-1.3, glm::normalize(glm::dvec3(1, 0.1, 0.2))));
    const render::LevelToDraw level{render::map_frame(pose).rotation, {0.3, 0.2, 0}, 6, 0};
    // Where opacity passes the cutoff between two corners float may have it beside: 1 of 1,000.
    const Compared compared =
        expect_rays(rig, rays, level, draw(rig, s.scene(), {&level, 1}, kSide, kSide * kSide), 7, 5);
    EXPECT_GT(compared.texels, 5000u);
    EXPECT_GT(compared.within, 500u) << "leaves";
    EXPECT_GT(compared.surfaces - compared.within, 1000u) << "ground";
    EXPECT_EQ(rig.complaints(), "");
}

// Nothing is drawn of an empty scene, nor of glass.
TEST(Clipmap, IsEmptyWhereNothingHides) {
    PassRig rig;
    OccluderScene s;
    s.plate({0, 0, 0}, {3, 0, 0}, {0, 0, 3});
    s.scene().materials[0].clear = true;
    const render::LevelToDraw levels[] = {{glm::dmat3(1), {0, 0, 0}, 16, 0}};
    for (const float distance : draw(rig, s.scene(), levels, 64, 64 * 64)) ASSERT_GE(distance, 5e4f);
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::draw_clipmaps_test
