// Rays against closed forms, against the tests' own caster in double, and through triangles that are none.
// SPDX-License-Identifier: MIT
#include "rays/ray_caster.h"

#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "base/budget.h"
#include "base/error.h"
#include "places.h"
#include "scene/read_scene.h"
#include "support/occluders.h"
#include "support/ray_caster.h"

namespace vesper::test::ray_caster_test {
namespace {

using glm::dvec3, glm::vec3, rays::RayCaster;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A scene and the rays through it.
struct Cast {
    explicit Cast(scene::Scene& made) : scene(made), world(scene::world_transforms(scene, 0)), rays(scene, world) {}
    scene::Scene& scene;
    std::vector<glm::dmat4> world;
    RayCaster rays;
};

/// A mesh of single triangles at a node of its own.
void add_triangles(scene::Scene& scene, const std::vector<std::array<vec3, 3>>& triangles) {
    scene::Primitive& p = scene.meshes.emplace_back().primitives.emplace_back();
    for (const std::array<vec3, 3>& triangle : triangles)
        for (const vec3& corner : triangle) {
            p.indices.push_back(uint32_t(p.vertices.size()));
            p.vertices.emplace_back().position = corner;
            p.bounds.add(corner);
        }
    scene.nodes.emplace_back().mesh = uint32_t(scene.meshes.size() - 1);
}

scene::Scene scene_of(const std::vector<std::array<vec3, 3>>& triangles) {
    scene::Scene scene;
    scene.materials.emplace_back();
    add_triangles(scene, triangles);
    return scene;
}

TEST(RayCaster, MeetsATriangleWhereTheFormulaSays) {
    scene::Scene scene = scene_of({{vec3(0, 0, 0), {4, 0, 0}, {0, 8, 0}}});
    scene.nodes[0].translation = {10, 20, 30};
    const Cast cast(scene);
    const auto hit = cast.rays.nearest({11, 22, 34}, {11, 22, 24});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->share, 0.4, 1e-15);
    EXPECT_EQ(hit->node, 0u);
    EXPECT_EQ(hit->triangle, 0u);
    EXPECT_NEAR(hit->weights.x, 0.5, 1e-15);
    EXPECT_NEAR(hit->weights.y, 0.25, 1e-15);
    EXPECT_NEAR(hit->weights.z, 0.25, 1e-15);
    EXPECT_TRUE(cast.rays.blocked({11, 22, 24}, {11, 22, 34})) << "from behind, too";
    EXPECT_FALSE(cast.rays.blocked({14.01, 20, 34}, {14.01, 20, 24})) << "beside it";
    EXPECT_FALSE(cast.rays.blocked({11, 22, 34}, {11, 22, 30.001})) << "short of it";
    EXPECT_FALSE(cast.rays.blocked({11, 22, 34}, {11, 22, 30})) << "its end lies on it";
    EXPECT_FALSE(cast.rays.blocked({11, 22, 30}, {11, 22, 24})) << "its start lies on it";
    EXPECT_FALSE(cast.rays.blocked({0, 22, 30}, {40, 22, 30})) << "within its plane";
    EXPECT_FALSE(cast.rays.blocked({11, 22, 30}, {11, 22, 30})) << "no way";
}

TEST(RayCaster, NamesNodePrimitiveAndTriangle) {
    OccluderScene made;
    made.plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const uint32_t box = made.box({0, 0, 5}, {1, 1, 1});
    scene::Scene& scene = made.scene();
    scene.meshes[1].primitives.push_back(scene.meshes[0].primitives[0]);  // a plate amid the box
    const Cast cast(scene);
    EXPECT_EQ(cast.rays.triangles(), 16u);
    const auto front = cast.rays.nearest({0.5, -0.25, 9}, {0.5, -0.25, -9});
    ASSERT_TRUE(front);
    EXPECT_EQ(front->node, box);
    EXPECT_EQ(front->primitive, 0u);
    EXPECT_NEAR(front->share, 3.0 / 18, 1e-12);
    const scene::Primitive& side = scene.meshes[1].primitives[0];
    dvec3 place(0);
    for (int k = 0; k < 3; ++k)
        place += front->weights[k] * dvec3(side.vertices[side.indices[3 * front->triangle + uint32_t(k)]].position);
    EXPECT_NEAR(glm::distance(place, dvec3(0.5, -0.25, 6)), 0, 1e-12);
    const auto inner = cast.rays.nearest({0.5, -0.25, 5.5}, {0.5, -0.25, 3.5});
    ASSERT_FALSE(inner && inner->primitive == 1) << "the plate of the box is at 0, not at its middle";
}

TEST(RayCaster, LeavesOutTheNodesThatItIsTold) {
    OccluderScene made;
    std::vector<uint32_t> plates;
    for (int i = 0; i < 6; ++i) plates.push_back(made.plate({0, 0, i}, {1, 0, 0}, {0, 1, 0}));
    const Cast cast(made.scene());
    const dvec3 from(0.3, 0.1, 9), to(0.3, 0.1, -9);
    const uint32_t some[] = {plates[2], plates[4], plates[5]};
    EXPECT_EQ(cast.rays.nearest(from, to)->node, plates[5]);
    EXPECT_EQ(cast.rays.nearest(from, to, some)->node, plates[3]);
    EXPECT_TRUE(cast.rays.blocked(from, to, some));
    EXPECT_FALSE(cast.rays.blocked(from, to, plates));
    EXPECT_FALSE(cast.rays.nearest(from, to, plates));
}

/// Heights of 40 x 40 points, joined by triangles: no ray from above to below passes.
scene::Scene bumpy_ground(std::mt19937& random) {
    constexpr int kSide = 40;
    std::uniform_real_distribution<float> height(-0.5f, 0.5f);
    scene::Scene scene;
    scene.materials.emplace_back();
    scene::Primitive& p = scene.meshes.emplace_back().primitives.emplace_back();
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            p.vertices.emplace_back().position = {0.37f * float(x) + 0.3f * height(random), height(random),
                                                  0.41f * float(y) + 0.3f * height(random)};
    for (uint32_t y = 0; y + 1 < kSide; ++y)
        for (uint32_t x = 0; x + 1 < kSide; ++x) {
            const uint32_t a = y * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
            for (const uint32_t i : {a, b, d, a, d, c}) p.indices.push_back(i);
        }
    scene.nodes.emplace_back().mesh = 0;
    return scene;
}

// Through corners and edges that triangles share, at all angles. A caster that judges each triangle for itself lets
// some of these rays pass.
TEST(RayCaster, NothingPassesBetweenTrianglesThatShareAnEdge) {
    std::mt19937 random(7);
    scene::Scene scene = bumpy_ground(random);
    const Cast cast(scene);
    const std::vector<scene::Vertex>& v = scene.meshes[0].primitives[0].vertices;
    std::uniform_real_distribution<double> share(0, 1);
    int passed = 0;
    for (int i = 0; i < 40000; ++i) {
        const uint32_t x = 4 + random() % 32, y = 4 + random() % 32, a = y * 40 + x;
        const uint32_t b = a + (i % 3 == 0 ? 1 : i % 3 == 1 ? 40 : 41);
        const double s = i % 4 == 0 ? 0 : share(random);
        const dvec3 through = glm::mix(dvec3(v[a].position), dvec3(v[b].position), s);
        const dvec3 way(share(random) - 0.5, 2 + share(random), share(random) - 0.5);
        if (!cast.rays.blocked(through + way, through - way)) ++passed;
    }
    EXPECT_EQ(passed, 0);
}

/// Triangles whose corners are multiples of 1/64: from any of them as origin they are exact as floats.
std::vector<std::array<vec3, 3>> soup(std::mt19937& random, int count) {
    std::uniform_int_distribution<int> place(-640, 640), size(-96, 96);
    std::vector<std::array<vec3, 3>> triangles;
    for (int i = 0; i < count; ++i) {
        const vec3 at(place(random), place(random), place(random));
        std::array<vec3, 3> triangle;
        for (vec3& corner : triangle) corner = (at + vec3(size(random), size(random), size(random))) / 64.0f;
        triangles.push_back(triangle);
    }
    return triangles;
}

TEST(RayCaster, AgreesWithTheReferenceOnTrianglesAtRandom) {
    std::mt19937 random(3);
    for (const int count : {1, 2, 4, 5, 7, 63, 3000}) {
        scene::Scene scene = scene_of(soup(random, count));
        const Cast cast(scene);
        const test::RayCaster reference(scene, cast.world);
        std::uniform_real_distribution<double> at(-13, 13);
        int met = 0;
        for (int i = 0; i < 5000; ++i) {
            const dvec3 a(at(random), at(random), at(random));
            const dvec3 b = count > 10 ? dvec3(at(random), at(random), at(random)) : 2.0 * -a;
            const double expected = reference.hit(a, b, 0, 1, [](uint32_t) { return true; });
            const auto hit = cast.rays.nearest(a, b);
            ASSERT_EQ(hit.has_value(), expected < 1) << count << " triangles, ray " << i;
            ASSERT_EQ(cast.rays.blocked(a, b), expected < 1) << count << " triangles, ray " << i;
            if (!hit) continue;
            ++met;
            EXPECT_NEAR(hit->share, expected, 1e-11);
            EXPECT_NEAR(hit->weights.x + hit->weights.y + hit->weights.z, 1, 1e-12);
        }
        EXPECT_GT(met, count == 3000 ? 2000 : 0);
    }
}

// Rays along the axes have no inverse direction, and meet boxes of no thickness.
TEST(RayCaster, MeetsPlatesAlongTheAxes) {
    OccluderScene made;
    for (int i = 0; i < 50; ++i) made.plate({3 * i, 0, 0}, {0, 1, 0}, {0, 0, 1});
    made.plate({75, 0, -1}, {100, 0, 0}, {0, 1, 0});
    const Cast cast(made.scene());
    for (const double y : {0.0, -1.0, 1.0, 0.999}) {
        for (int i = 0; i < 50; ++i) EXPECT_TRUE(cast.rays.blocked({3 * i - 1, y, 0}, {3 * i + 1, y, 0})) << i;
        for (int i = 0; i < 50; ++i) EXPECT_FALSE(cast.rays.blocked({3 * i + 1, y, 0}, {3 * i + 2, y, 0})) << i;
        EXPECT_TRUE(cast.rays.blocked({10, y, 4}, {10, y, -4}));
    }
    EXPECT_FALSE(cast.rays.blocked({-1, 1.001, 0}, {200, 1.001, 0}));
    EXPECT_NEAR(cast.rays.nearest({-1.5, 0.5, 0.5}, {1.5, 0.5, 0.5})->share, 0.5, 1e-12);
}

TEST(RayCaster, AgreesWithTheReferenceOnTheStreet) {
    scene::Scene scene = scene::read_scene(VESPER_SOURCE_DIR "/data/rivoli/rivoli.gltf").scene;
    for (scene::Material& m : scene.materials) m.base_colour_texture.nearest = true;  // as the reference looks at them
    const Cast cast(scene);
    EXPECT_GT(cast.rays.triangles(), 250'000u);
    EXPECT_LT(cast.rays.bytes(), RayCaster::kBytesPerTriangle * cast.rays.triangles());
    const test::RayCaster reference(scene, cast.world);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> x(-15, 15), y(0.05, 12), z(-150, 10);
    int differ = 0, met = 0;
    constexpr int kRays = 6000;
    for (int i = 0; i < kRays; ++i) {
        const dvec3 a(x(random), y(random), z(random)), b(x(random), y(random), z(random));
        const double expected = reference.hit(a, b, 0, 1, [](uint32_t) { return true; });
        const auto hit = cast.rays.nearest(a, b);
        EXPECT_EQ(cast.rays.blocked(a, b), hit.has_value());
        met += hit ? 1 : 0;
        // Corners are rounded to floats, so rays by an edge or the edge of a texel may differ.
        if (hit.has_value() != (expected < 1) || (hit && std::abs(hit->share - expected) > 1e-5)) ++differ;
    }
    EXPECT_LE(differ, kRays / 1000);
    EXPECT_GT(met, kRays / 4);
    EXPECT_LT(met, kRays * 19 / 20);
}

// As floats these starts and ends lie on the plate.
TEST(RayCaster, ComparesEndsWithSurfacesInDouble) {
    OccluderScene made;
    constexpr double wall = 3.125;
    made.plate({wall, 7, 0}, {0, 1, 0}, {0, 0, 1});
    for (int i = 0; i < 3; ++i) made.plate({-90, 0, 0}, {0, 1, 0}, {0, 0, 1});  // where the middle is
    const Cast cast(made.scene());
    EXPECT_EQ(cast.rays.middle().x, -90);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> at(-0.9, 0.9);
    int differ = 0;
    for (int i = 0; i < 2000; ++i) {
        const dvec3 away(wall + (i % 2 ? 1 : -1) * (1 + at(random)), 7 + at(random), at(random));
        const double by = away.x > wall ? -2e-8 : 2e-8;
        const dvec3 behind(wall + by, 7 + at(random), at(random)), before(wall - by, behind.y, behind.z);
        differ += !cast.rays.blocked(away, behind) || !cast.rays.blocked(behind, away);
        differ += cast.rays.blocked(away, before) || cast.rays.blocked(before, away);
        const auto hit = cast.rays.nearest(behind, away);
        differ += !hit || !(hit->share > 0 && hit->share < 1e-6);
    }
    EXPECT_EQ(differ, 0);
}

// Rays from afar are rounded by more than triangles are apart, and still meet what they meet exactly.
TEST(RayCaster, RoundingOfFarStartsIsInTheBoxes) {
    std::mt19937 random(7);
    scene::Scene scene = bumpy_ground(random);
    std::vector<scene::Vertex>& v = scene.meshes[0].primitives[0].vertices;
    for (scene::Vertex& vertex : v) vertex.position *= 0x1p-7f;  // 0.1 m by 0.1 m
    add_triangles(scene, {{vec3(4000, 0, 0), {4000, 1, 0}, {4000, 0, 1}}});
    const Cast cast(scene);
    std::uniform_real_distribution<double> share(0, 1);
    int passed = 0;
    for (int i = 0; i < 40000; ++i) {
        const uint32_t x = 4 + random() % 32, y = 4 + random() % 32, a = y * 40 + x;
        const uint32_t b = a + (i % 3 == 0 ? 1 : i % 3 == 1 ? 40 : 41);
        const dvec3 through = glm::mix(dvec3(v[a].position), dvec3(v[b].position), share(random));
        const dvec3 way(2000 * share(random), 3000 + 4000 * share(random), 2000 * share(random));
        if (!cast.rays.blocked(through + way, through - way)) ++passed;
    }
    EXPECT_EQ(passed, 0);
}

// Databases lie in coordinates of their country: 4 mm between floats there.
TEST(RayCaster, IsExactFarFromTheOrigin) {
    OccluderScene made;
    made.plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const dvec3 far(4.5e6, 200, -5.2e6);
    made.scene().nodes[0].translation = far;
    const Cast cast(made.scene());
    const auto hit = cast.rays.nearest(far + dvec3(0.25, 0.5, 1), far + dvec3(0.25, 0.5, -3));
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->share, 0.25, 1e-9);
    EXPECT_TRUE(cast.rays.blocked(far + dvec3(0.9999, 0, 1), far + dvec3(0.9999, 0, -1)));
    EXPECT_FALSE(cast.rays.blocked(far + dvec3(1.0001, 0, 1), far + dvec3(1.0001, 0, -1)));
}

TEST(RayCaster, BadTrianglesAreLeftOutAndHarmOthersNot) {
    const std::vector<std::array<vec3, 3>> good{{vec3(-1, -1, 0), {1, -1, 0}, {0, 1, 0}}};
    std::vector<std::array<vec3, 3>> all{{vec3(kNan, 0, 0), {1, 0, 0}, {0, 1, 0}},
                                         {vec3(1e30f, 0, 0), {1, 0, 0}, {0, 1, 0}},
                                         {vec3(0, 0, 0), {0, -3e38f, 3e38f}, {0, 3e38f, 3e38f}},
                                         {vec3(0, 0, 0), {0, 0, HUGE_VALF}, {0, 1, 0}},
                                         {vec3(1, 1, 1), {1, 1, 1}, {1, 1, 1}},
                                         {vec3(0, 0, 1), {1, 1, 1}, {2, 2, 1}}};
    all.insert(all.end(), good.begin(), good.end());
    scene::Scene scene = scene_of(all);
    const Cast cast(scene);
    EXPECT_EQ(cast.rays.triangles(), 1u);
    EXPECT_EQ(cast.rays.left_out(), 6u);
    const auto hit = cast.rays.nearest({0.1, 0.2, 1}, {0.1, 0.2, -1});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->triangle, 6u) << "numbers are those of the scene";
    EXPECT_NEAR(hit->share, 0.5, 1e-12);
    for (const double bad : {double(kNan), HUGE_VAL, 1e30, 1e300}) {
        EXPECT_FALSE(cast.rays.blocked({bad, 0, 1}, {0, 0, -1}));
        EXPECT_FALSE(cast.rays.nearest({0, 0, 1}, {0, -bad, -1}));
    }
    scene.nodes[0].matrix = glm::dmat4(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(Cast(scene).rays.triangles(), 0u);
}

TEST(RayCaster, OneTriangleFarAwayCostsOthersNoPrecision) {
    std::vector<std::array<vec3, 3>> all(50, {vec3(-1, -1, 0.001f), {1, -1, 0.001f}, {0, 1, 0.001f}});
    all.push_back({vec3(9e7f, 0, 0), {9e7f, 1e7f, 0}, {9e7f, 0, 1e7f}});
    scene::Scene scene = scene_of(all);
    const Cast cast(scene);
    EXPECT_EQ(cast.rays.triangles(), 51u);
    EXPECT_NEAR(cast.rays.nearest({0, 0, 1.001}, {0, 0, -0.999})->share, 0.5, 1e-8);
}

TEST(RayCaster, NoTrianglesBlockNothing) {
    scene::Scene empty;
    EXPECT_FALSE(Cast(empty).rays.blocked({0, 0, 1}, {0, 0, -1}));
    EXPECT_FALSE(RayCaster().nearest({0, 0, 1}, {0, 0, -1}));
    scene::Scene hollow;
    hollow.meshes.emplace_back();
    hollow.nodes.emplace_back().mesh = 0;
    EXPECT_FALSE(Cast(hollow).rays.blocked({0, 0, 1}, {0, 0, -1}));
}

// Sizes that double, and one place for all: input that boxes cannot part evenly.
TEST(RayCaster, HoldsTrianglesThatBoxesCannotPart) {
    std::vector<std::array<vec3, 3>> all;
    float size = 1e-12f;
    for (int i = 0; i < 20000; ++i) {
        if (i % 300 == 0) size = 1e-12f;
        size *= 1.15f;
        all.push_back({vec3(-size, -size, size), {size, -size, size}, {0, size, size}});
    }
    const std::array<vec3, 3> same{vec3(-50, -50, -5), {50, -50, -5}, {0, 50, -5}};
    all.insert(all.end(), 20000, same);
    scene::Scene scene = scene_of(all);
    const Cast cast(scene);
    EXPECT_EQ(cast.rays.triangles() + cast.rays.left_out(), 40000u);
    EXPECT_GT(cast.rays.triangles(), 30000u) << "those of 1e-12 m are points between floats";
    EXPECT_TRUE(cast.rays.blocked({0, 0, 1}, {0.001, 0, -1}));
    const auto hit = cast.rays.nearest({30, -40, -6}, {30, -40, -4});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->triangle, 20000u) << "the first of all that lie there";
    EXPECT_LT(cast.rays.bytes(), RayCaster::kBytesPerTriangle * cast.rays.triangles());
}

