// Nodes that a template puts lamps on. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/angle.h"
#include "base/budget.h"
#include "base/decimal.h"
#include "scene/apply_rules.h"
#include "scene/scene_warnings.h"
#include "scene/template_patterns.h"
#include "scene/template_rules.h"

namespace vesper::scene {
namespace {

constexpr size_t kMostAbove = 3;     // nodes above one that may tell its kind
constexpr double kOffsetStep = 0.1;  // m: lamps of a rule differ by less

using Words = std::vector<std::string>;

/// Parts of a lamp that do not shine, or are told by another part.
constexpr std::string_view kPassive[] = {"pole",   "post",  "mast",    "base",   "foot",  "arm",    "bracket", "mount",
                                         "socket", "cable", "housing", "holder", "frame", "stand",  "box",     "glass",
                                         "cover",  "shade", "lens",    "metal",  "chain", "switch", "collider"};

bool is_passive(const Words& words) {
    return std::ranges::any_of(
        words, [](const std::string& word) { return std::ranges::find(kPassive, word) != std::end(kPassive); });
}

/// The words of a name that another does not have, as a name.
std::string added_words(const Words& words, const Words& known) {
    std::string added;
    for (const std::string& word : words)
        if (std::ranges::find(known, word) == known.end()) added += word + " ";
    return added;
}

/// Chooses nodes by their names: of an object whose parts are named, the part that shines.
class Candidates {
public:
    Candidates(const Scene& scene, const SceneSource& source) : scene_(scene), sounding_(scene.nodes.size()) {
        const std::vector<Node>& nodes = scene.nodes;
        std::vector<uint32_t> above(nodes.size(), kNone);          // the nearest node above that sounds like a lamp
        std::map<std::pair<uint32_t, std::string>, size_t> alike;  // nodes of a family below each parent
        for (uint32_t i = 0; i < nodes.size(); ++i) {
            check_time();
            const uint32_t parent = nodes[i].parent;
            if (parent != kNone) above[i] = sounding_[parent] ? parent : above[parent];
            if (marked(source.added, i)) continue;
            sounding_[i] = sounds_like_light(nodes[i].name) || is_signal_colour(parts(i, 1)) ||
                           is_vehicle_lamp(parts_of(nodes[i].name)[0]);
            if (sounding_[i]) ++alike[{parent, family_of(nodes[i].name)}];
        }
        for (uint32_t i = 0; i < nodes.size(); ++i) {
            if (!sounding_[i]) continue;
            uint32_t holder = above[i];
            while (holder != kNone && !sounding_[holder]) holder = above[holder];
            if (holder == kNone) continue;
            const std::string added = added_words(parts_of(nodes[i].name)[0], parts_of(nodes[holder].name)[0]);
            const bool copy = alike[{nodes[i].parent, family_of(nodes[i].name)}] > 1 && added.empty();
            if (copy || sounds_like_light(added) || is_signal_colour(parts(i, 1)))
                covered_.insert(holder);
            else
                sounding_[i] = false;  // "street_lamp_01/street_lamp_01_mesh" says nothing that the node above does not
        }
        drop_other_parts();
    }

    bool has(uint32_t i) const { return sounding_[i] && !covered_.contains(i); }

    /// The parts of a node's name and of as many names above it.
    std::vector<Words> parts(uint32_t i, size_t most_above) const {
        std::vector<Words> all;
        for (size_t level = 0; i != kNone && level <= most_above; ++level, i = scene_.nodes[i].parent)
            for (Words& words : parts_of(scene_.nodes[i].name)) all.push_back(std::move(words));
        return all;
    }

private:
    /// Where lamps below a node have kinds, "lamps" beside them is their glass; beside "lamp_head", so is "lamp_pole".
    /// Below "street_lamp_01", a mesh is the body of the "light" that has none.
    void drop_other_parts() {
        std::set<uint32_t> known, meshless;
        std::set<std::pair<uint32_t, std::string>> active;
        std::vector<uint32_t> found;
        for (uint32_t i = 0; i < sounding_.size(); ++i) {
            if (!has(i)) continue;
            found.push_back(i);
            const auto own = parts_of(scene_.nodes[i].name);
            const uint32_t parent = scene_.nodes[i].parent;
            if (&kind_of(std::span(own).first(1)) != &plain_lamp()) known.insert(parent);
            if (scene_.nodes[i].mesh == kNone) meshless.insert(parent);
            if (!own[0].empty() && !is_passive(own[0])) active.insert({parent, own[0][0]});
        }
        for (const uint32_t i : found) {
            const Words own = parts_of(scene_.nodes[i].name)[0];
            const uint32_t parent = scene_.nodes[i].parent;
            const bool below = parent != kNone && scene_.nodes[i].mesh != kNone;
            const bool glass = below && known.contains(parent) && &kind_of(parts(i, 0)) == &plain_lamp();
            const bool body = below && covered_.contains(parent) && meshless.contains(parent);
            const bool other = is_passive(own) && active.contains({parent, own[0]});
            if (glass || body || other) sounding_[i] = false;
        }
    }

