// Light transport against closed forms: rooms in which all light is known, sources over planes, and what is hidden.
// SPDX-License-Identifier: MIT
#include "transport/light_tracer.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/luminance.h"
#include "support/rooms.h"

namespace vesper::test::light_tracer_test {
namespace {

using glm::dvec3, glm::vec3, transport::Illuminance, transport::LightTracer, transport::Origin;

constexpr double kPi = std::numbers::pi;

/// The inside of a sphere about the origin, from a cube whose faces are split: its vertices lie on the sphere.
void add_sphere(scene::Scene& scene, uint32_t material, float radius, int splits) {
    scene::Primitive& p = scene.meshes.emplace_back().primitives.emplace_back();
    p.material = material;
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < splits; ++i)
            for (int j = 0; j < splits; ++j) {
                const auto corner = [&](int a, int b) {
                    const double u = std::tan((2.0 * a / splits - 1) * kPi / 4),
                                 v = std::tan((2.0 * b / splits - 1) * kPi / 4);
                    dvec3 d(1, u, v);
                    if (face % 2) d = dvec3(-1, v, u);
                    if (face / 2 == 1) d = dvec3(d.z, d.x, d.y);
                    if (face / 2 == 2) d = dvec3(d.y, d.z, d.x);
                    return vec3(glm::normalize(d) * double(radius));
                };
                const auto first = uint32_t(p.vertices.size());
                for (const auto& [a, b] : {std::pair{i, j}, {i, j + 1}, {i + 1, j + 1}, {i + 1, j}}) {
                    p.vertices.emplace_back().position = corner(a, b);
                    p.bounds.add(p.vertices.back().position);
                }
                for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + k);
            }
    scene.nodes.emplace_back().mesh = uint32_t(scene.meshes.size() - 1);
}

Illuminance traced(const scene::Scene& scene, dvec3 point, dvec3 normal, transport::TraceSettings settings = {}) {
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    return LightTracer(scene, world).at(point, normal, settings);
}

double lux(const Illuminance& light, Origin origin) { return luminance(light[origin]); }

// Within four standard errors, and these small enough that this says something.
void expect_light(const Illuminance& light, Origin origin, double want, double most_error) {
    const double error = light.standard_error[size_t(origin)];
    EXPECT_LE(error, most_error * want) << "of origin " << int(origin);
    EXPECT_NEAR(lux(light, origin), want, 4 * error + 1e-6 * want) << "of origin " << int(origin);
}

// All directions look alike, so that little is left to chance: where paths end, and how emitters are looked at.
TEST(LightTracer, ARoomThatGlowsHasTheGeometricSeries) {
    constexpr double kEmission = 5, kReflectance = 0.6;
    scene::Scene scene;
    add_room(scene, add_material(scene, float(kReflectance), float(kEmission)), {2, 1.5f, 4});
    const Illuminance light = traced(scene, {0.3, -1.5, 1}, {0, 1, 0});
    const double direct = kPi * kEmission;
    expect_light(light, Origin::Emitters, direct, 0.005);
    expect_light(light, Origin::Once, direct * kReflectance, 0.005);
    expect_light(light, Origin::More, direct * kReflectance * kReflectance / (1 - kReflectance), 0.015);
    EXPECT_EQ(lux(light, Origin::Lamps) + lux(light, Origin::Sky), 0);
}

// An integrating sphere: once reflected, light is the same everywhere, Phi rho / A; in all Phi rho / A / (1 - rho).
TEST(LightTracer, AnIntegratingSphereSpreadsALamp) {
    constexpr double kRadius = 2, kCandela = 300, kReflectance = 0.8;
    scene::Scene scene;
    add_sphere(scene, add_material(scene, float(kReflectance)), float(kRadius), 24);
    add_lamp(scene, float(kCandela), {0.7, 0.4, -0.2});
    const dvec3 up = glm::normalize(dvec3(0.2, 1, 0.1));
    const Illuminance light = traced(scene, -kRadius * 0.995 * up, up);
    const double spread = kCandela / (kRadius * kRadius) * kReflectance;  // 4 pi I / 4 pi r^2
    const dvec3 to = dvec3(0.7, 0.4, -0.2) + kRadius * 0.995 * up;
    EXPECT_NEAR(lux(light, Origin::Lamps), kCandela * glm::dot(to, up) / std::pow(glm::length(to), 3), 1e-6);
    // Its 24 x 24 flat quadrangles a face have 0.3 % less area than the sphere.
    EXPECT_NEAR(lux(light, Origin::Once), spread, 0.005 * spread + 4 * light.standard_error[size_t(Origin::Once)]);
    const double more = spread * kReflectance / (1 - kReflectance);
    EXPECT_NEAR(lux(light, Origin::More), more, 0.02 * more + 4 * light.standard_error[size_t(Origin::More)]);
    EXPECT_LE(light.standard_error[size_t(Origin::Once)], 0.01 * spread);
}