TEST(RayCaster, TakesNoMoreThanItsBudgetHas) {
    std::mt19937 random(5);
    scene::Scene few = scene_of(soup(random, 5)), many = scene_of(soup(random, 100));
    const Budget budget("testing");
    spend(budget.bytes_left - 50 * RayCaster::kBytesPerTriangle);
    EXPECT_EQ(Cast(few).rays.triangles(), 5u);
    EXPECT_THROW(Cast{many}, Error);
}

TEST(RayCaster, LeavesNoThreads) {
    const auto threads = [] {
        const std::filesystem::directory_iterator all("/proc/self/task");
        return std::distance(begin(all), end(all));
    };
    const auto before = threads();
    std::mt19937 random(5);
    scene::Scene scene = scene_of(soup(random, 50000));
    const Cast cast(scene);
    EXPECT_EQ(threads(), before);
}

TEST(RayCaster, TheSameSceneGivesTheSameAnswers) {
    std::mt19937 random(5);
    scene::Scene scene = scene_of(soup(random, 2000));
    const Cast one(scene), two(scene);
    std::uniform_real_distribution<double> at(-12, 12);
    for (int i = 0; i < 2000; ++i) {
        const dvec3 a(at(random), at(random), at(random)), b(at(random), at(random), at(random));
        const auto x = one.rays.nearest(a, b), y = two.rays.nearest(a, b);
        ASSERT_EQ(x.has_value(), y.has_value());
        if (!x) continue;
        EXPECT_EQ(x->share, y->share);
        EXPECT_EQ(x->triangle, y->triangle);
        EXPECT_EQ(x->weights, y->weights);
    }
    EXPECT_EQ(one.rays.bytes(), two.rays.bytes());
}

}  // namespace
}  // namespace vesper::test::ray_caster_test
