// Which parts of a scene are small emitters, and their silhouettes. SPDX-License-Identifier: MIT
#include "gpu_scene/small_emitters.h"

#include <array>

#include <gtest/gtest.h>

#include "gpu_scene/silhouette.h"
#include "support/rooms.h"

namespace vesper::test::small_emitters_list_test {
namespace {

using glm::dvec2, glm::dvec3;
using gpu_scene::EmittingPart, gpu_scene::Silhouette, gpu_scene::View;
using scene::Scene;

double area_of(const std::vector<dvec2>& v) {
    double twice = 0;
    for (size_t i = 1; i + 1 < v.size(); ++i)
        twice += (v[i] - v[0]).x * (v[i + 1] - v[0]).y - (v[i] - v[0]).y * (v[i + 1] - v[0]).x;
    return twice / 2;
}

/// A square that emits 100 cd/m^2, with one texel of four lit.
Scene lit_square() {
    Scene scene;
    add_rectangle(scene, add_material(scene, 0, 100), {0, 0, -10}, {1, 0, 0}, {0, 1, 0});
    scene.images = {{"lit", 2, 2, {255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255}}};
    const std::array<glm::vec2, 4> uv{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    for (size_t k = 0; k < 4; ++k) scene.meshes[0].primitives[0].vertices[k].uv = uv[k];
    return scene;
}

TEST(SmallEmitterParts, HoldTheMeanOfTheirTriangles) {
    Scene scene = lit_square();
    std::vector<EmittingPart> parts = gpu_scene::emitting_parts(scene);
    ASSERT_EQ(parts.at(0).triangles.size(), 2u);
    EXPECT_TRUE(parts[0].plain);
    for (const glm::vec3& quarter : parts[0].triangles[0].luminance) EXPECT_EQ(quarter, glm::vec3(100));

    scene.materials[0].emission_texture = {.image = 0, .nearest = true};
    parts = gpu_scene::emitting_parts(scene);
    EXPECT_FALSE(parts[0].plain);
    // The lit texel is the upper left quarter: the corner of one triangle, and what the diagonal leaves of it.
    double sum = 0;
    for (const EmittingPart::Triangle& triangle : parts[0].triangles)
        for (const glm::vec3& quarter : triangle.luminance) sum += quarter.g / 8;
    EXPECT_NEAR(sum, 25, 1e-3);
    EXPECT_NEAR(parts[0].triangles[1].luminance[2].g, 100, 1e-3);
    EXPECT_NEAR(parts[0].triangles[0].luminance[1].g, 0, 1e-3);

    scene.luminance_pictures.push_back({.width = 1, .height = 1, .rgb = {1, 2, 3}});
    scene.materials[0].emission_texture = {}, scene.materials[0].emission_picture.image = 0;
    parts = gpu_scene::emitting_parts(scene);
    EXPECT_NEAR(glm::distance(parts[0].triangles[0].luminance[3], glm::vec3(100, 200, 300)), 0, 1e-3);
}

TEST(SmallEmitterParts, AreOnlyWhatCanBeDrawnSo) {
    const auto count = [](const Scene& scene) { return gpu_scene::emitting_parts(scene).at(0).triangles.size(); };
    Scene scene = lit_square();
    EXPECT_EQ(count(scene), 2u);
    scene.materials[0].double_sided = true;
    EXPECT_EQ(count(scene), 2u) << "it is flat";
    scene.meshes[0].primitives[0].vertices[3].position.z -= 0.2f;
    EXPECT_EQ(count(scene), 0u) << "one side may hide the other";
    scene.materials[0].double_sided = false;
    EXPECT_EQ(count(scene), 2u);
    scene.materials[0].alpha = scene::Material::Alpha::Mask;
    EXPECT_EQ(count(scene), 0u) << "it has holes";
    scene.materials[0].alpha = scene::Material::Alpha::Opaque, scene.materials[0].emission = glm::vec3(0);
    EXPECT_EQ(count(scene), 0u) << "it emits nothing";
    scene.materials[0].emission = glm::vec3(1);
    std::vector<uint32_t>& indices = scene.meshes[0].primitives[0].indices;
    while (indices.size() <= 3 * gpu_scene::kMostTrianglesOfSmallEmitter) indices.insert(indices.end(), {0, 1, 2});
    EXPECT_EQ(count(scene), 0u) << "too many triangles";
}

TEST(SmallEmitterParts, HaveTheFrameThatIsAtThem) {
    Scene scene = lit_square();
    Scene bars;
    add_rectangle(bars, 0, {0.4f, 0, -9.95f}, {0.2f, 0, 0}, {0, 1, 0});  // before it
    add_rectangle(bars, 0, {0.4f, -9, -10}, {0.2f, 0, 0}, {0, 8, 0});    // its pole, a metre below
    for (const scene::Mesh& bar : bars.meshes) scene.meshes[0].primitives.push_back(bar.primitives[0]);
    for (size_t i = 1; i < 3; ++i) scene.meshes[0].primitives[i].material = add_material(scene, 0.5f);
    const auto parts = gpu_scene::emitting_parts(scene);
    ASSERT_EQ(parts.size(), 3u);
    ASSERT_EQ(parts[0].frame.size(), 1u) << "one facet of two triangles";
    EXPECT_EQ(parts[0].frame[0].size(), 4u);
    EXPECT_EQ(parts[0].frame[0][0], glm::vec3(0.4f, 0, -9.95f));
    EXPECT_TRUE(parts[1].triangles.empty());
}

// 100 x 100 px over 1 m at 1 m.
const View kView = View::symmetric({100, 100}, 2 * std::atan(0.5f), glm::dmat4(1));

TEST(TriangleSilhouettes, AreTheTrianglesInPixels) {
    const std::array<dvec3, 3> corners{{{0, 0, -1}, {0.1, 0, -1}, {0, 0.2, -1}}};
    const Silhouette seen = gpu_scene::project(corners, kView, 0.5);
    EXPECT_NEAR(area_of(seen.vertices), 100, 1e-4);  // tangents are float
    EXPECT_EQ(seen.widening, 1);
    EXPECT_NEAR(seen.width, 10, 1) << "px";
    const std::array<dvec3, 3> other{corners[0], corners[2], corners[1]};
    EXPECT_NEAR(area_of(gpu_scene::project(other, kView, 0.5).vertices), 100, 1e-4) << "from behind";
}

TEST(TriangleSilhouettes, OfThinOnesAreWidened) {
    for (const double size : {1e-3, 1e-5}) {
        const std::array<dvec3, 3> corners{{{0, 0, -1}, {size, 0, -1}, {0, 0.2 * size, -1}}};
        const Silhouette seen = gpu_scene::project(corners, kView, 0.5);
        EXPECT_NEAR(area_of(seen.vertices) / seen.widening / (0.1 * size * size * 1e4), 1, 1e-6);
        EXPECT_GT(area_of(seen.vertices), 0.4) << "of a pixel";
        EXPECT_LT(seen.width, 0.3);
    }
}

TEST(TriangleSilhouettes, AreCutAtTheEyeAndTheImage) {
    const Silhouette beside =
        gpu_scene::project(std::array<dvec3, 3>{{{0.45, 0, -1}, {0.55, 0, -1}, {0.45, 0.1, -1}}}, kView, 0.5);
    EXPECT_NEAR(area_of(beside.vertices), 37.5, 1e-3);
    const Silhouette road =
        gpu_scene::project(std::array<dvec3, 3>{{{-1, -0.1, 5}, {1, -0.1, 5}, {0, -0.1, -9}}}, kView, 0.5);
    EXPECT_EQ(road.width, 0) << "it goes on behind the eye";
    EXPECT_GT(area_of(road.vertices), 1000);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const std::array<dvec3, 3>& broken : {std::array<dvec3, 3>{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}},
                                               {{{0, 0, -1}, {0.1, 0, -1}, {0, nan, -1}}},
                                               {{{0, 0, -1}, {0, 0, -1}, {0, 0.1, -1}}}})
        EXPECT_TRUE(gpu_scene::project(broken, kView, 0.5).vertices.empty());
}

}  // namespace
}  // namespace vesper::test::small_emitters_list_test
