// Surfaces of a scene, and how they use images. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <glm/glm.hpp>

#include "scene/index.h"

namespace vesper::scene {

/// How the 8-bit code T of a colour texture becomes a linear value in [0, 1].
struct Transfer {
    enum class Kind : uint8_t { Srgb, Gamma };
    Kind kind = Kind::Srgb;
    float gamma = 2.2f;  ///< Kind::Gamma: value = T^gamma (Petit, Bremond and Vienne, Eq. 1: gamma = 2.2)
};

enum class Wrap : uint8_t { Repeat, Mirror, Clamp };

/// One use of an image by a material. Its UV set and KHR_texture_transform are baked into the vertices at loading.
struct TextureUse {
    uint32_t image = kNone;
    Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
    bool nearest = false;  ///< magnify without interpolation

    bool operator==(const TextureUse&) const = default;
};

/// A surface. The diffuse reflectance is base_colour * (1 - metallic); roughness 1 is a pure Lambert surface.
struct Material {
    enum class Alpha : uint8_t { Opaque, Mask };
    std::string name;
    glm::vec4 base_colour{1};           ///< linear reflectance and opacity, [0, 1]; times base_colour_texture
    TextureUse base_colour_texture;     ///< codes through Scene::transfer
    float metallic = 0, roughness = 1;  ///< [0, 1]; times blue and green of metallic_roughness_texture
    TextureUse metallic_roughness_texture;
    TextureUse normal_texture;    ///< relief (glTF 2.0, 3.9.3): codes are directions; roads with a table have none
    float normal_scale = 1;       ///< of its slopes, 0 or more
    glm::vec3 emission{0};        ///< emitted RGB luminance, cd/m^2; times emission_texture
    TextureUse emission_texture;  ///< codes through sRGB
    TextureUse emission_picture;  ///< instead of emission_texture: image is an index into Scene::luminance_pictures
    Alpha alpha = Alpha::Opaque;
    float alpha_cutoff = 0.5f;
    bool clear = false;  ///< glass (in glTF alpha mode BLEND, or KHR_materials_transmission above 0): rays of `rays/`
                         ///< pass; pictures draw it by `alpha`
    bool double_sided = false;
    uint32_t reflection_table = kNone;  ///< index into Scene::reflection_tables
    uint32_t retroreflector = kNone;    ///< index into Scene::retroreflectors; such a surface is no metal
};

/// All images that a material shows by their codes.
inline std::array<TextureUse*, 4> textures_of(Material& m) {
    return {&m.base_colour_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emission_texture};
}
inline std::array<const TextureUse*, 4> textures_of(const Material& m) {
    return {&m.base_colour_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emission_texture};
}

}  // namespace vesper::scene
