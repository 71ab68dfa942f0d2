// How many parts and triangles a view draws and sees. SPDX-License-Identifier: MIT
#include "render/seen_triangles.h"

#include <gtest/gtest.h>

#include "gpu_scene/cameras.h"
#include "scene/placement.h"
#include "street.h"
#include "support/pass_rig.h"

namespace vesper::test {
namespace {

scene::Mesh plate(const std::string& name, float side, float away, uint32_t cells) {
    scene::Primitive p;
    for (uint32_t j = 0; j <= cells; ++j)
        for (uint32_t i = 0; i <= cells; ++i) {
            const glm::vec2 at = side * (glm::vec2(i, j) / float(cells) - 0.5f);
            p.vertices.push_back({.position = {at, -away}, .normal = {0, 0, 1}});
            p.bounds.add(p.vertices.back().position);
        }
    for (uint32_t j = 0; j < cells; ++j)
        for (uint32_t i = 0; i < cells; ++i) {
            const uint32_t a = j * (cells + 1) + i;
            for (const uint32_t index : {a, a + 1, a + cells + 2, a, a + cells + 2, a + cells + 1})
                p.indices.push_back(index);
        }
    return {name, {std::move(p)}};
}

// A plate of 32 triangles before one of 128, all of them larger than pixels; and one behind the eye.
TEST(SeenTriangles, AreThoseInFrontAtSomePixel) {
    scene::Scene scene;
    scene.materials.push_back({.name = "grey"});
    scene.meshes = {plate("far", 4, 4, 8), plate("near", 1, 2, 4), plate("behind", 1, -2, 1)};
    for (uint32_t mesh = 0; mesh < 3; ++mesh) scene.nodes.push_back({.name = scene.meshes[mesh].name, .mesh = mesh});
    PassRig rig;
    const gpu_scene::GpuScene resident(rig.device(), scene);
    const gpu_scene::SceneFrame rest{scene::world_transforms(scene, 0)};
    const gpu_scene::View view = gpu_scene::View::symmetric({512, 512}, 1.2f, glm::dmat4(1));
    const render::TriangleCounter counter(rig.device());
    const render::SeenTriangles all = counter.count(resident, rest, view);
    EXPECT_EQ(all.parts, 2u);
    EXPECT_EQ(all.triangles, 128u + 32);
    EXPECT_EQ(all.seen_parts, 2u);
    // The near plate hides the middle 2 m of the far one: 4 x 4 of its cells.
    EXPECT_EQ(all.seen_triangles, 128u - 32 + 32);
    // One pixel sees one triangle.
    const render::SeenTriangles one =
        counter.count(resident, rest, gpu_scene::View::symmetric({1, 1}, 0.1f, glm::dmat4(1)));
    EXPECT_EQ(one.seen_triangles, 1u);
    EXPECT_EQ(one.seen_parts, 1u);
}

}  // namespace
}  // namespace vesper::test
