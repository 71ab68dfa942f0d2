// glTF materials, textures and images. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scene/gltf_reader.h"
#include "scene/reflectance.h"

namespace vesper::scene {
namespace {

Wrap wrap_of(GltfReader& reader, int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::Repeat;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::Mirror;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::Clamp;
        default:
            reader.notes.add("a wrapping mode that glTF does not have is read as REPEAT");
            return Wrap::Repeat;
    }
}

}  // namespace

UvMapping read_uv_mapping(const JsonValue& info) {
    UvMapping mapping;
    mapping.set = static_cast<uint32_t>(info.integer_or("texCoord", 0, 1000));
    if (const auto extensions = info.find("extensions")) {
        if (const auto transform = extensions->find("KHR_texture_transform")) {
            mapping.set = static_cast<uint32_t>(transform->integer_or("texCoord", mapping.set, 1000));
            mapping.rotation = static_cast<float>(transform->number_or("rotation", 0));
            if (const auto offset = transform->find("offset")) {
                const auto xy = offset->numbers<2>();
                mapping.offset = {xy[0], xy[1]};
            }
            if (const auto scale = transform->find("scale")) {
                const auto xy = scale->numbers<2>();
                mapping.scale = {xy[0], xy[1]};
            }
        }
    }
    return mapping;
}

