// Materials of a document, changed as those of its scene were. SPDX-License-Identifier: MIT
#include <algorithm>

#include "scene/gltf_parts.h"
#include "scene/gltf_patch.h"

namespace vesper::scene {
namespace {

using nlohmann::json;
constexpr const char *kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness",
                     *kStrength = "KHR_materials_emissive_strength", *kTransform = "KHR_texture_transform",
                     *kUnlit = "KHR_materials_unlit";

bool has_extension(const json& material, const char* name) {
    const auto extensions = material.find("extensions");
    return extensions != material.end() && extensions->contains(name);
}

/// The textureInfo of the base colour.
json base_texture_of(const json& material) {
    if (has_extension(material, kSpecularGlossiness))
        return material["extensions"][kSpecularGlossiness]["diffuseTexture"];
    return material["pbrMetallicRoughness"]["baseColorTexture"];
}

void write_emission(const GltfDocument& document, json& root, json& material, const Scene& scene, const Material& was,
                    const Material& now) {
    const bool picture = now.emission_picture.image != kNone;
    if (!picture && now.emission == was.emission && now.emission_texture == was.emission_texture) return;
    if (!picture && now.emission_texture.image != kNone && now.emission_texture != was.emission_texture)
        material["emissiveTexture"] = base_texture_of(material);
    if (now.emission_texture.image == kNone) material.erase("emissiveTexture");
    glm::dvec3 emitted(now.emission);
    // Other viewers see the mean of a picture.
    if (picture) emitted *= photometry::mean_colour(scene.luminance_pictures[now.emission_picture.image]);
    const EmissionParts parts = emission_parts(emitted);
    if (parts.strength > 0) {
        material["emissiveFactor"] = {parts.factor.r, parts.factor.g, parts.factor.b};
        object_member(document, material, "extensions")[kStrength] = {{"emissiveStrength", parts.strength}};
        use_extension(root, kStrength);
    } else {
        material.erase("emissiveFactor");
        erase_extension(material, kStrength);
    }
}

/// Reflectance and roughness, where rules changed them. A model that says it otherwise gives way to the standard one,
/// as it was read.
void write_surface(const GltfDocument& document, json& material, const Material& was, const Material& now) {
    const bool roughness = now.roughness != was.roughness || now.metallic != was.metallic ||
                           now.metallic_roughness_texture != was.metallic_roughness_texture;
    if (!roughness && now.base_colour == was.base_colour) return;
    if (roughness) erase_extension(material, kUnlit);
    if (has_extension(material, kSpecularGlossiness)) {
        json model = json::object();
        if (now.base_colour_texture.image != kNone) model["baseColorTexture"] = base_texture_of(material);
        model["roughnessFactor"] = now.roughness, model["metallicFactor"] = now.metallic;
        erase_extension(material, kSpecularGlossiness);
        material["pbrMetallicRoughness"] = std::move(model);
    }
    json& model = object_member(document, material, "pbrMetallicRoughness");
    if (roughness) {
        model["roughnessFactor"] = now.roughness, model["metallicFactor"] = now.metallic;
        if (now.metallic_roughness_texture.image == kNone) model.erase("metallicRoughnessTexture");
    }
    const glm::dvec4 c = now.base_colour;
    model["baseColorFactor"] = {c.r, c.g, c.b, c.a};
}

int wrapping_of(Wrap wrap) {
    return wrap == Wrap::Repeat   ? TINYGLTF_TEXTURE_WRAP_REPEAT
           : wrap == Wrap::Mirror ? TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT
                                  : TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
}

/// The index of a sampler of the document for a texture.
size_t sampler_of(json& root, const TextureUse& use) {
    json made = {{"wrapS", wrapping_of(use.wrap_u)}, {"wrapT", wrapping_of(use.wrap_v)}};
    if (use.nearest) made["magFilter"] = TINYGLTF_TEXTURE_FILTER_NEAREST;
    json& samplers = root["samplers"];
    const auto same = std::find(samplers.begin(), samplers.end(), made);
    if (same != samplers.end()) return static_cast<size_t>(same - samplers.begin());
    samplers.push_back(std::move(made));
    return samplers.size() - 1;
}

/// A material's picture, in the place that its vertices have.
json luminous_of(json& root, uint32_t index, const Material& material, const UvMapping& mapping) {
    json use = {{"material", index},
                {"picture", material.emission_picture.image},
                {"scale", material.emission.r},
                {"texCoord", mapping.set}};
    if (mapping != UvMapping{.set = mapping.set}) {
        use["extensions"][kTransform] = {{"offset", {mapping.offset.x, mapping.offset.y}},
                                         {"scale", {mapping.scale.x, mapping.scale.y}},
                                         {"rotation", mapping.rotation}};
        use_extension(root, kTransform);
    }
    if (TextureUse{material.emission_picture.image} != material.emission_picture)
        use["sampler"] = sampler_of(root, material.emission_picture);
    return use;
}

}  // namespace

json patch_materials(GltfDocument& document, const GltfReader& reader, const SceneBefore& before) {
    json& root = document.edit();
    json luminous = json::array();
    for (uint32_t m = 0; m < before.materials.size(); ++m) {
        if (m == reader.source.implied_material) continue;
        const Material& now = reader.scene.materials[m];
        json& material = root["materials"][m];
        write_emission(document, root, material, reader.scene, before.materials[m], now);
        write_surface(document, material, before.materials[m], now);
        if (now.emission_picture.image != kNone)
            luminous.push_back(luminous_of(root, m, now, reader.uv_mappings[m].emission));
    }
    return luminous;
}

}  // namespace vesper::scene
