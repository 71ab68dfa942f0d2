// Two scenes, compared field by field and bit by bit. SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace vesper::test {

inline void expect_same(const photometry::Distribution& a, const photometry::Distribution& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.goniometry, b.goniometry);
    EXPECT_EQ(a.horizontal, b.horizontal);
    EXPECT_EQ(a.vertical, b.vertical);
    EXPECT_EQ(a.candela, b.candela);
    EXPECT_EQ(a.lamp_flux, b.lamp_flux);
    EXPECT_EQ(a.metadata, b.metadata);
}

inline void expect_same(const photometry::LuminousOpening& a, const photometry::LuminousOpening& b) {
    EXPECT_EQ(a.length, b.length);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.round, b.round);
    EXPECT_EQ(a.drawn, b.drawn);
}

inline void expect_same(const scene::Material& a, const scene::Material& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.base_colour, b.base_colour);
    EXPECT_EQ(a.base_colour_texture, b.base_colour_texture);
    EXPECT_EQ(a.metallic, b.metallic);
    EXPECT_EQ(a.roughness, b.roughness);
    EXPECT_EQ(a.metallic_roughness_texture, b.metallic_roughness_texture);
    EXPECT_EQ(a.normal_texture, b.normal_texture);
    EXPECT_EQ(a.normal_scale, b.normal_scale);
    EXPECT_EQ(a.emission, b.emission);
    EXPECT_EQ(a.emission_texture.image, b.emission_texture.image);
    if (a.emission_texture.image != scene::kNone) {
        EXPECT_EQ(a.emission_texture, b.emission_texture);
    }
    EXPECT_EQ(a.emission_picture, b.emission_picture);
    EXPECT_EQ(a.alpha, b.alpha);
    EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff);
    EXPECT_EQ(a.clear, b.clear);
    EXPECT_EQ(a.double_sided, b.double_sided);
    EXPECT_EQ(a.reflection_table, b.reflection_table);
    EXPECT_EQ(a.retroreflector, b.retroreflector);
}

inline void expect_same(const scene::Mesh& a, const scene::Mesh& b) {
    EXPECT_EQ(a.name, b.name);
    ASSERT_EQ(a.primitives.size(), b.primitives.size());
    for (size_t i = 0; i < a.primitives.size(); ++i) {
        const scene::Primitive &p = a.primitives[i], &q = b.primitives[i];
        EXPECT_EQ(p.material, q.material);
        EXPECT_EQ(p.indices, q.indices);
        ASSERT_EQ(p.vertices.size(), q.vertices.size());
        EXPECT_EQ(std::memcmp(p.vertices.data(), q.vertices.data(), p.vertices.size() * sizeof(scene::Vertex)), 0);
    }
}

inline void expect_same(const scene::Lamp& a, const scene::Lamp& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.intensity, b.intensity);
    EXPECT_EQ(a.colour, b.colour);
    EXPECT_EQ(a.inner_cone, b.inner_cone);
    EXPECT_EQ(a.outer_cone, b.outer_cone);
    EXPECT_EQ(a.exponent, b.exponent);
    EXPECT_EQ(a.angular_diameter, b.angular_diameter);
    EXPECT_EQ(a.distribution, b.distribution);
    expect_same(a.opening, b.opening);
}

inline void expect_same(const scene::Node& a, const scene::Node& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.translation, b.translation);
    EXPECT_EQ(a.rotation, b.rotation);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_EQ(a.matrix, b.matrix);
    EXPECT_EQ(a.mesh, b.mesh);
    EXPECT_EQ(a.lamp, b.lamp);
    EXPECT_EQ(a.camera, b.camera);
    EXPECT_EQ(a.fixture, b.fixture);
}

inline void expect_same(const Image& a, const Image& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_TRUE(a.rgba == b.rgba);
}
inline void expect_same(const photometry::LuminancePicture& a, const photometry::LuminancePicture& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.width, b.width);
    EXPECT_TRUE(a.rgb == b.rgb);
}
inline void expect_same(const scene::Channel& a, const scene::Channel& b) {
    EXPECT_EQ(a.node, b.node);
    EXPECT_EQ(a.path, b.path);
    EXPECT_EQ(a.interpolation, b.interpolation);
    EXPECT_EQ(a.times, b.times);
    EXPECT_EQ(a.values, b.values);
}
inline void expect_same(const scene::Camera& a, const scene::Camera& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.vertical_fov, b.vertical_fov);
    EXPECT_EQ(a.near, b.near);
}

template <class T>
void expect_same_list(const std::vector<T>& a, const std::vector<T>& b, const char* of) {
    ASSERT_EQ(a.size(), b.size()) << of;
    for (size_t i = 0; i < a.size() && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE(std::string(of) + " " + std::to_string(i));
        expect_same(a[i], b[i]);
    }
}

inline void expect_same(const scene::Scene& a, const scene::Scene& b) {
    EXPECT_EQ(a.name, b.name);
    expect_same_list(a.images, b.images, "image");
    expect_same_list(a.luminance_pictures, b.luminance_pictures, "luminance picture");
    expect_same_list(a.materials, b.materials, "material");
    expect_same_list(a.meshes, b.meshes, "mesh");
    expect_same_list(a.lamps, b.lamps, "lamp");
    expect_same_list(a.distributions, b.distributions, "distribution");
    EXPECT_EQ(a.reflection_tables, b.reflection_tables);
    EXPECT_EQ(a.beyond_tables, b.beyond_tables);
    EXPECT_EQ(a.retroreflectors, b.retroreflectors);
    expect_same_list(a.cameras, b.cameras, "camera");
    expect_same_list(a.nodes, b.nodes, "node");
    expect_same_list(a.channels, b.channels, "channel");
    EXPECT_EQ(a.transfer.kind, b.transfer.kind);
    EXPECT_EQ(a.transfer.gamma, b.transfer.gamma);
    EXPECT_EQ(a.ambient_illuminance, b.ambient_illuminance);
    EXPECT_EQ(a.ambient_colour, b.ambient_colour);
    EXPECT_EQ(a.sky_luminance, b.sky_luminance);
    EXPECT_EQ(a.sky_colour, b.sky_colour);
    ASSERT_EQ(a.environment.has_value(), b.environment.has_value());
    if (!a.environment) return;
    EXPECT_EQ(a.environment->width, b.environment->width);
    EXPECT_TRUE(a.environment->rgb == b.environment->rgb);
    EXPECT_NEAR(a.environment->rotation, b.environment->rotation, 1e-15);
}

}  // namespace vesper::test
