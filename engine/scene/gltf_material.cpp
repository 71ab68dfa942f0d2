// glTF materials, textures and images. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/image_file.h"
#include "scene/gltf_reader.h"
#include "scene/reflectance.h"

namespace vesper {
namespace {

uint32_t read_image(GltfReader& reader, const JsonValue& reference) {
    const JsonValue entry = reader.document.element("images", reference);
    const uint32_t index = reference.index(UINT32_MAX, "images");
    if (reader.image_of[index] != kUnread) return reader.image_of[index];
    const std::vector<uint8_t> bytes = reader.document.image(index);
    const std::string type = media_type(bytes);
    if (!type.empty() && type != "image/png" && type != "image/jpeg") {
        reader.notes.add("a picture of type " + type + " is not read: its texture is left out");
        return reader.image_of[index] = kNone;
    }
    Image image;
    try {
        image = decode_image(bytes, reader.limits.image_side, reader.limits.texels - reader.texels);
    } catch (const Error& error) {
        entry.fail(error.what());
    }
    if (is_16_bit_png(bytes)) reader.notes.add("a picture of 16 bits is read at 8: below 0.01 its values are coarse");
    reader.texels += static_cast<uint64_t>(image.width) * image.height;
    const auto uri = entry.find("uri");
    image.name =
        entry.text_or("name", uri && uri->text().size() < 256 ? uri->text() : "image " + std::to_string(index));
    reader.scene.images.push_back(std::move(image));
    return reader.image_of[index] = static_cast<uint32_t>(reader.scene.images.size() - 1);
}

Wrap wrap_of(GltfReader& reader, const JsonValue& sampler, const char* key) {
    const auto mode = sampler.find(key);
    if (!mode) return Wrap::Repeat;
    switch (mode->integer()) {
        case 10497:
            return Wrap::Repeat;
        case 33648:
            return Wrap::Mirror;
        case 33071:
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

void read_sampler(GltfReader& reader, const JsonValue& index, TextureUse& use) {
    const JsonValue sampler = reader.document.element("samplers", index);
    use.wrap_u = wrap_of(reader, sampler, "wrapS");
    use.wrap_v = wrap_of(reader, sampler, "wrapT");
    use.nearest = sampler.integer_or("magFilter", 9729) == 9728;
}

namespace {

/// A textureInfo object: which image, sampled how, and where its uv come from.
TextureUse read_texture(GltfReader& reader, const JsonValue& info, UvMapping& mapping) {
    mapping = read_uv_mapping(info);
    const JsonValue texture = reader.document.element("textures", info.at("index"));
    TextureUse use;
    if (const auto sampler = texture.find("sampler")) read_sampler(reader, *sampler, use);
    if (const auto source = texture.find("source"))
        use.image = read_image(reader, *source);
    else
        reader.notes.add("a texture without a PNG or JPEG source is left out");
    return use;
}

struct Properties {
    JsonValue material;
    Material& made;
    UvMapping base_uv, roughness_uv, emission_uv;
};

/// Numbers in [0, 1]; what lies outside is moved to the nearest end, said so.
template <size_t N>
std::array<float, N> unit_numbers(GltfReader& reader, const JsonValue& value) {
    auto numbers = value.numbers<N>();
    for (float& number : numbers) {
        if (number < 0 || number > 1) reader.notes.add("a material factor outside [0, 1] is limited to it");
        number = std::clamp(number, 0.0f, 1.0f);
    }
    return numbers;
}

float unit_number(GltfReader& reader, const JsonValue& holder, const char* key, float fallback) {
    const auto value = holder.find(key);
    if (!value) return fallback;
    const auto number = static_cast<float>(value->number());
    if (number < 0 || number > 1) reader.notes.add("a material factor outside [0, 1] is limited to it");
    return std::clamp(number, 0.0f, 1.0f);
}

glm::vec4 vec4_of(const std::array<float, 4>& v) { return {v[0], v[1], v[2], v[3]}; }

void read_metallic_roughness(GltfReader& reader, Properties& p) {
    p.made.metallic = 1;
    p.made.roughness = 1;
    const auto pbr = p.material.find("pbrMetallicRoughness");
    if (!pbr) return;
    if (const auto factor = pbr->find("baseColorFactor"))
        p.made.base_colour = vec4_of(unit_numbers<4>(reader, *factor));
    p.made.metallic = unit_number(reader, *pbr, "metallicFactor", 1);
    p.made.roughness = unit_number(reader, *pbr, "roughnessFactor", 1);
    if (const auto texture = pbr->find("baseColorTexture"))
        p.made.base_colour_texture = read_texture(reader, *texture, p.base_uv);
    if (const auto texture = pbr->find("metallicRoughnessTexture"))
        p.made.metallic_roughness_texture = read_texture(reader, *texture, p.roughness_uv);
}

/// KHR_materials_pbrSpecularGlossiness: the diffuse part is what we keep, less what is reflected before it: c_diff = diffuse (1 - max(specular)).
void read_specular_glossiness(GltfReader& reader, const JsonValue& model, Properties& p) {
    p.made.base_colour = glm::vec4(1);
    p.made.base_colour_texture = p.made.metallic_roughness_texture = {};
    p.base_uv = p.roughness_uv = {};
    p.made.metallic = 0;
    double glossiness = unit_number(reader, model, "glossinessFactor", 1);
    glm::dvec3 specular(1);
    if (const auto factor = model.find("specularFactor")) {
        const auto rgb = unit_numbers<3>(reader, *factor);
        specular = {rgb[0], rgb[1], rgb[2]};
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
    if (const auto factor = model.find("diffuseFactor")) p.made.base_colour = vec4_of(unit_numbers<4>(reader, *factor));
    if (const auto texture = model.find("diffuseTexture"))
        p.made.base_colour_texture = read_texture(reader, *texture, p.base_uv);
    const auto rest = static_cast<float>(1 - std::max({specular.r, specular.g, specular.b}));
    p.made.base_colour *= glm::vec4(rest, rest, rest, 1);
    reader.notes.add("a material with KHR_materials_pbrSpecularGlossiness is read as its diffuse part and glossiness");
}

void read_emission(GltfReader& reader, Properties& p) {
    double strength = 1;
    if (const auto extensions = p.material.find("extensions"))
        if (const auto emission = extensions->find("KHR_materials_emissive_strength"))
            strength = emission->number_or("emissiveStrength", 1, 0);
    if (const auto factor = p.material.find("emissiveFactor")) {
        const auto rgb = factor->numbers<3>(0);
        for (int c = 0; c < 3; ++c) {
            p.made.emission[c] = static_cast<float>(rgb[static_cast<size_t>(c)] * strength);
            if (!std::isfinite(p.made.emission[c])) factor->fail("times the emissive strength is not finite");
        }
    }
    if (p.made.emission == glm::vec3(0)) return;  // its texture need not be read
    if (const auto texture = p.material.find("emissiveTexture"))
        p.made.emission_texture = read_texture(reader, *texture, p.emission_uv);
}

void read_alpha(GltfReader& reader, Properties& p) {
    const std::string mode = p.material.text_or("alphaMode", "OPAQUE");
    p.made.double_sided = p.material.boolean_or("doubleSided", false);
    if (mode == "OPAQUE") return;
    if (mode != "MASK" && mode != "BLEND") return reader.notes.add("an alpha mode that glTF does not have is read as OPAQUE");
    if (mode == "BLEND" && p.made.emission != glm::vec3(0)) {
        // The glass of a lamp must not vanish while it shines.
        reader.notes.add("a material of alpha mode BLEND that emits is drawn opaque");
        return;
    }
    p.made.alpha = Material::Alpha::Mask;
    if (mode == "MASK")
        p.made.alpha_cutoff = static_cast<float>(p.material.number_or("alphaCutoff", 0.5, 0));
    else
        reader.notes.add(
            "a material of alpha mode BLEND is drawn as MASK: opaque from half opacity on, invisible below");
}

/// Vertices have one uv: the base colour's, or the first texture's there is.
UvMapping common_uv(GltfReader& reader, const Properties& p) {
    const bool base = p.made.base_colour_texture.image != kNone, emission = p.made.emission_texture.image != kNone;
    const bool roughness = p.made.metallic_roughness_texture.image != kNone;
    const UvMapping chosen = base ? p.base_uv : emission ? p.emission_uv : p.roughness_uv;
    if ((emission && p.emission_uv != chosen) || (roughness && p.roughness_uv != chosen))
        reader.notes.add("a material whose textures lie differently: all follow its base colour texture");
    return chosen;
}

void read_material(GltfReader& reader, const JsonValue& material) {
    Material made;
    made.name = material.text_or("name", "");
    Properties p{material, made, {}, {}, {}};
    const auto extensions = material.find("extensions");
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
    read_alpha(reader, p);
    if (material.find("normalTexture")) reader.notes.add("a normal texture is not read");
    if (material.find("occlusionTexture")) reader.notes.add("an occlusion texture is not read");
    reader.uv_mappings.push_back(common_uv(reader, p));
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
    for (const JsonValue& material : reader.document.list("materials")) read_material(reader, material);
}

}  // namespace vesper
