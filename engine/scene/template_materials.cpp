// Materials that a template makes shine. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>

#include "base/decimal.h"
#include "base/luminance.h"
#include "scene/apply_rules.h"
#include "scene/reflectance.h"
#include "scene/template_patterns.h"
#include "scene/template_rules.h"

namespace vesper::scene {
namespace {

constexpr double kBright = 0.9;            // reflectance: no real surface has more (fresh snow)
constexpr uint32_t kSmallPicture = 64;     // px: a colour for a lamp, not a picture of a wall
constexpr double kSmallArea = 1;           // m^2, of a material without a picture
constexpr double kUnknownLuminance = 100;  // cd/m^2: between a lit window and a sign
constexpr double kBrightLuminance = 50;    // cd/m^2, of what may be white paint
constexpr double kGrey = 0.9;              // least over greatest component of what has no colour

/// Whether a material reflects more than real surfaces: a small picture, or a small surface, that is nearly white.
bool is_bright(const Scene& scene, const Material& m, const MaterialUse& use) {
    if (m.metallic > 0.5f || m.clear || !(use.area > 0)) return false;
    if (m.base_colour_texture.image != kNone) {
        const Image& picture = scene.images[m.base_colour_texture.image];
        if (std::max(picture.width, picture.height) > kSmallPicture) return false;
    } else if (use.area > kSmallArea) {
        return false;
    }
    return mean_reflectance(scene, m, use) > kBright;
}

struct Found {
    SourceReason reason;
    const SourceKind* kind;
};

std::optional<Found> source_of(const Scene& scene, const Material& m, const MaterialUse& use) {
    const auto parts = parts_of(m.name);
    const SourceKind& kind = kind_of(parts);
    if (m.emission != glm::vec3(0)) return Found{SourceReason::Emission, &kind};
    if (sounds_like_light(m.name) || is_window(parts[0]) || says_lit(parts[0]) || is_signal_colour(parts) ||
        is_vehicle_lamp(parts[0]))
        return Found{SourceReason::Name, &kind};
    if (is_bright(scene, m, use)) return Found{SourceReason::Bright, &kind};
    return std::nullopt;
}

bool is_known(const SourceKind& kind) { return &kind != &plain_lamp(); }

double luminance_of(const Found& found) {
    if (is_known(*found.kind) || found.reason == SourceReason::Name) return found.kind->luminance;
    return found.reason == SourceReason::Bright ? kBrightLuminance : kUnknownLuminance;
}

bool has_colour(glm::vec3 c) {
    const double most = std::max({double(c.r), double(c.g), double(c.b)});
    const double least = std::min({double(c.r), double(c.g), double(c.b)});
    return most > 0 && least < kGrey * most;
}

bool is_black(const Image& picture) {
    for (size_t i = 0; i + 3 < picture.rgba.size(); i += 4)
        if (picture.rgba[i] || picture.rgba[i + 1] || picture.rgba[i + 2]) return false;
    return true;
}

/// A rule without its patterns.
nlohmann::ordered_json rule_of(const Scene& scene, const Material& m, const Found& found) {
    nlohmann::ordered_json rule;
    rule["luminance_cd_m2"] = rounded(luminance_of(found));
    const TextureUse& texture =
        m.emission_texture.image != kNone && m.emission != glm::vec3(0) ? m.emission_texture : m.base_colour_texture;
    const bool modulate = texture.image != kNone && !is_black(scene.images[texture.image]);
    const glm::vec3 colour = found.reason == SourceReason::Emission ? m.emission : glm::vec3(m.base_colour);
    // A kind without a temperature has a colour by law: that of a tail lamp.
    if (is_known(*found.kind) && found.kind->kelvin == 0)
        rule["colour_rgb"] = rounded(found.kind->colour);
    else if (has_colour(colour)) {
        const float most = std::max({colour.r, colour.g, colour.b});
        rule["colour_rgb"] = rounded(glm::dvec3(colour / most));
    } else if (!modulate && found.kind->kelvin > 0) {
        rule["colour_temperature_K"] = rounded(found.kind->kelvin);
    }
    if (modulate) rule["modulate"] = true;
    return rule;
}

std::string comment_of(const std::vector<uint32_t>& members, const std::vector<MaterialUse>& uses) {
    double area = 0;
    for (const uint32_t m : members) area += uses[m].area;
    return std::to_string(members.size()) + (members.size() == 1 ? " material, " : " materials, ") + decimal(area, 3) +
           " m^2";
}

}  // namespace

std::vector<TemplateRule> emitter_rules(const Scene& scene, const SceneSource& source, PhotometryTemplate& counts) {
    const std::vector<MaterialUse> uses = material_uses(scene);
    std::vector<std::string> names;
    for (const Material& m : scene.materials) names.push_back(m.name);
    const NameIndex index(names);
    std::map<std::string, TemplateRule> groups;
    for (uint32_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        if (i == source.implied_material) continue;
        const auto found = source_of(scene, m, uses[i]);
        if (!found) continue;
        if (m.name.empty()) {
            ++counts.nameless;
            continue;
        }
        nlohmann::ordered_json rule = rule_of(scene, m, *found);
        const std::string key = family_of(m.name) + "\n" + rule.dump() + name_of(found->reason);
        TemplateRule& group =
            groups.try_emplace(key, TemplateRule{found->reason, found->kind, {}, rule, {}}).first->second;
        group.members.push_back(i);
    }
    std::vector<TemplateRule> rules;
    std::vector<bool> taken(scene.materials.size());
    for (auto& [_, group] : groups) {
        // Materials of one name that differ go with the first of them.
        std::erase_if(group.members, [&](uint32_t i) { return bool(taken[i]); });
        if (group.members.empty()) continue;
        std::vector<std::string> texts;
        for (const uint32_t i : group.members) texts.push_back(names[i]);
        const auto patterns = patterns_for(index, group.members, texts);
        if (patterns.empty()) {
            ++counts.left_out_rules, counts.left_out_sources += group.members.size();
            continue;
        }
        for (const uint32_t i : index.matched(patterns)) taken[i] = true;
        nlohmann::ordered_json json{{"materials", json_of_patterns(patterns)}};
        json.update(group.json);
        group.json = std::move(json);
        group.comment = comment_of(group.members, uses);
        rules.push_back(std::move(group));
    }
    const auto area = [&](const TemplateRule& rule) {
        double sum = 0;
        for (const uint32_t i : rule.members) sum += uses[i].area;
        return sum;
    };
    std::ranges::stable_sort(rules, [&](const auto& a, const auto& b) { return area(a) > area(b); });
    return rules;
}

}  // namespace vesper::scene
