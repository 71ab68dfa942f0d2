// Shadow maps from the cache: the same texels, and never those of something else.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "support/lit.h"
#include "support/occluders.h"

namespace vesper::test::shadow_cache_test {
namespace {

/// A cache in memory.
struct Kept : Cache {
    std::map<Digest::Value, std::vector<std::byte>> maps;
    size_t room = ~size_t{0};  // maps
    std::string problem;

    uint64_t bytes(const Digest::Value& key) override {
        const auto found = maps.find(key);
        return found == maps.end() ? 0 : found->second.size();
    }
    bool read(const Digest::Value& key, std::span<std::byte> bytes) override {
        const auto found = maps.find(key);
        if (found == maps.end() || found->second.size() != bytes.size()) {
            std::ranges::fill(bytes, std::byte(0x55));
            return false;
        }
        std::ranges::copy(found->second, bytes.begin());
        return true;
    }
    bool writes() const override { return maps.size() < room; }
    void write(const Digest::Value& key, std::span<const std::byte> bytes) override {
        if (!writes()) return;
        maps[key].assign(bytes.begin(), bytes.end());
        if (!writes()) problem = "there is no more room";
    }
    std::string settle() override { return std::exchange(problem, ""); }
};

constexpr uint32_t kStanding = 4;  // lamps

/// Lamps over posts and a leafy hedge; a box with a lamp that may move.
struct Street {
    OccluderScene s;
    uint32_t post = 0, box = 0, first_lamp = 0;
    Street() {
        scene::Scene& scene = s.scene();
        scene.images.push_back({"leaves", 4, 4, std::vector<uint8_t>(64, 255)});
        for (size_t i = 3; i < 64; i += 8) scene.images[0].rgba[i] = 0;
        scene::Material& leaves = scene.materials.emplace_back(scene.materials[0]);
        leaves.alpha = scene::Material::Alpha::Mask, leaves.base_colour_texture.image = 0;
        s.plate({0, 0, 0}, {20, 0, 0}, {0, 0, -20});
        s.plate({0, 1, 1}, {3, 0, 0}, {0, 0.8f, 0});
        scene.meshes.back().primitives[0].material = 1;
        post = s.box({1, 1, -2}, {0.2f, 1, 0.2f});
        box = s.box({0, 0, 0}, {0.6f, 0.4f, 0.3f});
        const glm::quat down = glm::angleAxis(float(-kPi / 2), glm::vec3(1, 0, 0));
        scene::Lamp lamp;
        lamp.intensity = 1000;
        first_lamp = s.lamp(lamp, {-3, 5, -3}, down);
        s.lamp(lamp, {0, 5, -3}, down);
        s.lamp(lamp, {3, 5, -3}, down);
        lamp.kind = scene::Lamp::Kind::Spot, lamp.outer_cone = 0.9f;
        s.lamp(lamp, {1, 6, 2}, down);
        lamp.intensity = 300;
        scene.nodes[s.lamp(lamp, {0, 0.2, -0.4})].parent = box;
    }
};

gpu_scene::View view(double width = 14) { return view_of_the_ground(160, width); }

/// Places the box and its lamp, which move.
void drive(gpu_scene::SceneFrame& poses, const Street& street, double x) {
    poses.world[street.box] = glm::translate(glm::dmat4(1), glm::dvec3(x, 1.5, 0.3));
    poses.world.back() = poses.world[street.box] * glm::translate(glm::dmat4(1), glm::dvec3(0, 0.2, -0.4));
    poses.moving.assign(poses.world.size(), false);
    poses.moving[street.box] = poses.moving.back() = true;
}

void expect_same(const Lit::Picture& a, const Lit::Picture& b) {
    size_t different = 0, lit = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        different += a.pixels[i] == b.pixels[i] ? 0 : 1;
        lit += a.pixels[i].y > 0 ? 1 : 0;
    }
    EXPECT_EQ(different, 0u);
    EXPECT_GT(lit, 10000u);
}

TEST(MapCache, ComesBackToTheLastBit) {
    PassRig rig;
    Street street;
    const auto render = [&](Kept* kept, uint32_t found) {
        Lit lit(rig, street.s.scene());
        lit.maps.use(kept);
        Lit::Picture p = lit.render(view());
        EXPECT_EQ(lit.maps.report().cached, found);
        EXPECT_EQ(lit.maps.report().maps, kStanding + 1 - found);
        EXPECT_EQ(p.note, "");
        lit.maps.plan(p.list, lit.poses, view(), 0);
        EXPECT_EQ(lit.maps.report().maps + lit.maps.report().cached, 0u) << "all are drawn";
        return p;
    };
    const Lit::Picture off = render(nullptr, 0);
    Kept kept;
    expect_same(render(&kept, 0), off);
    ASSERT_EQ(kept.maps.size(), kStanding + 1u);
    expect_same(render(&kept, kStanding + 1), off);
    // Where some are missing, others are drawn as if all were.
    for (uint32_t lost = 1; lost <= kStanding; ++lost) {
        Kept part = kept;
        part.maps.erase(part.maps.begin(), std::next(part.maps.begin(), lost));
        expect_same(render(&part, kStanding + 1 - lost), off);
        EXPECT_EQ(part.maps, kept.maps);
    }
    // What is read is what is seen: lamps with nothing around them.
    for (auto& [key, texels] : kept.maps) std::ranges::fill(texels, std::byte(0x7b));
    const Lit::Picture open = render(&kept, kStanding + 1);
    EXPECT_EQ(open.pairs.dark + open.pairs.mixed, 0u);
    EXPECT_GT(off.pairs.dark + off.pairs.mixed, 100u);
    EXPECT_EQ(rig.complaints(), "");
}

// Nothing that moves is in what is kept, and lamps that move keep nothing.
TEST(MapCache, KeepsWhatStandsStill) {
    PassRig rig;
    Street street;
    Kept kept;
    for (const double x : {-2.0, 2.5, 2.5}) {
        SCOPED_TRACE("at " + std::to_string(x));
        Lit off(rig, street.s.scene()), lit(rig, street.s.scene());
        lit.maps.use(&kept);
        drive(off.poses, street, x), drive(lit.poses, street, x);
        const bool cold = kept.maps.empty();
        expect_same(lit.render(view()), off.render(view()));
        EXPECT_GT(off.maps.report().bodies, 0u);
        EXPECT_EQ(lit.maps.report().cached, cold ? 0 : kStanding);
        EXPECT_EQ(kept.maps.size(), kStanding);
        drive(off.poses, street, x + 0.1), drive(lit.poses, street, x + 0.1);
        expect_same(lit.render(view()), off.render(view()));
        EXPECT_EQ(lit.maps.report().cached, 0u);
        EXPECT_EQ(kept.maps.size(), kStanding);
    }
    // What stood still begins to move: the maps that held it hold it no more.
    Lit off(rig, street.s.scene()), lit(rig, street.s.scene());
    lit.maps.use(&kept);
    off.render(view()), lit.render(view());
    EXPECT_EQ(lit.maps.report().cached, 0u) << "the box is among what stands still";
    drive(off.poses, street, -1), drive(lit.poses, street, -1);
    expect_same(lit.render(view()), off.render(view()));
    EXPECT_EQ(lit.maps.report().cached, kStanding);
    EXPECT_EQ(rig.complaints(), "");
}

using Change = std::function<void(Street&, gpu_scene::SceneFrame&)>;

/// How many maps of the street are found after a change.
uint32_t found_after(const Change& change, double width = 14) {
    PassRig rig;
    Street street;
    Kept kept;
    Lit before(rig, street.s.scene());
    before.maps.use(&kept);
    before.render(view());
    gpu_scene::SceneFrame none;
    change(street, none);
    Lit off(rig, street.s.scene()), lit(rig, street.s.scene());
    change(street, off.poses), change(street, lit.poses);
    lit.maps.use(&kept);
    expect_same(lit.render(view(width)), off.render(view(width)));
    EXPECT_EQ(rig.complaints(), "");
    return lit.maps.report().cached;
}

/// A change of the scene alone, made once.
Change scene_change(const std::function<void(scene::Scene&, const Street&)>& change) {
    return [change, done = false](Street& street, gpu_scene::SceneFrame&) mutable {
        if (!std::exchange(done, true)) change(street.s.scene(), street);
    };
}

TEST(MapCache, IsForNothingElse) {
    constexpr uint32_t kAll = kStanding + 1;
    const auto vertex = [](scene::Scene& s) -> scene::Vertex& { return s.meshes[2].primitives[0].vertices[0]; };
    const std::tuple<const char*, Change, uint32_t> changes[]{
        {"nothing", scene_change([](auto&, auto&) {}), kAll},
        {"vertex", scene_change([&](auto& s, auto&) { vertex(s).position.x += 1e-3f; }), 0},
        {"cutoff", scene_change([](auto& s, auto&) { s.materials[1].alpha_cutoff = 0.4f; }), 0},
        {"mask", scene_change([](auto& s, auto&) { s.images[0].rgba[7] = 0; }), 0},
        {"placement",
         [](Street& street, gpu_scene::SceneFrame& poses) {
             if (!poses.world.empty()) poses.world[street.post][3].x = 0.01;
         },
         0},
        {"lamp", scene_change([](auto& s, auto& street) { s.nodes[street.first_lamp].translation.x += 0.01; }),
         kAll - 1},
        {"axis", scene_change([](auto& s, auto& street) {
             s.nodes[street.first_lamp].rotation = {1, 0, 0, 0};
         }),
         kAll - 1},
        {"range", scene_change([](auto& s, auto&) { s.lamps[0].intensity *= 1.01f; }), kAll - 1},
        {"cone", scene_change([](auto& s, auto&) { s.lamps[3].outer_cone = 0.91f; }), kAll - 1},
        {"order", scene_change([](auto& s, auto&) { s.lamps[0].kind = scene::Lamp::Kind::CosinePower; }), kAll - 1},
        {"fixture", scene_change([](auto& s, auto& street) { s.nodes[street.first_lamp].fixture = street.post; }),
         kAll - 1},
        {"colour", scene_change([](auto& s, auto&) {
             s.lamps[0].colour = {0.9f, 1, 1.2f}, s.materials[0].base_colour = glm::vec4(0.4f, 0.5f, 0.6f, 1);
             s.images[0].rgba[0] = 7;
         }),
         kAll},
        {"opening", scene_change([](auto& s, auto&) { s.lamps[0].opening.length = s.lamps[0].opening.width = 0.2f; }),
         kAll},
        {"dimming", [](Street&, gpu_scene::SceneFrame& poses) { poses.dimming.assign(poses.world.size(), 0.5f); },
         kAll},
    };
    for (const auto& [name, change, found] : changes) {
        SCOPED_TRACE(name);
        EXPECT_EQ(found_after(change), found);
    }
}

// What moves tells which placements a map holds, also where all have one pose.
TEST(MapCache, KnowsWhatMoves) {
    PassRig rig;
    Street street;
    Kept kept;
    for (const uint32_t moving : {street.box, street.post}) {
        Lit off(rig, street.s.scene()), lit(rig, street.s.scene());
        lit.maps.use(&kept);
        for (gpu_scene::SceneFrame* poses : {&off.poses, &lit.poses}) {
            poses->moving.assign(poses->world.size(), false);
            poses->moving[moving] = true;
        }
        expect_same(lit.render(view()), off.render(view()));
        EXPECT_EQ(lit.maps.report().cached, 0u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Without one of them the maps of other lamps are the same.
TEST(MapCache, IsForAnySetOfLamps) {
    PassRig rig;
    Street street;
    Kept kept;
    Lit all(rig, street.s.scene());
    all.maps.use(&kept);
    all.render(view());
    uint32_t found = 0;
    for (uint32_t lamp = street.first_lamp; lamp < street.first_lamp + kStanding; ++lamp) {
        Lit off(rig, street.s.scene()), lit(rig, street.s.scene());
        lit.maps.use(&kept);
        for (gpu_scene::SceneFrame* poses : {&off.poses, &lit.poses}) {
            poses->dimming.assign(poses->world.size(), 1);
            poses->dimming[lamp] = 0;
        }
        expect_same(lit.render(view()), off.render(view()));
        EXPECT_EQ(lit.maps.report().lamps, kStanding);
        found += lit.maps.report().cached;
    }
    EXPECT_EQ(found, kStanding * kStanding);
    EXPECT_EQ(rig.complaints(), "");
}

// Maps of other sides are others.
TEST(MapCache, HasAMapForEachSide) {
    PassRig rig;
    Street street;
    Kept kept;
    Lit lit(rig, street.s.scene());
    lit.maps.use(&kept);
    const auto from = [&](double height) {
        gpu_scene::View seen = view();
        seen.world_to_view = seen.world_to_view * glm::translate(glm::dmat4(1), glm::dvec3(0, 20 - height, 0));
        lit.render(seen);
        return std::pair(lit.maps.report().maps, lit.maps.report().cached);
    };
    EXPECT_EQ(from(20), std::pair(kStanding + 1, 0u));
    EXPECT_EQ(from(300), std::pair(kStanding + 1, 0u));
    EXPECT_EQ(from(20), std::pair(0u, kStanding + 1));
    EXPECT_EQ(kept.maps.size(), 2 * kStanding + 2);
    EXPECT_EQ(rig.complaints(), "");
}

// A cache that fails changes nothing but what is said, once.
TEST(MapCache, MayFail) {
    PassRig rig;
    Street street;
    Lit off(rig, street.s.scene());
    const Lit::Picture expected = off.render(view());
    Kept kept;
    kept.room = 2;
    for (const bool first : {true, false}) {
        Lit lit(rig, street.s.scene());
        lit.maps.use(&kept);
        const Lit::Picture p = lit.render(view());
        expect_same(p, expected);
        EXPECT_EQ(p.note, first ? "there is no more room" : "");
        EXPECT_EQ(lit.maps.report().cached, first ? 0u : 2u);
        EXPECT_EQ(kept.maps.size(), 2u);
        EXPECT_EQ(lit.render(view()).note, "");
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::shadow_cache_test