// A square of side 2 a, parallel at the distance h over its middle: E = 4 L atan(s) s, s = a / sqrt(a^2 + h^2)
// (the form factor of a corner, Lambert 1760).
TEST(LightTracer, AnEmittingSquareOverAPlane) {
    constexpr double kA = 1.5, kH = 2, kEmission = 100;
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0, float(kEmission)), {-1.5f, 2, -1.5f}, {3, 0, 0}, {0, 0, 3});
    const double s = kA / std::sqrt(kA * kA + kH * kH);
    expect_light(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Emitters, 4 * kEmission * s * std::atan(s), 0.01);
    EXPECT_EQ(lux(traced(scene, {0, 4, 0}, {0, -1, 0}), Origin::Emitters), 0) << "its back is dark";
    scene.materials[0].double_sided = true;
    expect_light(traced(scene, {0, 4, 0}, {0, -1, 0}), Origin::Emitters, 4 * kEmission * s * std::atan(s), 0.01);
}

TEST(LightTracer, AMirroredEmitterShinesToItsFront) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0, 100), {-1.5f, 2, -1.5f}, {3, 0, 0}, {0, 0, 3});
    scene.nodes[0].scale = {1, -1, 1};  // below the point now, and facing up
    EXPECT_GT(lux(traced(scene, {0, 0, 0}, {0, -1, 0}), Origin::Emitters), 100);
}

// A long wall hides half of the sky, and sends half of it on.
TEST(LightTracer, AWallHidesTheSkyBehindIt) {
    constexpr double kSky = 3, kReflectance = 0.5;
    scene::Scene scene;
    scene.sky_luminance = float(kSky);
    expect_light(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Sky, kPi * kSky, 1e-9);
    add_rectangle(scene, add_material(scene, float(kReflectance)), {-4e4f, 0, -1}, {8e4f, 0, 0}, {0, 4e4f, 0});
    const Illuminance light = traced(scene, {0, 0, 0}, {0, 1, 0});
    expect_light(light, Origin::Sky, 0.5 * kPi * kSky, 0.01);
    // The wall sees the whole of its sky, that under the horizon too.
    expect_light(light, Origin::Once, 0.5 * kPi * kSky * kReflectance, 0.01);
    EXPECT_EQ(lux(light, Origin::More), 0);
}

// Two plates, lit between: a lamp's light goes to and fro. Deep inside wide plates E of the lower one is known from the
// other: what reaches either of the light that the other sends is all of it.
TEST(LightTracer, ALampBetweenPlates) {
    constexpr float kWide = 3000;
    scene::Scene scene;
    const uint32_t grey = add_material(scene, 0.5f);
    add_rectangle(scene, grey, {-kWide, 0, -kWide}, {0, 0, 2 * kWide}, {2 * kWide, 0, 0});
    add_rectangle(scene, grey, {-kWide, 2, -kWide}, {2 * kWide, 0, 0}, {0, 0, 2 * kWide});
    scene::Lamp& sun = scene.lamps.emplace_back();  // between the plates nothing gets in but by the sides
    sun.kind = scene::Lamp::Kind::Directional, sun.intensity = 1000;
    scene::Node& node = scene.nodes.emplace_back();
    node.lamp = 0, node.fixture = scene::kNone;
    node.rotation = glm::angleAxis(float(-kPi / 2), vec3(1, 0, 0));  // down
    EXPECT_EQ(lux(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Lamps), 0) << "the upper plate hides it";
    EXPECT_NEAR(lux(traced(scene, {0, 2, 0}, {0, 1, 0}), Origin::Lamps), 1000, 1e-3) << "and has it";
    // A lamp of 100 cd halfway: the upper plate gets E(x) = 100 h / (h^2 + x^2)^1.5, h = 1, and sends rho E / pi down;
    // under the lamp that is the integral of 2 pi x (rho E / pi) H^2 / (H^2 + x^2)^2 over x, H = 2.
    add_lamp(scene, 100, {0, 1, 0});
    double once = 0;
    for (double x = 5e-4; x < 200; x += 1e-3)
        once += 1e-3 * 2 * x * 0.5 * 100 / std::pow(1 + x * x, 1.5) * 4 / ((4 + x * x) * (4 + x * x));
    const Illuminance light = traced(scene, {0, 0, 0}, {0, 1, 0});
    EXPECT_NEAR(lux(light, Origin::Lamps), 100, 1e-6);
    expect_light(light, Origin::Once, once, 0.01);
}