    const Scene& scene_;
    std::vector<bool> sounding_;
    std::set<uint32_t> covered_;
};

/// Shape and intensity of the file's light where they are plausible.
bool add_light(const Lamp& light, nlohmann::ordered_json& rule) {
    const auto candela = static_cast<double>(light.intensity);
    if (light.kind != Lamp::Kind::Point && light.kind != Lamp::Kind::Spot) return false;
    if (candela < kFaintestLamp || candela > kBrightestLamp / 10) return false;  // watts, or a relative number
    rule["type"] = light.kind == Lamp::Kind::Spot ? "spot" : "point";
    rule["intensity_cd"] = rounded(candela);
    if (light.kind == Lamp::Kind::Spot) {
        const double outer = std::clamp(double(light.outer_cone) * kDegreesPerRadian, 0.5, 90.0);
        rule["inner_cone_deg"] = rounded(std::min(double(light.inner_cone) * kDegreesPerRadian, outer));
        rule["outer_cone_deg"] = rounded(outer);
    }
    rule["colour_rgb"] = rounded(glm::dvec3(light.colour));
    return true;
}

/// A rule without its patterns.
nlohmann::ordered_json rule_of(const SourceKind& kind, const LampPlace& place, const Lamp* light) {
    nlohmann::ordered_json rule;
    if (!light || &kind != &plain_lamp() || !add_light(*light, rule)) {
        if (*kind.standard) {
            rule["type"] = "distribution", rule["standard"] = kind.standard;
        } else {
            rule["type"] = kind.outer > 0 ? "spot" : "point";
            rule["intensity_cd"] = rounded(kind.candela);
            if (kind.outer > 0)
                rule["inner_cone_deg"] = rounded(kind.inner), rule["outer_cone_deg"] = rounded(kind.outer);
        }
        if (kind.kelvin > 0)
            rule["colour_temperature_K"] = rounded(kind.kelvin);
        else
            rule["colour_rgb"] = rounded(kind.colour);
    }
    if (place.aim && rule["type"] != "point") rule["aim"] = rounded(*place.aim);
    if (place.c0 && rule.contains("standard")) rule["c0"] = rounded(*place.c0);
    if (place.offset != glm::dvec3(0)) {
        nlohmann::ordered_json offset;
        for (int axis = 0; axis < 3; ++axis)
            offset.push_back(rounded(std::round(place.offset[axis] / kOffsetStep) * kOffsetStep));
        if (offset != rounded(glm::dvec3(0))) rule["offset_m"] = offset;
    }
    if (kind.width > 0) {
        nlohmann::ordered_json opening{{"width_m", kind.width}};
        if (kind.round)
            opening["round"] = true;
        else
            opening["height_m"] = kind.height;
        if (place.surface) opening["drawn"] = false;  // a surface of the scene shows the lamp
        rule["opening"] = opening;
    }
    return rule;
}

/// The text by which a node is matched: with the name above it where its own does not tell its kind.
std::string text_of(const Scene& scene, uint32_t i, bool own_kind) {
    const std::string& name = scene.nodes[i].name;
    const uint32_t parent = scene.nodes[i].parent;
    if (own_kind || parent == kNone || name.find('/') != name.npos) return name;
    const std::string& above = scene.nodes[parent].name;
    return above.empty() || above.find('/') != above.npos ? name : above + "/" + name;
}

/// Patterns for nodes by these texts, or with the names above them where other nodes have the same names.
std::vector<std::string> patterns_of(const Scene& scene, const NameIndex& index, const std::vector<uint32_t>& nodes,
                                     const std::vector<std::string>& texts) {
    std::vector<std::string> own, paths;
    for (const uint32_t i : nodes) own.push_back(texts[i]), paths.push_back(text_of(scene, i, false));
    std::vector<std::string> patterns = patterns_for(index, nodes, own);
    if (own == paths || index.matched(patterns) == nodes) return patterns;
    std::vector<std::string> longer = patterns_for(index, nodes, paths);
    return index.matched(longer) == nodes ? longer : patterns;
}

std::string comment_of(const std::vector<uint32_t>& members, const std::vector<LampPlace>& places) {
    glm::dvec3 mean(0);
    for (const uint32_t i : members) mean += places[i].world / double(members.size());
    return std::to_string(members.size()) + (members.size() == 1 ? " node at " : " nodes about ") + decimal(mean.x, 4) +
           ", " + decimal(mean.y, 4) + ", " + decimal(mean.z, 4) + " m (x, up, z)";
}

}  // namespace

std::vector<TemplateRule> lamp_rules(const Scene& scene, const SceneSource& source, const std::vector<bool>& shining,
                                     PhotometryTemplate& counts) {
    const Candidates candidates(scene, source);
    const LampPlaces find(scene, shining);
    std::vector<std::string> names, texts(scene.nodes.size());
    for (const Node& node : scene.nodes) names.push_back(node.name);
    const NameIndex index(names, &scene);
    std::map<std::string, TemplateRule> groups;
    std::vector<LampPlace> places(scene.nodes.size());
    size_t placed = 0;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const uint32_t lamp = scene.nodes[i].lamp;
        const Lamp* const light = lamp == kNone ? nullptr : &scene.lamps[lamp];
        if (light && light->kind == Lamp::Kind::Directional) {
            ++counts.suns;
            continue;
        }
        if (marked(source.added, i) || (!light && !candidates.has(i))) continue;
        const auto parts = candidates.parts(i, kMostAbove);
        const SourceKind& kind = kind_of(parts);
        if (!*kind.standard && !(kind.candela > 0) && !light) continue;  // a surface alone
        if (names[i].empty()) {
            ++counts.nameless;
            continue;
        }
        if (++placed > kMaxLamps) {
            ++counts.left_out_sources;
            continue;
        }
        places[i] = find.of(i, kind, light != nullptr);
        const SourceKind& used = *kind.standard || kind.candela > 0 ? kind : plain_lamp();
        texts[i] = text_of(scene, i, &kind_of(std::span(parts).first(1)) != &plain_lamp());
        nlohmann::ordered_json rule = rule_of(used, places[i], light);
        const SourceReason reason = light ? SourceReason::Light : SourceReason::Name;
        const std::string key = family_of(texts[i]) + "\n" + rule.dump() + used.name + name_of(reason);
        TemplateRule& group = groups.try_emplace(key, TemplateRule{reason, &used, {}, rule, {}}).first->second;
        group.members.push_back(i);
    }
    std::vector<TemplateRule> rules, sorted;
    for (auto& [_, group] : groups) sorted.push_back(std::move(group));
    std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) { return a.members.size() > b.members.size(); });
    std::vector<bool> taken(scene.nodes.size());
    for (TemplateRule& group : sorted) {
        // A node gets a lamp from every rule that matches it: what another rule has taken by the same name is its own.
        std::erase_if(group.members, [&](uint32_t i) { return bool(taken[i]); });
        if (group.members.empty()) continue;
        std::vector<std::string> patterns;
        if (rules.size() < kMostTemplateRules) patterns = patterns_of(scene, index, group.members, texts);
        const auto matched = index.matched(patterns);
        if (patterns.empty() || std::ranges::any_of(matched, [&](uint32_t i) { return bool(taken[i]); })) {
            ++counts.left_out_rules, counts.left_out_sources += group.members.size();
            continue;
        }
        for (const uint32_t i : matched) taken[i] = true;
        nlohmann::ordered_json json{{"nodes", json_of_patterns(patterns)}};
        json.update(group.json);
        group.comment = comment_of(group.members, places);
        if (json.value("standard", "") == "street-lamp" && !json.contains("c0"))
            group.comment += "; no arm tells the road: \"c0\" is its direction in the frame of the node";
        group.json = std::move(json);
        for (const uint32_t i : group.members)
            group.lamps.push_back({i, places[i].world, find.axis(i, places[i]), {}, {}});
        group.members = matched;
        rules.push_back(std::move(group));
    }
    return rules;
}

}  // namespace vesper::scene
