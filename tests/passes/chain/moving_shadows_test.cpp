// Shadow maps from frame to frame, on the device: after any frames they are as if drawn anew. SPDX-License-Identifier:
// MIT
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "support/lit.h"
#include "support/occluders.h"

namespace vesper::test::moving_shadows_test {
namespace {

// A lamp never shades itself by its fixture; something that moves takes its shadow along; a lamp that is switched on
// later has shadows; what has no place any more finds one.
TEST(MovingShadows, MapsAreNeverStale) {
    PassRig rig;
    OccluderScene s;
    s.plate({0, 0, 0}, {20, 0, 0}, {0, 0, -20});
    const uint32_t box = s.box({0, 0, 0}, glm::vec3(0.5f));
    scene::Lamp lamp;
    lamp.intensity = 1000;
    const uint32_t post = s.box({3, 3, 0}, {0.1f, 3, 0.1f});  // reaches above its lamp
    const uint32_t node = s.lamp(lamp, {3, 5, 0});
    s.scene().nodes[node].parent = post;
    Lit all(rig, s.scene());
    const gpu_scene::View view = view_of_the_ground(64, 10);
    const auto brightness = [&](double x, double z) {
        const Lit::Picture p = all.render(view);
        const glm::ivec2 px(32 + int(std::floor(x * 6.4)), 32 + int(std::floor(z * 6.4)));
        return double(p.pixels[size_t(px.y) * 64 + size_t(px.x)].y);
    };
    const auto move = [&](double x) { all.poses.world[box] = glm::translate(glm::dmat4(1), glm::dvec3(x, 2, 0)); };
    move(1.5);  // the box is on the way from (3, 5) to (0, 0)
    EXPECT_EQ(brightness(0, 0), 0);
    EXPECT_GT(brightness(0, 3), 0);
    move(-3);
    EXPECT_GT(brightness(0, 0), 0);
    move(1.5);
    EXPECT_EQ(brightness(0, 0), 0);
    all.poses.dimming.assign(s.scene().nodes.size(), 1);
    all.poses.dimming[node] = 0;
    EXPECT_EQ(brightness(0, 3), 0);
    move(1.2);
    all.poses.dimming[node] = 0.5f;
    EXPECT_EQ(brightness(0, 0), 0);
    EXPECT_GT(brightness(0, 3), 0);
    EXPECT_EQ(rig.complaints(), "");
}

// A street of posts with lamps, a box that moves through it, and a lamp on another box that moves.
struct Traffic {
    OccluderScene s;
    uint32_t box = 0, carrier = 0;
    Traffic() {
        s.plate({0, 0, 0}, {20, 0, 0}, {0, 0, -20});
        scene::Lamp lamp;
        lamp.intensity = 1000;
        for (const double x : {-3.0, 0.0, 3.0}) {
            s.box({float(x), 1, -2}, {0.2f, 1, 0.2f});
            s.lamp(lamp, {x, 5, -3}, glm::angleAxis(float(-kPi / 2), glm::vec3(1, 0, 0)));
        }
        lamp.kind = scene::Lamp::Kind::Spot, lamp.outer_cone = 0.9f;
        s.lamp(lamp, {1, 6, 2}, glm::angleAxis(float(-kPi / 2), glm::vec3(1, 0, 0)));
        box = s.box({0, 0, 0}, {0.6f, 0.4f, 0.3f});
        carrier = s.box({0, 0, 0}, {0.3f, 0.3f, 0.3f});
        lamp.intensity = 300;
        const uint32_t node = s.lamp(lamp, {0, 0.2, -0.4});
        s.scene().nodes[node].parent = carrier;
    }
    void place(gpu_scene::SceneFrame& poses, double x) {
        poses.world[box] = glm::translate(glm::dmat4(1), glm::dvec3(x, 1.5, 0.3));
        poses.world[carrier] = glm::translate(glm::dmat4(1), glm::dvec3(-x, 0.8, 3));
        poses.world.back() = poses.world[carrier] * glm::translate(glm::dmat4(1), glm::dvec3(0, 0.2, -0.4));
        poses.moving.assign(poses.world.size(), false);
        poses.moving[box] = poses.moving[carrier] = poses.moving.back() = true;
    }
    static gpu_scene::View view() { return view_of_the_ground(160, 14); }
};

size_t different(const Lit::Picture& a, const Lit::Picture& b) {
    size_t pixels = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) pixels += a.pixels[i] == b.pixels[i] ? 0 : 1;
    return pixels;
}

// Whatever was drawn before: maps over which something moved hold what maps hold that are drawn anew.
TEST(MovingShadows, WhatMovesIsDrawnOverWhatStandsStill) {
    PassRig rig;
    Traffic street;
    Lit all(rig, street.s.scene());
    std::optional<Lit::Picture> before;
    for (const double x : {-2.0, -1.9, 2.5, 0.1, 0.1}) {
        SCOPED_TRACE("at " + std::to_string(x));
        street.place(all.poses, x);
        const Lit::Picture now = all.render(Traffic::view());
        EXPECT_EQ(all.maps.report().lamps, 5u);
        if (before) {
            EXPECT_LE(all.maps.report().maps, 1u);  // that of the lamp that moves
            EXPECT_EQ(all.maps.report().bodies > 0, now.pixels != before->pixels);
        }
        Lit anew(rig, street.s.scene());
        street.place(anew.poses, x);
        EXPECT_EQ(different(now, anew.render(Traffic::view())), 0u);
        Lit still(rig, street.s.scene());  // but for the lamp, what is not known to move is drawn with the rest
        still.poses.world = anew.poses.world;
        still.poses.moving.assign(still.poses.world.size(), false);
        still.poses.moving.back() = true;
        EXPECT_EQ(different(now, still.render(Traffic::view())), 0u);
        if (before && x == 0.1) {
            before = now;
            continue;
        }
        if (before) {
            EXPECT_GT(different(now, *before), 100u);
        }
        before = now;
    }
    EXPECT_EQ(all.maps.report().maps + all.maps.report().bodies, 0u) << "at the end nothing has moved";
    EXPECT_EQ(rig.complaints(), "");
}

// The map of a lamp that moves holds what hides it from the view that it is drawn for. Other views of the same moment,
// and a view that moves on while nothing else does, see as much as if all were drawn.
TEST(MovingShadows, ALampThatMovesIsHiddenFromEachView) {
    PassRig rig;
    Traffic street;
    Lit all(rig, street.s.scene());
    const auto aside = [](double x, double z) {  // at a quarter of the ground
        gpu_scene::View view = view_of_the_ground(96, 5);
        view.world_to_view = view.world_to_view * glm::translate(glm::dmat4(1), glm::dvec3(-x, 0, -z));
        return view;
    };
    size_t of_one = 0;
    for (const double x : {-2.0, -1.9, 2.5, 2.4, 0.1, 0.1}) {
        SCOPED_TRACE("at " + std::to_string(x));
        street.place(all.poses, x);
        std::vector<gpu_scene::View> views{aside(-2, 3)};
        if (x > 2.45) views.push_back(aside(3, -2));
        if (x == 0.1) views = {of_one++ == 0 ? aside(2, 4) : aside(-2, -3)};
        for (const gpu_scene::View& view : views) {
            Lit anew(rig, street.s.scene());
            street.place(anew.poses, x);
            EXPECT_EQ(different(all.render(view), anew.render(view)), 0u);
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Casters that hide a dimmed lamp hide it when it shines again, though nothing has moved.
TEST(MovingShadows, ALampThatMovesIsHiddenHoweverItIsDimmed) {
    PassRig rig;
    Traffic street;
    Lit all(rig, street.s.scene());
    street.place(all.poses, -2);
    all.poses.dimming.assign(all.poses.world.size(), 1);
    for (const float dimmed : {1e-5f, 1.0f}) {
        all.poses.dimming.back() = dimmed;
        Lit anew(rig, street.s.scene());
        anew.poses = all.poses;
        EXPECT_EQ(different(all.render(Traffic::view()), anew.render(Traffic::view())), 0u) << dimmed;
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::moving_shadows_test
