// The digest of what hides lamps: another one for whatever changes a texel of a map, the same for all else.
// SPDX-License-Identifier: MIT
#include "gpu_scene/occluders.h"
#include "scene/scene.h"

#include <functional>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

scene::Scene fence() {
    scene::Scene s;
    s.images = {{"leaves", 2, 1, {10, 20, 30, 255, 40, 50, 60, 0}}, {"brick", 1, 1, {9, 9, 9, 7}}};
    scene::Material mask;
    mask.alpha = scene::Material::Alpha::Mask, mask.base_colour_texture.image = 0, mask.base_colour.a = 0.9f;
    scene::Material wall;
    wall.base_colour_texture.image = 1;
    s.materials = {mask, wall};
    for (uint32_t material = 0; material < 2; ++material) {
        scene::Primitive p;
        p.material = material;
        for (const glm::vec3 at : {glm::vec3(0), {1, 0, 0}, {0, 1, 0}}) {
            p.vertices.emplace_back().position = at;
            p.bounds.add(at);
        }
        p.indices = {0, 1, 2};
        s.meshes.push_back({"", {p}});
    }
    s.lamps.emplace_back().intensity = 100;
    s.nodes.resize(3);
    s.nodes[0].mesh = 0, s.nodes[1].mesh = 1, s.nodes[2].lamp = 0;
    return s;
}

using Change = std::function<void(scene::Scene&)>;

bool changes(const Change& change) {
    scene::Scene s = fence();
    const Digest::Value before = gpu_scene::occluder_digest(s);
    EXPECT_EQ(gpu_scene::occluder_digest(s), before);
    change(s);
    return gpu_scene::occluder_digest(s) != before;
}

TEST(MapOccluders, AllThatChangesMapsCounts) {
    const auto mask = [](scene::Scene& s) -> scene::Material& { return s.materials[0]; };
    const auto first = [](scene::Scene& s) -> scene::Primitive& { return s.meshes[0].primitives[0]; };
    const std::pair<const char*, Change> all[]{
        {"vertex", [&](auto& s) { first(s).vertices[1].position.x += 1e-6f; }},
        {"uv", [&](auto& s) { first(s).vertices[1].uv.y = 0.5f; }},
        {"opacity of a vertex", [&](auto& s) { first(s).vertices[2].colour[3] = 65534; }},
        {"index", [&](auto& s) { std::swap(first(s).indices[0], first(s).indices[1]); }},
        {"triangle",
         [&](auto& s) {
             first(s).indices.insert(first(s).indices.end(), {0, 1, 2});
         }},
        {"bounds",
         [&](auto& s) {
             first(s).bounds.add({2, 0, 0});
         }},
        {"material of a part", [&](auto& s) { first(s).material = 1; }},
        {"mask", [&](auto& s) { mask(s).alpha = scene::Material::Alpha::Opaque; }},
        {"cutoff", [&](auto& s) { mask(s).alpha_cutoff = 0.49f; }},
        {"opacity", [&](auto& s) { mask(s).base_colour.a = 0.8f; }},
        {"glass", [&](auto& s) { s.materials[1].clear = true; }},
        {"wrap", [&](auto& s) { mask(s).base_colour_texture.wrap_u = scene::Wrap::Clamp; }},
        {"wrap", [&](auto& s) { mask(s).base_colour_texture.wrap_v = scene::Wrap::Mirror; }},
        {"nearest", [&](auto& s) { mask(s).base_colour_texture.nearest = true; }},
        {"no image", [&](auto& s) { mask(s).base_colour_texture.image = scene::kNone; }},
        {"another image", [&](auto& s) { mask(s).base_colour_texture.image = 1; }},
        {"opacity of an image", [&](auto& s) { s.images[0].rgba[7] = 1; }},
        {"shape of an image", [&](auto& s) { std::swap(s.images[0].width, s.images[0].height); }},
        {"mesh of a node", [&](auto& s) { s.nodes[0].mesh = 1; }},
        {"node without a mesh", [&](auto& s) { s.nodes[0].mesh = scene::kNone; }},
        {"node", [&](auto& s) { s.nodes.emplace_back().mesh = 0; }},
        {"parts", [&](auto& s) { s.meshes[0].primitives.push_back(s.meshes[0].primitives[0]); }},
    };
    for (const auto& [name, change] : all) EXPECT_TRUE(changes(change)) << name;
}

TEST(MapOccluders, NothingElseCounts) {
    const std::pair<const char*, Change> all[]{
        {"nothing", [](auto&) {}},
        {"names", [](auto& s) { s.name = s.nodes[0].name = s.materials[0].name = "another"; }},
        {"colour", [](auto& s) { s.materials[0].base_colour.r = 0.2f; }},
        {"gloss", [](auto& s) { s.materials[0].roughness = 0.2f, s.materials[1].metallic = 1; }},
        {"emission", [](auto& s) { s.materials[0].emission = glm::vec3(9); }},
        {"colour of an image", [](auto& s) { s.images[0].rgba[0] = 99; }},
        {"image that masks nothing", [](auto& s) { s.images[1].rgba[3] = 99; }},
        {"opacity that masks nothing", [](auto& s) { s.materials[1].base_colour.a = 0.1f; }},
        {"colour of a lamp",
         [](auto& s) {
             s.lamps[0].colour = {1, 0.9f, 0.5f};
         }},
        {"intensity", [](auto& s) { s.lamps[0].intensity = 3; }},
        {"sky", [](auto& s) { s.ambient_illuminance = 1; }},
        {"place", [](auto& s) { s.nodes[0].translation.x = 1; }},  // poses are a part of their own
    };
    for (const auto& [name, change] : all) EXPECT_FALSE(changes(change)) << name;
}

}  // namespace
}  // namespace vesper::test
