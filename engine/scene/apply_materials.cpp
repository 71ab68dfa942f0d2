// Materials that emit, and what rules say of their surfaces. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "scene/apply_rules.h"
#include "scene/reflectance.h"

namespace vesper::scene {
namespace {

/// For each rule the materials it applies to: a material belongs to the first rule that matches it.
template <class Rule>
std::vector<std::vector<uint32_t>> assign(Application& application, const std::vector<Rule>& rules, const char* what) {
    const std::vector<Material>& materials = application.scene.materials;
    std::vector<std::vector<uint32_t>> taken(rules.size());
    std::vector<bool> matched(rules.size());
    for (uint32_t m = 0; m < materials.size(); ++m) {
        const std::string& name = materials[m].name;
        if (m == application.source.implied_material) continue;
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
            application.report.warnings.push_back(rule + ": no material matches " +
                                                  in_quotes(rules[r].materials.front()) +
                                                  (rules[r].materials.size() > 1 ? " or its other patterns" : ""));
        else if (taken[r].empty())
            application.report.warnings.push_back(rule + ": matches only materials that earlier rules have taken");
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

/// The picture a modulated emitter shines through: its own, or the base colour's.
TextureUse modulating(const Material& material) {
    return material.emission_texture.image != kNone ? material.emission_texture : material.base_colour_texture;
}

/// The scene's picture for a rule; each is there once.
uint32_t picture_of(Application& application, const EmitterRule& rule) {
    std::vector<uint32_t>& known = application.report.pictures;
    const auto same = std::find(known.begin(), known.end(), rule.picture);
    if (same != known.end()) return static_cast<uint32_t>(same - known.begin());
    const EmitterPicture& added = application.photometry.pictures[rule.picture];
    application.scene.luminance_pictures.push_back(added.picture);
    application.scene.luminance_pictures.back().name = one_line(added.picture.name);
    known.push_back(rule.picture);
    for (const std::string& note : added.notes)
        application.report.warnings.push_back("picture " + in_quotes(added.picture.name) + ": " + note);
    if (added.changed > 0)
        application.report.warnings.push_back("picture " + in_quotes(added.picture.name) + ": " +
                                              std::to_string(added.changed) +
                                              " pixels with negative components are drawn to grey, or black");
    if (rule.unit_unknown)
        application.report.warnings.push_back("picture " + in_quotes(added.picture.name) +
                                              ": does not say how much its value 1 is (whiteLuminance): taken for 1 "
                                              "cd/m^2; \"scale\" or \"luminance_cd_m2\" states it");
    return static_cast<uint32_t>(known.size() - 1);
}

/// The picture lies as the emission's texture or, without one, as the base colour's.
void show_picture(Application& application, const EmitterRule& rule, Material& material) {
    const bool own = material.emission_texture.image != kNone || material.base_colour_texture.image == kNone;
    material.emission_picture = own ? material.emission_texture : material.base_colour_texture;
    material.emission_picture.image = picture_of(application, rule);
    material.emission = glm::vec3(static_cast<float>(rule.scale));
    material.emission_texture = {};
}

std::string described_picture(const Application& application, const EmitterRule& rule) {
    const photometry::LuminancePicture& picture = application.photometry.pictures[rule.picture].picture;
    return "picture " + in_quotes(picture.name) + " of " + std::to_string(picture.width) + " x " +
           std::to_string(picture.height) + " px, " +
           decimal(rule.scale * luminance(photometry::mean_colour(picture))) + " cd/m^2 in the mean, " +
           decimal(rule.luminance) + " at most";
}

void make_emit(Application& application, const EmitterRule& rule, Material& material) {
    if (rule.picture != kNone) return show_picture(application, rule, material);
    double scale = rule.luminance;
    TextureUse texture;
    if (rule.modulate) {
        const TextureUse through = modulating(material);
        const double brightest =
            through.image != kNone ? brightest_texel(application.scene.images[through.image], rule.colour) : 0;
        if (brightest > 0) {
            texture = through;
            scale = rule.luminance / brightest;
        } else {
            application.report.warnings.push_back(
                "emitter " + in_quotes(rule.name) + ": material " + in_quotes(material.name) + " has " +
                (through.image != kNone ? "a black texture" : "no texture") + " to modulate with: it emits evenly");
        }
    }
    material.emission = glm::vec3(rule.colour * scale);
    material.emission_texture = material.emission != glm::vec3(0) ? texture : TextureUse{};
}

/// The glass of a lamp whose opening is drawn: it does not emit besides.
void leave_to_lamp(Material& material) {
    material.emission = glm::vec3(0);
    material.emission_texture = {};
}

/// Blended surfaces are drawn opaque while they emit: the glass of a lamp must not vanish while it shines.
void set_alpha(const Application& application, uint32_t index) {
    if (!marked(application.source.blended, index)) return;
    Material& material = application.scene.materials[index];
    material.alpha = material.emission != glm::vec3(0) ? Material::Alpha::Opaque : Material::Alpha::Mask;
}

void scale_reflectance(Application& application, const SurfaceRule& rule, Material& material) {
    bool limited = false;
    for (int c = 0; c < 3; ++c) {
        const double scaled = double(material.base_colour[c]) * rule.reflectance_scale;
        limited = limited || scaled > 1;
        material.base_colour[c] = static_cast<float>(std::min(scaled, 1.0));
    }
    if (limited)
        application.report.warnings.push_back("surface " + in_quotes(rule.name) + ": material " +
                                              in_quotes(material.name) +
                                              ": its factor cannot be more than 1 and is limited to that");
}

void set_roughness(Application& application, const SurfaceRule& rule, Material& material) {
    if (rule.roughness) material.roughness = static_cast<float>(*rule.roughness);
    if (rule.metallic) material.metallic = static_cast<float>(*rule.metallic);
    if (rule.roughness && rule.metallic)
        material.metallic_roughness_texture = {};
    else if ((rule.roughness || rule.metallic) && material.metallic_roughness_texture.image != kNone)
        application.report.warnings.push_back("surface " + in_quotes(rule.name) + ": material " +
                                              in_quotes(material.name) +
                                              " has a texture for it: what is stated multiplies that texture");
}

/// Coefficients are those of white: R_L is measured of the paint as it is, so what becomes of it is said.
void note_marking(Application& application, const SurfaceRule& rule, const Material& material, glm::vec4 stated) {
    const double reflectance = luminance(glm::min(glm::dvec3(stated) * rule.reflectance_scale, 1.0));
    const bool textured = material.base_colour_texture.image != kNone;
    if (!textured && reflectance > 0.995) return;
    application.report.warnings.push_back("surface " + in_quotes(rule.name) + ": material " + in_quotes(material.name) +
                                          ": R_L is " + (textured ? "at most " : "") +
                                          decimal(1000 * rule.retroreflector->coefficient.front() * reflectance) +
                                          " mcd/(m^2 lx): what is stated, times the base colour of " +
                                          decimal(reflectance) + (textured ? " and its texture" : ""));
}

/// The place of something in a list of the scene; what is equal is there once.
template <class T>
uint32_t index_in(std::vector<T>& list, const T& wanted) {
    const auto same = std::find(list.begin(), list.end(), wanted);
    if (same != list.end()) return static_cast<uint32_t>(same - list.begin());
    list.push_back(wanted);
    return static_cast<uint32_t>(list.size() - 1);
}

std::string described(const photometry::ReflectionTable& table) {
    return ", reflection table " + table.name + (table.stated_q0 > 0 ? " of Q0 " + decimal(table.stated_q0) : "");
}

std::string count_of(size_t materials) {
    return std::to_string(materials) + (materials == 1 ? " material" : " materials");
}

}  // namespace

void apply_materials(Application& application) {
    const Photometry& photometry = application.photometry;
    Scene& scene = application.scene;
    const auto emitting = assign(application, photometry.emitters, "emitter");
    const auto surfaces = assign(application, photometry.surfaces, "surface");
    check_sources(application, emitting);
    std::set<uint32_t> emitters;
    for (const auto& materials : emitting) emitters.insert(materials.begin(), materials.end());
    for (uint32_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        if (emitters.contains(m) || m == application.source.implied_material) continue;
        if (material.emission != glm::vec3(0))
            application.report.warnings.push_back("material " + in_quotes(material.name) + " emits " +
                                                  decimal(luminance(material.emission)) +
                                                  " cd/m^2 in the original and no emitter rule matches it: kept");
        else if (sounds_like_light(material.name))
            application.report.warnings.push_back("material " + in_quotes(material.name) +
                                                  " sounds like a light, but no emitter rule matches it");
    }
    for (size_t r = 0; r < emitting.size(); ++r) {
        const EmitterRule& rule = photometry.emitters[r];
        for (const uint32_t material : emitting[r]) {
            if (rule.lamps.empty())
                make_emit(application, rule, scene.materials[material]);
            else
                leave_to_lamp(scene.materials[material]);
            set_alpha(application, material);
        }
        if (!emitting[r].empty() && !rule.lamps.empty())
            application.report.changes.push_back("emitter " + in_quotes(rule.name) + ": " +
                                                 count_of(emitting[r].size()) + ", seen as the opening of lamp " +
                                                 in_quotes(rule.lamps.front()) +
                                                 (rule.lamps.size() > 1 ? " and others" : ""));
        else if (!emitting[r].empty() && rule.picture != kNone)
            application.report.changes.push_back("emitter " + in_quotes(rule.name) + ": " +
                                                 count_of(emitting[r].size()) + ", " +
                                                 described_picture(application, rule));
        else if (!emitting[r].empty())
            application.report.changes.push_back("emitter " + in_quotes(rule.name) + ": " +
                                                 count_of(emitting[r].size()) + ", " + decimal(rule.luminance) +
                                                 " cd/m^2" + (rule.modulate ? " at most" : ""));
    }
    for (size_t r = 0; r < surfaces.size(); ++r) {
        const SurfaceRule& rule = photometry.surfaces[r];
        for (const uint32_t m : surfaces[r]) {
            Material& material = scene.materials[m];
            const glm::vec4 stated = material.base_colour;
            scale_reflectance(application, rule, material);
            set_roughness(application, rule, material);
            if (rule.retroreflector && rule.retroreflector->marking) note_marking(application, rule, material, stated);
            if (rule.reflection_table)
                material.reflection_table = index_in(scene.reflection_tables, *rule.reflection_table);
            if (rule.retroreflector) material.retroreflector = index_in(scene.retroreflectors, *rule.retroreflector);
        }
        if (!surfaces[r].empty())
            application.report.changes.push_back(
                "surface " + in_quotes(rule.name) + ": " + count_of(surfaces[r].size()) + ", reflectance times " +
                decimal(rule.reflectance_scale) + (rule.roughness ? ", roughness " + decimal(*rule.roughness) : "") +
                (rule.metallic ? ", metallic " + decimal(*rule.metallic) : "") +
                (rule.reflection_table ? described(*rule.reflection_table) : "") +
                (rule.retroreflector ? ", retroreflection " + rule.retroreflector->name : ""));
    }
    if (scene.retroreflectors.size() > kMaxRetroreflectors)
        throw Error(application.name + ": " + std::to_string(scene.retroreflectors.size()) +
                    " kinds of retroreflection: " + std::to_string(kMaxRetroreflectors) + " are possible");
}

}  // namespace vesper::scene