// What lamps and emitters send is what the walls take: E of each wall, at random places, times its share.
TEST(LightTracer, AClosedRoomTakesWhatItIsGiven) {
    constexpr double kReflectance = 0.7, kCandela = 200;
    scene::Scene scene;
    const vec3 half(2, 1, 3);
    add_room(scene, add_material(scene, float(kReflectance)), half);
    add_lamp(scene, float(kCandela), {0.8, 0.3, -1.1});
    add_rectangle(scene, add_material(scene, 0, 300), {0.5f, 0.98f, 1}, {0.4f, 0, 0}, {0, 0, 0.4f});  // down
    const double given = 4 * kPi * kCandela + kPi * 300 * 0.16;
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const LightTracer tracer(scene, world);
    double taken = 0;
    constexpr int kSide = 12;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1})
            for (int i = 0; i < kSide; ++i)
                for (int j = 0; j < kSide; ++j) {
                    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
                    dvec3 point(0), normal(0);
                    point[axis] = side * double(half[axis]), normal[axis] = -side;
                    point[b] = double(half[b]) * (2 * (i + 0.5) / kSide - 1);
                    point[c] = double(half[c]) * (2 * (j + 0.5) / kSide - 1);
                    const double area = 4 * double(half[b]) * double(half[c]) / (kSide * kSide);
                    const Illuminance light =
                        tracer.at(point, normal, {.paths = 128, .seed = uint64_t(i * kSide + j + 1)});
                    taken += (1 - kReflectance) * luminance(light.sum()) * area;
                }
    // The rule of middles adds 0.5 % where the lamp is nearest.
    EXPECT_NEAR(taken, given, 0.01 * given);
}

TEST(LightTracer, WhatIsReflectedNeverIsLeftOut) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.6f, 5), {2, 1.5f, 4});
    const Illuminance none = traced(scene, {0, -1.5, 0}, {0, 1, 0}, {.most_reflections = 0}),
                      one = traced(scene, {0, -1.5, 0}, {0, 1, 0}, {.most_reflections = 1});
    EXPECT_EQ(lux(none, Origin::Once) + lux(none, Origin::More) + lux(one, Origin::More), 0);
    expect_light(one, Origin::Once, kPi * 5 * 0.6, 0.005);
}

// A lamp's globe glows as it is seen; its light is that of the lamp.
TEST(LightTracer, GlobesOfLampsGiveNoLightTwice) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0, 100), {-1.5f, 2, -1.5f}, {3, 0, 0}, {0, 0, 3});
    add_lamp(scene, 40, {0, 2, 0});
    EXPECT_GT(lux(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Emitters), 100);
    scene.nodes[1].fixture = 0;
    EXPECT_EQ(lux(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Emitters), 0);
    EXPECT_NEAR(lux(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Lamps), 10, 1e-6);
}

TEST(LightTracer, TexturesGiveWhatTheyShow) {
    scene::Scene scene;
    scene.images.push_back({"half", 2, 1, {255, 255, 255, 255, 0, 0, 0, 255}});
    const uint32_t lit = add_material(scene, 0, 100);
    scene.materials[lit].emission_texture.image = 0, scene.materials[lit].emission_texture.nearest = true;
    add_rectangle(scene, lit, {-1.5f, 2, -1.5f}, {3, 0, 0}, {0, 0, 3});
    scene::Primitive& p = scene.meshes[0].primitives[0];
    for (scene::Vertex& vertex : p.vertices) vertex.uv = {(vertex.position.x + 1.5f) / 3, 0.5f};
    const double s = 1.5 / std::sqrt(1.5 * 1.5 + 4);
    expect_light(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Emitters, 2 * 100 * s * std::atan(s), 0.02);
}