void read_sampler(GltfReader& reader, uint32_t index, TextureUse& use) {
    const tinygltf::Sampler& sampler = reader.document.model().samplers[index];
    use.wrap_u = wrap_of(reader, sampler.wrapS);
    use.wrap_v = wrap_of(reader, sampler.wrapT);
    use.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

namespace {

uint32_t texture_of(GltfReader& reader, const JsonValue& info) {
    return info.at("index").index(reader.document.model().textures.size(), "textures");
}

/// A textureInfo object without its image: sampled how, and where its uv come from.
TextureUse read_place(GltfReader& reader, const JsonValue& info, UvMapping& mapping) {
    mapping = read_uv_mapping(info);
    TextureUse use;
    if (const int sampler = reader.document.model().textures[texture_of(reader, info)].sampler; sampler >= 0)
        read_sampler(reader, static_cast<uint32_t>(sampler), use);
    return use;
}

/// A textureInfo object: which image, sampled how, and where its uv come from.
TextureUse read_texture(GltfReader& reader, const JsonValue& info, UvMapping& mapping) {
    TextureUse use = read_place(reader, info, mapping);
    use.image = read_picture(reader, texture_of(reader, info));
    return use;
}

struct Properties {
    GltfPart<tinygltf::Material> material;
    Material& made;
    UvMapping base_uv, roughness_uv, normal_uv, emission_uv;
};

/// A number in [0, 1]; one outside is moved to the nearest end, with a note.
float unit_number(GltfReader& reader, double stated) {
    const auto number = static_cast<float>(stated);
    if (number < 0 || number > 1) reader.notes.add("a material factor outside [0, 1] is limited to it");
    return std::clamp(number, 0.0f, 1.0f);
}

template <class Numbers>
glm::vec4 unit_vec4(GltfReader& reader, const Numbers& v) {
    return {unit_number(reader, v[0]), unit_number(reader, v[1]), unit_number(reader, v[2]), unit_number(reader, v[3])};
}

/// The base colour texture. Beside one exporters write a white factor, which says nothing where its picture is missing:
/// the surface is then as one without material.
void read_base_colour(GltfReader& reader, const JsonValue& info, Properties& p) {
    p.made.base_colour_texture = read_texture(reader, info, p.base_uv);
    if (p.made.base_colour_texture.image == kNone && glm::vec3(p.made.base_colour) == glm::vec3(1))
        p.made.base_colour = glm::vec4(glm::vec3(kImpliedReflectance), p.made.base_colour.a);
}

void read_metallic_roughness(GltfReader& reader, Properties& p) {
    const tinygltf::PbrMetallicRoughness& factors = p.material->pbrMetallicRoughness;
    p.made.base_colour = unit_vec4(reader, factors.baseColorFactor);
    p.made.metallic = unit_number(reader, factors.metallicFactor);
    p.made.roughness = unit_number(reader, factors.roughnessFactor);
    const auto pbr = p.material.json.find("pbrMetallicRoughness");
    if (!pbr) return;
    if (const auto texture = pbr->find("baseColorTexture")) read_base_colour(reader, *texture, p);
    if (const auto texture = pbr->find("metallicRoughnessTexture")) {
        p.made.metallic_roughness_texture = read_texture(reader, *texture, p.roughness_uv);
        // A factor of 1 is for the texture to lower: a metal would be black at night.
        if (p.made.metallic_roughness_texture.image == kNone && p.made.metallic == 1) p.made.metallic = 0;
    }
}

/// KHR_materials_pbrSpecularGlossiness: the diffuse part is what we keep, less what is reflected before it: c_diff =
/// diffuse (1 - max(specular)).
void read_specular_glossiness(GltfReader& reader, const JsonValue& model, Properties& p) {
    p.made.base_colour = glm::vec4(1);
    p.made.base_colour_texture = p.made.metallic_roughness_texture = {};
    p.base_uv = p.roughness_uv = {};
    p.made.metallic = 0;
    double glossiness = unit_number(reader, model.number_or("glossinessFactor", 1));
    glm::dvec3 specular(1);
    if (const auto factor = model.find("specularFactor")) {
        const auto rgb = factor->numbers<3>();
        specular = {unit_number(reader, rgb[0]), unit_number(reader, rgb[1]), unit_number(reader, rgb[2])};
    }
    if (const auto texture = model.find("specularGlossinessTexture")) {
        UvMapping unused;
        const TextureUse use = read_texture(reader, *texture, unused);
        glm::dvec4 mean(0);
        if (use.image != kNone) {
            const auto [known, fresh] = reader.specular_means.try_emplace(use.image);
            if (fresh) known->second = mean_texel(reader.scene.images[use.image], {}, use);
            mean = known->second;
        }
        specular *= glm::dvec3(mean), glossiness *= mean.a;
        reader.notes.add("a specularGlossinessTexture counts as its mean: how it varies is left out");
    }
    p.made.roughness = static_cast<float>(1 - glossiness);
    if (const auto factor = model.find("diffuseFactor")) p.made.base_colour = unit_vec4(reader, factor->numbers<4>());
    if (const auto texture = model.find("diffuseTexture")) read_base_colour(reader, *texture, p);
    const auto rest = static_cast<float>(1 - std::max({specular.r, specular.g, specular.b}));
    p.made.base_colour *= glm::vec4(rest, rest, rest, 1);
    reader.notes.add("a material with KHR_materials_pbrSpecularGlossiness is read as its diffuse part and glossiness");
}

void read_emission(GltfReader& reader, Properties& p) {
    double strength = 1;
    if (const auto extensions = p.material.json.find("extensions"))
        if (const auto emission = extensions->find("KHR_materials_emissive_strength"))
            strength = emission->number_or("emissiveStrength", 1, 0);
    for (int c = 0; c < 3; ++c) {
        const double factor = p.material->emissiveFactor[static_cast<size_t>(c)];
        p.made.emission[c] = static_cast<float>(factor * strength);
        if (factor < 0 || !std::isfinite(p.made.emission[c]))
            p.material.json.at("emissiveFactor").fail("is negative, or not finite times the emissive strength");
    }
    const auto texture = p.material.json.find("emissiveTexture");
    if (!texture) return;
    if (p.made.emission == glm::vec3(0))  // its picture need not be read; one of a rule may lie in its place
        p.made.emission_texture = read_place(reader, *texture, p.emission_uv);
    else
        p.made.emission_texture = read_texture(reader, *texture, p.emission_uv);
    if (p.made.emission == glm::vec3(0) || p.made.emission_texture.image != kNone) return;
    // Its whole surface would shine where the picture may light a window.
    p.made.emission = glm::vec3(0);
    reader.notes.add("a material whose picture of emission cannot be read emits nothing");
}

constexpr double kSteepest = 100;  // scale of a normal texture

void read_relief(GltfReader& reader, Properties& p) {
    const auto texture = p.material.json.find("normalTexture");
    if (!texture) return;
    const double scale = texture->number_or("scale", 1);
    p.made.normal_scale = static_cast<float>(std::min(std::abs(scale), kSteepest));
    if (std::abs(scale) > kSteepest) reader.notes.add("a normal texture of a scale above 100 is read with 100");
    if (scale < 0) reader.notes.add("a normal texture of negative scale is read with the positive one");
    if (scale != 0) p.made.normal_texture = read_texture(reader, *texture, p.normal_uv);
}

bool transmits(const JsonValue& material) {
    const auto extensions = material.find("extensions");
    const auto transmission = extensions ? extensions->find("KHR_materials_transmission") : std::nullopt;
    return transmission && transmission->number_or("transmissionFactor", 0) > 0;
}

void read_alpha(GltfReader& reader, Properties& p) {
    const std::string mode = p.material->alphaMode;
    p.made.double_sided = p.material->doubleSided;
    p.made.clear = mode == "BLEND" || transmits(p.material.json);
    if (mode == "OPAQUE") return;
    if (mode != "MASK" && mode != "BLEND")
        return reader.notes.add("an alpha mode that glTF does not have is read as OPAQUE");
    if (mode == "BLEND") mark(reader.source.blended, reader.scene.materials.size());
    if (mode == "BLEND" && p.made.emission != glm::vec3(0)) {
        // The glass of a lamp must not vanish while it shines.
        reader.notes.add("a material of alpha mode BLEND that emits is drawn opaque");
        return;
    }
    p.made.alpha = Material::Alpha::Mask;
    if (mode == "MASK")
        p.made.alpha_cutoff = static_cast<float>(p.material.json.number_or("alphaCutoff", 0.5, 0));
    else
        reader.notes.add(
            "a material of alpha mode BLEND is drawn as MASK: opaque from half opacity on, invisible below");
}

/// Vertices have one uv beside that of emission: that of the first texture of base colour, roughness and relief. An
/// emission that is not shown gives one, too: a luminance picture may take its place.
MaterialUv uv_of(GltfReader& reader, Properties& p) {
    const bool base = p.made.base_colour_texture.image != kNone;
    const bool roughness = p.made.metallic_roughness_texture.image != kNone;
    const bool emission = p.material.json.find("emissiveTexture").has_value();
    if (base && roughness && p.roughness_uv != p.base_uv)
        reader.notes.add("a metallic-roughness texture that lies differently follows its base colour texture");
    UvMapping surface = p.normal_uv;
    if (roughness) surface = p.roughness_uv;
    if (base) surface = p.base_uv;
    if (p.made.normal_texture.image != kNone && p.normal_uv != surface) {
        reader.notes.add("a normal texture that lies differently from the colours of its surface is left out");
        p.made.normal_texture = {};
    }
    return {surface, emission ? p.emission_uv : surface};
}

void read_material(GltfReader& reader, const GltfPart<tinygltf::Material>& material) {
    Material made;
    made.name = material->name;
    Properties p{material, made, {}, {}, {}, {}};
    const auto extensions = material.json.find("extensions");
    const auto model = extensions ? extensions->find("KHR_materials_pbrSpecularGlossiness") : std::nullopt;
    if (model)
        read_specular_glossiness(reader, *model, p);
    else
        read_metallic_roughness(reader, p);
    if (extensions && extensions->find("KHR_materials_unlit")) {
        made.metallic = 0;
        made.roughness = 1;
        made.metallic_roughness_texture = {};
        reader.notes.add("a material with KHR_materials_unlit is lit as a diffuse one");
    }
    read_emission(reader, p);
    read_relief(reader, p);
    read_alpha(reader, p);
    if (material.json.find("occlusionTexture")) reader.notes.add("an occlusion texture is not read");
    reader.uv_mappings.push_back(uv_of(reader, p));
    reader.scene.materials.push_back(std::move(made));
}

}  // namespace

glm::vec2 UvMapping::apply(glm::vec2 uv) const {
    if (*this == UvMapping{.set = set}) return uv;
    const float c = std::cos(rotation), s = std::sin(rotation);
    const glm::vec2 scaled = scale * uv;
    return offset + glm::vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
}

void read_materials(GltfReader& reader) {
    reader.image_of.assign(reader.document.list("images").size(), kUnread);
    for (size_t i = 0; i < reader.document.model().materials.size(); ++i)
        read_material(reader, reader.document.material(i));
}

}  // namespace vesper::scene
