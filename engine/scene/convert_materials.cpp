// Materials that emit, and what rules say of their surfaces. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/luminance.h"
#include "scene/convert_rules.h"
#include "scene/photometry_parts.h"
#include "scene/reflectance.h"
#include "scene/reflection_json.h"

namespace vesper::scene {
namespace {

using nlohmann::json;
constexpr const char* kStrength = "KHR_materials_emissive_strength";

/// For each rule the materials it applies to: a material belongs to the first rule that matches it.
template <class Rule>
std::vector<std::vector<uint32_t>> assign(Conversion& conversion, const std::vector<Rule>& rules, const char* what) {
    const auto materials = conversion.document.list("materials");
    std::vector<std::vector<uint32_t>> taken(rules.size());
    std::vector<bool> matched(rules.size());
    for (uint32_t m = 0; m < materials.size(); ++m) {
        const std::string name = materials[m].text_or("name", "");
        bool free = true;
        for (size_t r = 0; r < rules.size(); ++r) {
            const auto& patterns = rules[r].materials;
            if (std::none_of(patterns.begin(), patterns.end(), [&](const auto& p) { return matches_name(p, name); }))
                continue;
            matched[r] = true;
            if (free) taken[r].push_back(m);
            free = false;
        }
    }
    for (size_t r = 0; r < rules.size(); ++r) {
        const std::string rule = std::string(what) + " " + in_quotes(rules[r].name);
        if (!matched[r])
            conversion.report.warnings.push_back(rule + ": no material matches " +
                                                 in_quotes(rules[r].materials.front()) +
                                                 (rules[r].materials.size() > 1 ? " or its other patterns" : ""));
        else if (taken[r].empty())
            conversion.report.warnings.push_back(rule + ": matches only materials that earlier rules have taken");
    }
    return taken;
}

/// Largest luminance of an sRGB-coded picture under a light of this colour.
double brightest_texel(const Image& image, glm::dvec3 colour) {
    const std::array<double, 256> linear = linear_codes({.kind = Transfer::Kind::Srgb});
    double brightest = 0;
    for (size_t i = 0; i < image.rgba.size(); i += 4)
        brightest = std::max(brightest, luminance(colour * glm::dvec3(linear[image.rgba[i]], linear[image.rgba[i + 1]],
                                                                      linear[image.rgba[i + 2]])));
    return brightest;
}

/// The texture a modulated emitter shines through, as its JSON and picture: its own, or the base colour's.
std::pair<json, const Image*> emission_texture(const Conversion& conversion, const json& source,
                                               const Material& material) {
    const std::vector<Image>& images = conversion.original.scene.images;
    if (material.emission_texture.image != kNone)
        return {source["emissiveTexture"], &images[material.emission_texture.image]};
    if (material.base_colour_texture.image == kNone) return {json(), nullptr};
    const Image* image = &images[material.base_colour_texture.image];
    if (source.contains("extensions") && source["extensions"].contains(kSpecularGlossiness))
        return {source["extensions"][kSpecularGlossiness]["diffuseTexture"], image};
    return {source["pbrMetallicRoughness"]["baseColorTexture"], image};
}

/// The glass of a lamp whose opening is drawn: it does not emit besides.
void leave_to_lamp(Conversion& conversion, uint32_t index) {
    json& material = conversion.document.edit()["materials"][index];
    material.erase("emissiveTexture");
    material.erase("emissiveFactor");
    const auto extensions = material.find("extensions");
    if (extensions == material.end() || !extensions->is_object()) return;
    extensions->erase(kStrength);
    if (extensions->empty()) material.erase("extensions");
}

void make_emit(Conversion& conversion, const EmitterRule& rule, uint32_t index) {
    glm::dvec3 emitted = rule.colour;
    double scale = rule.luminance;
    if (rule.picture != kNone) emitted = show_picture(conversion, rule, index), scale = 1;
    json& root = conversion.document.edit();
    json& material = root["materials"][index];
    const Material& original = conversion.original.scene.materials[index];
    json texture;
    if (rule.modulate) {
        const auto [info, image] = emission_texture(conversion, material, original);
        const double brightest = image ? brightest_texel(*image, rule.colour) : 0;
        if (brightest > 0) {
            texture = info;
            scale = rule.luminance / brightest;
        } else {
            conversion.report.warnings.push_back(
                "emitter " + in_quotes(rule.name) + ": material " + in_quotes(original.name) + " has " +
                (image ? "a black texture" : "no texture") + " to modulate with: it emits evenly");
        }
    }
    material.erase("emissiveTexture");
    if (!texture.is_null()) material["emissiveTexture"] = texture;
    // The format wants factors of at most 1; the strength carries the unit.
    const double largest = std::max({emitted.r, emitted.g, emitted.b});
    const glm::dvec3 factor = largest > 0 ? emitted / largest : glm::dvec3(0);
    material["emissiveFactor"] = {factor.r, factor.g, factor.b};
    json& extensions = object_member(conversion.document, material, "extensions");
    extensions[kStrength] = {{"emissiveStrength", scale * largest}};
    use_extension(root, kStrength);
}

void scale_reflectance(Conversion& conversion, const SurfaceRule& rule, json& material, const Material& original) {
    if (rule.reflectance_scale == 1) return;
    const bool other_model = material.contains("extensions") && material["extensions"].contains(kSpecularGlossiness);
    json& model = other_model ? material["extensions"][kSpecularGlossiness]
                              : object_member(conversion.document, material, "pbrMetallicRoughness");
    glm::dvec4 factor(original.base_colour);
    bool limited = false;
    for (int c = 0; c < 3; ++c) {
        factor[c] *= rule.reflectance_scale;
        limited = limited || factor[c] > 1;
        factor[c] = std::min(factor[c], 1.0);
    }
    model[other_model ? "diffuseFactor" : "baseColorFactor"] = {factor.r, factor.g, factor.b, factor.a};
    if (limited)
        conversion.report.warnings.push_back("surface " + in_quotes(rule.name) + ": material " +
                                             in_quotes(original.name) +
                                             ": its factor cannot be more than 1 and is limited to that");
}

void set_roughness(Conversion& conversion, const SurfaceRule& rule, json& material, const Material& original) {
    if (!rule.roughness && !rule.metallic) return;
    json& model = object_member(conversion.document, material, "pbrMetallicRoughness");
    if (rule.roughness) model["roughnessFactor"] = *rule.roughness;
    if (rule.metallic) model["metallicFactor"] = *rule.metallic;
    if (rule.roughness && rule.metallic)
        model.erase("metallicRoughnessTexture");
    else if (model.contains("metallicRoughnessTexture"))
        conversion.report.warnings.push_back("surface " + in_quotes(rule.name) + ": material " +
                                             in_quotes(original.name) +
                                             " has a texture for it: what is stated multiplies that texture");
    if (material.contains("extensions") && material["extensions"].contains(kSpecularGlossiness) && rule.roughness)
        material["extensions"][kSpecularGlossiness]["glossinessFactor"] = 1 - *rule.roughness;
}

/// Coefficients are those of white: R_L is measured of the paint as it is, so what becomes of it is said.
void note_marking(Conversion& conversion, const SurfaceRule& rule, const Material& original) {
    const double reflectance = luminance(glm::min(glm::dvec3(original.base_colour) * rule.reflectance_scale, 1.0));
    const bool textured = original.base_colour_texture.image != kNone;
    if (!textured && reflectance > 0.995) return;
    conversion.report.warnings.push_back("surface " + in_quotes(rule.name) + ": material " + in_quotes(original.name) +
                                         ": R_L is " + (textured ? "at most " : "") +
                                         decimal(1000 * rule.retroreflector->coefficient.front() * reflectance) +
                                         " mcd/(m^2 lx): what is stated, times the base colour of " +
                                         decimal(reflectance) + (textured ? " and its texture" : ""));
}

/// The place of something in a list of the extras block; what is equal is stored once.
size_t index_in(json& tables, const json& whole) {
    const auto same = std::find(tables.begin(), tables.end(), whole);
    if (same != tables.end()) return static_cast<size_t>(same - tables.begin());
    tables.push_back(whole);
    return tables.size() - 1;
}

std::string described(const photometry::ReflectionTable& table) {
    return ", reflection table " + table.name + (table.stated_q0 > 0 ? " of Q0 " + decimal(table.stated_q0) : "");
}

std::string count_of(size_t materials) {
    return std::to_string(materials) + (materials == 1 ? " material" : " materials");
}

}  // namespace

void convert_materials(Conversion& conversion) {
    const Photometry& photometry = conversion.photometry;
    const auto emitting = assign(conversion, photometry.emitters, "emitter");
    const auto surfaces = assign(conversion, photometry.surfaces, "surface");
    check_sources(conversion, emitting);
    std::set<uint32_t> emitters;
    for (const auto& materials : emitting) emitters.insert(materials.begin(), materials.end());
    for (uint32_t m = 0; m < conversion.document.list("materials").size(); ++m) {
        if (emitters.contains(m)) continue;
        const Material& material = conversion.original.scene.materials[m];
        if (material.emission != glm::vec3(0))
            conversion.report.warnings.push_back("material " + in_quotes(material.name) + " emits " +
                                                 decimal(luminance(material.emission)) +
                                                 " cd/m^2 in the original and no emitter rule matches it: kept");
        else if (sounds_like_light(material.name))
            conversion.report.warnings.push_back("material " + in_quotes(material.name) +
                                                 " sounds like a light, but no emitter rule matches it");
    }
    for (size_t r = 0; r < emitting.size(); ++r) {
        const EmitterRule& rule = photometry.emitters[r];
        for (const uint32_t material : emitting[r]) {
            if (rule.lamps.empty())
                make_emit(conversion, rule, material);
            else
                leave_to_lamp(conversion, material);
        }
        if (!emitting[r].empty() && !rule.lamps.empty())
            conversion.report.changes.push_back("emitter " + in_quotes(rule.name) + ": " +
                                                count_of(emitting[r].size()) + ", seen as the opening of lamp " +
                                                in_quotes(rule.lamps.front()) +
                                                (rule.lamps.size() > 1 ? " and others" : ""));
        else if (!emitting[r].empty() && rule.picture != kNone)
            conversion.report.changes.push_back("emitter " + in_quotes(rule.name) + ": " +
                                                count_of(emitting[r].size()) + ", " +
                                                described_picture(conversion, rule));
        else if (!emitting[r].empty())
            conversion.report.changes.push_back("emitter " + in_quotes(rule.name) + ": " +
                                                count_of(emitting[r].size()) + ", " + decimal(rule.luminance) +
                                                " cd/m^2" + (rule.modulate ? " at most" : ""));
    }
    for (size_t r = 0; r < surfaces.size(); ++r) {
        const SurfaceRule& rule = photometry.surfaces[r];
        for (const uint32_t m : surfaces[r]) {
            json& material = conversion.document.edit()["materials"][m];
            scale_reflectance(conversion, rule, material, conversion.original.scene.materials[m]);
            set_roughness(conversion, rule, material, conversion.original.scene.materials[m]);
            if (rule.reflection_table)
                conversion.roads.push_back(
                    {{"material", m},
                     {"table", index_in(conversion.reflection_tables, json_of(*rule.reflection_table))}});
            if (rule.retroreflector && rule.retroreflector->marking)
                note_marking(conversion, rule, conversion.original.scene.materials[m]);
            if (rule.retroreflector)
                conversion.retroreflective.push_back(
                    {{"material", m},
                     {"retroreflector", index_in(conversion.retroreflectors, json_of(*rule.retroreflector))}});
        }
        if (!surfaces[r].empty())
            conversion.report.changes.push_back(
                "surface " + in_quotes(rule.name) + ": " + count_of(surfaces[r].size()) + ", reflectance times " +
                decimal(rule.reflectance_scale) + (rule.roughness ? ", roughness " + decimal(*rule.roughness) : "") +
                (rule.metallic ? ", metallic " + decimal(*rule.metallic) : "") +
                (rule.reflection_table ? described(*rule.reflection_table) : "") +
                (rule.retroreflector ? ", retroreflection " + rule.retroreflector->name : ""));
    }
    if (conversion.retroreflectors.size() > kMaxRetroreflectors)
        throw Error(conversion.document.name() + ": " + std::to_string(conversion.retroreflectors.size()) +
                    " kinds of retroreflection: " + std::to_string(kMaxRetroreflectors) + " are possible");
}

}  // namespace vesper::scene