// A square of side 3 and 100 cd/m^2 at 2 m over the point, which it gives 129.7 lx.
scene::Scene lit_by_a_square() {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0, 100), {-1.5f, 2, -1.5f}, {3, 0, 0}, {0, 0, 3});
    return scene;
}
double of_the_square() {
    const double s = 1.5 / std::sqrt(1.5 * 1.5 + 4);
    return 4 * 100 * s * std::atan(s);
}

TEST(LightTracer, PicturesOfLightCountAsTheyAre) {
    scene::Scene scene = lit_by_a_square();
    scene.luminance_pictures.push_back({"even", 1, 1, {0.25f, 0.25f, 0.25f}});
    scene.materials[0].emission_picture.image = 0;
    expect_light(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Emitters, 0.25 * of_the_square(), 0.01);
}

TEST(LightTracer, EmittersHaveTheHolesOfTheirMasks) {
    scene::Scene scene = lit_by_a_square();
    scene.materials[0].alpha = scene::Material::Alpha::Mask;
    scene.materials[0].base_colour.a = 0;
    EXPECT_EQ(lux(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Emitters), 0);
}

TEST(LightTracer, AFlatNodeKeepsItsFront) {
    scene::Scene scene = lit_by_a_square();
    scene.meshes[0].primitives[0].vertices[0].position.y = 2;
    scene.nodes[0].scale = {1, 0, 1};
    scene.nodes[0].translation = {0, 2, 0};
    expect_light(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Emitters, of_the_square(), 0.01);
}

// Corners are floats; a surface far from the middle of the scene must not hide itself.
TEST(LightTracer, FarFromTheMiddleNothingHidesItself) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f, 5), {2, 1.5f, 4});
    for (scene::Node& node : scene.nodes) node.translation = {8000.3, 0, 8000.3};
    add_rectangle(scene, 0, {-8010, 0, -8010}, {1, 0, 0}, {0, 0, 1});  // so that the middle is elsewhere
    const Illuminance light = traced(scene, {8000.3, -1.5, 8001}, {0, 1, 0});
    expect_light(light, Origin::Emitters, kPi * 5, 0.005);
    expect_light(light, Origin::Once, kPi * 5 * 0.5, 0.01);
}

// What a lamp's fixture reflects is in the lamp's intensities.
TEST(LightTracer, AFixtureReflectsNoLightOfItsLamp) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0.8f), {-0.3f, 2.1f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f});
    add_lamp(scene, 1000, {0, 2, 0});
    EXPECT_GT(lux(traced(scene, {3, 0, 0}, {0, 1, 0}), Origin::Once), 5);
    scene.nodes[1].fixture = 0;
    EXPECT_EQ(lux(traced(scene, {3, 0, 0}, {0, 1, 0}), Origin::Once), 0);
}

// Paths that go by chance would seldom meet it.
TEST(LightTracer, ASmallEmitterIsSeenInReflectionsToo) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0.5f), {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
    add_rectangle(scene, add_material(scene, 0, 1e5f), {-0.05f, 3, -0.05f}, {0.1f, 0, 0}, {0, 0, 0.1f});
    // From above, the floor under it: L rho / pi of E = 1e5 0.01 h^4 / (h^2 + r^2)^2 / h^2 at r, seen from 1 m over it.
    double once = 0;
    for (double x = -20; x < 20; x += 0.02)
        for (double z = -20; z < 20; z += 0.02) {
            const double r2 = x * x + z * z, e = 1e3 * 9 / ((9 + r2) * (9 + r2)), to2 = x * x + (z - 5) * (z - 5) + 1;
            once += 0.02 * 0.02 * e * 0.5 / kPi / (to2 * to2);
        }
    expect_light(traced(scene, {0, 1, 5}, {0, -1, 0}), Origin::Once, once, 0.03);
}

