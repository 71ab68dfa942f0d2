// Materials that shine with a picture. SPDX-License-Identifier: MIT
#include <algorithm>

#include "scene/convert_rules.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

/// The textureInfo whose coordinates the picture takes: emission's, or else the base colour's.
std::optional<JsonValue> placed_as(const JsonValue& material) {
    if (const auto emission = material.find("emissiveTexture")) return emission;
    const auto extensions = material.find("extensions");
    if (const auto other = extensions ? extensions->find(kSpecularGlossiness) : std::nullopt)
        return other->find("diffuseTexture");
    const auto model = material.find("pbrMetallicRoughness");
    return model ? model->find("baseColorTexture") : std::nullopt;
}

/// The picture's place in the extras block; each is stored once, its file byte for byte.
size_t stored(Conversion& conversion, const EmitterRule& rule) {
    const auto [known, is_new] = conversion.picture_of.try_emplace(rule.picture, conversion.luminance_pictures.size());
    if (!is_new) return known->second;
    const EmitterPicture& added = conversion.photometry.pictures[rule.picture];
    conversion.luminance_pictures.push_back(
        {{"name", added.picture.name}, {"bufferView", add_buffer_view(conversion.document.edit(), added.bytes)}});
    if (added.changed > 0)
        conversion.report.warnings.push_back("picture " + in_quotes(added.picture.name) + ": " +
                                             std::to_string(added.changed) +
                                             " pixels with negative components are drawn to grey, or black");
    if (rule.unit_unknown)
        conversion.report.warnings.push_back("picture " + in_quotes(added.picture.name) +
                                             ": does not say how much its value 1 is (whiteLuminance): taken for 1 "
                                             "cd/m^2; \"scale\" or \"luminance_cd_m2\" states it");
    return known->second;
}

}  // namespace

glm::dvec3 show_picture(Conversion& conversion, const EmitterRule& rule, uint32_t index) {
    json use = {{"material", index}, {"scale", rule.scale}};
    if (const auto info = placed_as(conversion.document.list("materials")[index])) {
        if (const auto set = info->find("texCoord")) use["texCoord"] = set->json();
        const auto extensions = info->find("extensions");
        if (const auto transform = extensions ? extensions->find("KHR_texture_transform") : std::nullopt)
            use["extensions"] = {{"KHR_texture_transform", transform->json()}};
        const JsonValue texture = conversion.document.element("textures", info->at("index"));
        if (const auto sampler = texture.find("sampler")) use["sampler"] = sampler->json();
    }
    use["picture"] = stored(conversion, rule);
    conversion.luminous.push_back(use);
    return rule.scale * photometry::mean_colour(conversion.photometry.pictures[rule.picture].picture);
}

std::string described_picture(const Conversion& conversion, const EmitterRule& rule) {
    const photometry::LuminancePicture& picture = conversion.photometry.pictures[rule.picture].picture;
    return "picture " + in_quotes(picture.name) + " of " + std::to_string(picture.width) + " x " +
           std::to_string(picture.height) + " px, " +
           decimal(rule.scale * luminance(photometry::mean_colour(picture))) + " cd/m^2 in the mean, " +
           decimal(rule.luminance) + " at most";
}

}  // namespace vesper::scene