// A floor with a texture of code 188, half of white, under an even sky; and a lamp's light of colours.
TEST(LightTracer, ReflectanceIsThatOfTexturesAndVertices) {
    scene::Scene scene;
    scene.sky_luminance = 10;
    scene.images.push_back({"grey", 1, 1, {188, 188, 188, 255}});
    const uint32_t grey = add_material(scene, 1);
    scene.materials[grey].base_colour_texture.image = 0;
    add_rectangle(scene, grey, {-4e4f, 0, -4e4f}, {0, 0, 8e4f}, {8e4f, 0, 0});
    const double half = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    expect_light(traced(scene, {0, 1, 0}, {0, -1, 0}), Origin::Once, kPi * 10 * half, 0.01);
    scene.transfer = {.kind = scene::Transfer::Kind::Gamma, .gamma = 2.2f};
    const double by_gamma = std::pow(188 / 255.0, 2.2);
    expect_light(traced(scene, {0, 1, 0}, {0, -1, 0}), Origin::Once, kPi * 10 * by_gamma, 0.01);
    for (scene::Vertex& vertex : scene.meshes[0].primitives[0].vertices) vertex.colour = {65535, 0, 0, 65535};
    const Illuminance red = traced(scene, {0, 1, 0}, {0, -1, 0});
    EXPECT_NEAR(red[Origin::Once].r, kPi * 10 * by_gamma, 0.05);
    EXPECT_EQ(red[Origin::Once].g, 0);
}

TEST(LightTracer, ASkyWithAPictureIsThatPicture) {
    scene::Scene scene;
    scene.environment = photometry::Environment{.width = 64, .height = 32, .rgb = std::vector<float>(64 * 32 * 3, 0)};
    for (size_t i = 0; i < 64 * 16 * 3; ++i) scene.environment->rgb[i] = 7;  // above the horizon
    const double want = luminance(photometry::irradiance(*scene.environment, {0, 1, 0}));
    EXPECT_NEAR(lux(traced(scene, {0, 0, 0}, {0, 1, 0}), Origin::Sky), want, 0.01 * want) << "a row is bilinear";
    EXPECT_LT(lux(traced(scene, {0, 0, 0}, {0, -1, 0}), Origin::Sky), 0.01 * want);
}

TEST(LightTracer, TheErrorOfTheSumIsThatOfWholePaths) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.6f, 5), {2, 1.5f, 4});
    double sum = 0, squares = 0, stated = 0;
    constexpr int kRuns = 100;
    for (uint64_t seed = 1; seed <= kRuns; ++seed) {
        const Illuminance light = traced(scene, {0.3, -1.5, 1}, {0, 1, 0}, {.paths = 200, .seed = seed});
        const double lux = luminance(light.sum());
        sum += lux, squares += lux * lux, stated += light.standard_error_of_sum / kRuns;
    }
    const double spread = std::sqrt(squares / kRuns - sum * sum / (kRuns * kRuns));
    EXPECT_NEAR(spread, stated, 0.3 * stated) << "the first directions are spread evenly: a little less";
}

// Forty lamps among walls: shadow rays to some by chance give the light of all.
TEST(LightTracer, LooksAtSomeLampsAreRightOnAverage) {
    scene::Scene scene;
    const uint32_t grey = add_material(scene, 0.5f);
    add_rectangle(scene, grey, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
    add_box(scene, grey, {1, 2, 1}, {3, 2, 1});
    for (int i = 0; i < 40; ++i) add_lamp(scene, float(10 + 5 * i), {i % 8 * 4.0 - 14, 3, i / 8 * 6.0 - 12});
    const Illuminance all = traced(scene, {1, 1, 0.5}, {1, 0, 0}, {.paths = 4096, .threshold = 0});
    for (const uint32_t rays : {1u, 3u}) {
        const Illuminance some = traced(scene, {1, 1, 0.5}, {1, 0, 0}, {.lamp_rays = rays});
        EXPECT_EQ(lux(some, Origin::Lamps), lux(all, Origin::Lamps));
        for (const Origin origin : {Origin::Once, Origin::More}) {
            const double error = std::hypot(some.standard_error[size_t(origin)], all.standard_error[size_t(origin)]);
            EXPECT_NEAR(lux(some, origin), lux(all, origin), 4 * error) << rays;
            EXPECT_LT(error, 0.03 * lux(all, origin)) << rays;
        }
    }
}

TEST(LightTracer, TheSameSeedGivesTheSameLight) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.6f, 5), {2, 1.5f, 4});
    add_lamp(scene, 50, {0, 0, 0});
    const auto with = [&](uint64_t seed) {
        return traced(scene, {1, -1.5, 0}, {0, 1, 0}, {.paths = 500, .seed = seed}).sum();
    };
    EXPECT_EQ(with(7), with(7));
    EXPECT_NE(with(7), with(8));
}

}  // namespace
}  // namespace vesper::test::light_tracer_test
