// Nodes that a template puts lamps on. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/angle.h"
#include "base/budget.h"
#include "base/decimal.h"
#include "scene/scene_warnings.h"
#include "scene/template_candidates.h"
#include "scene/template_patterns.h"
#include "scene/template_rules.h"

namespace vesper::scene {
namespace {

constexpr size_t kMostAbove = 3;     // nodes above one that may tell its kind
constexpr double kOffsetStep = 0.1;  // m: lamps of a rule differ by less

/// Whether the intensity of a light is that of a lamp: others are watts, or relative numbers.
bool is_plausible(const Lamp& light) {
    return double(light.intensity) >= kFaintestLamp && double(light.intensity) <= kBrightestLamp / 10;
}

/// Shape and intensity of the file's light where they are plausible.
bool add_light(const Lamp& light, nlohmann::ordered_json& rule) {
    const auto candela = static_cast<double>(light.intensity);
    if (light.kind != Lamp::Kind::Point && light.kind != Lamp::Kind::Spot) return false;
    if (!is_plausible(light)) return false;
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

/// Nodes that may share a rule.
struct Group {
    TemplateRule rule;
    std::string alike;                ///< the same of groups that differ by c0 and offset alone
    std::vector<uint32_t> matched{};  ///< by the patterns, when there are some
    bool arms = false;                ///< c0 is left out, as it differs
    double least = 0, most = 0;       ///< cd, of lights of the file that are no intensities of lamps; 0: none

    size_t size() const { return rule.members.size(); }
    void add_implausible(double candela) {
        least = most > 0 ? std::min(least, candela) : candela;
        most = std::max(most, candela);
    }
};

/// Makes one group of some that are alike, the largest first: with its offset, and without c0 where that differs.
Group merged(const std::vector<const Group*>& groups) {
    Group one = *groups[0];
    bool same_c0 = true, same_offset = true;
    for (const Group* const group : std::span(groups).subspan(1)) {
        const auto differs = [&](const char* key) {
            return one.rule.json.value(key, nlohmann::ordered_json()) !=
                   group->rule.json.value(key, nlohmann::ordered_json());
        };
        same_c0 = same_c0 && !differs("c0"), same_offset = same_offset && !differs("offset_m");
        one.rule.members.insert(one.rule.members.end(), group->rule.members.begin(), group->rule.members.end());
    }
    std::ranges::sort(one.rule.members);
    if (!same_c0) one.rule.json.erase("c0"), one.arms = true;
    if (!same_offset)
        one.rule.comment = "; offsets differ: \"offset_m\" is that of " + std::to_string(groups[0]->size()) + " nodes";
    return one;
}

void sort_by_size(std::vector<Group>& groups) {
    std::ranges::stable_sort(groups, [](const Group& a, const Group& b) { return a.size() > b.size(); });
}

/// Merges groups that are alike, of these names or all (null). Whether there were any.
bool merge(std::vector<Group>& groups, const std::set<std::string>* names) {
    std::map<std::string, std::vector<const Group*>> sets;
    for (const Group& group : groups) sets[group.alike].push_back(&group);
    std::vector<Group> made;
    for (const auto& [alike, set] : sets)
        if (set.size() > 1 && (!names || names->contains(alike)))
            made.push_back(merged(set));
        else
            for (const Group* const group : set) made.push_back(*group);
    const bool changed = made.size() < groups.size();
    groups = std::move(made);
    sort_by_size(groups);
    return changed;
}

/// Groups with their patterns; those that no patterns tell apart, or for which there is no room, are left out.
struct NamedGroups {
    std::vector<Group> groups;
    std::set<std::string> left_out;  ///< Group::alike
    size_t left_out_rules = 0, left_out_sources = 0;
};

NamedGroups named(const Scene& scene, const NameIndex& index, const std::vector<Group>& groups,
                  const std::vector<std::string>& texts) {
    NamedGroups made;
    std::vector<bool> taken(scene.nodes.size());
    for (Group group : groups) {
        check_time();
        std::vector<uint32_t>& members = group.rule.members;
        // A node gets a lamp from every rule that matches it: what another rule has taken by the same name is its own.
        std::erase_if(members, [&](uint32_t i) { return bool(taken[i]); });
        if (members.empty()) continue;
        std::vector<std::string> patterns;
        if (made.groups.size() < kMostTemplateRules) patterns = patterns_of(scene, index, members, texts);
        auto matched = index.matched(patterns);
        if (patterns.empty() || std::ranges::any_of(matched, [&](uint32_t i) { return bool(taken[i]); })) {
            ++made.left_out_rules, made.left_out_sources += members.size();
            made.left_out.insert(group.alike);
            continue;
        }
        for (const uint32_t i : matched) taken[i] = true;
        nlohmann::ordered_json json{{"nodes", json_of_patterns(patterns)}};
        json.update(group.rule.json);
        group.rule.json = std::move(json);
        group.matched = std::move(matched);
        made.groups.push_back(std::move(group));
    }
    return made;
}

/// Names the groups. Those that are alike are told apart only if this leaves none out.
NamedGroups named_or_merged(const Scene& scene, const NameIndex& index, std::vector<Group> groups,
                            const std::vector<std::string>& texts) {
    sort_by_size(groups);
    NamedGroups made = named(scene, index, groups, texts);
    for (const bool all : {false, true}) {
        if (made.left_out.empty()) break;
        if (merge(groups, all ? nullptr : &made.left_out)) made = named(scene, index, groups, texts);
    }
    return made;
}

std::string comment_of(const Group& group, const std::vector<LampPlace>& places) {
    const std::vector<uint32_t>& members = group.rule.members;
    glm::dvec3 mean(0);
    for (const uint32_t i : members) mean += places[i].world / double(members.size());
    std::string text = std::to_string(members.size()) + (members.size() == 1 ? " node at " : " nodes about ") +
                       decimal(mean.x, 4) + ", " + decimal(mean.y, 4) + ", " + decimal(mean.z, 4) + " m (x, up, z)";
    if (group.most > 0)
        text += "; not the " + decimal(group.least, 3) +
                (group.most > group.least ? " to " + decimal(group.most, 3) : "") + " cd of the file";
    if (group.rule.json.value("standard", "") == "street-lamp" && !group.rule.json.contains("c0"))
        text += std::string(group.arms ? "; arms differ" : "; no arm tells the road") +
                ": \"c0\" is its direction in the frame of the node";
    return text + group.rule.comment;
}

bool is_dark(const Lamp& light) {
    return !(light.intensity > 0) || !(std::max({light.colour.r, light.colour.g, light.colour.b}) > 0);
}

}  // namespace

std::vector<TemplateRule> lamp_rules(const Scene& scene, const SceneSource& source, const std::vector<bool>& shining,
                                     PhotometryTemplate& counts) {
    const LampPlaces find(scene, shining);
    const LampCandidates candidates(scene, source, find);
    std::vector<std::string> names, texts(scene.nodes.size());
    for (const Node& node : scene.nodes) names.push_back(node.name);
    const NameIndex index(names, &scene);
    std::map<std::string, Group> groups;
    std::vector<LampPlace> places(scene.nodes.size());
    size_t placed = 0;
    counts.parts = candidates.parts_left_out();
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const uint32_t lamp = scene.nodes[i].lamp;
        const Lamp* light = lamp == kNone ? nullptr : &scene.lamps[lamp];
        if (light && light->kind == Lamp::Kind::Directional) {
            ++counts.suns;
            continue;
        }
        if (marked(source.added, i)) continue;
        if (light && is_dark(*light)) light = nullptr, counts.dark += candidates.has(i) ? 0 : 1;
        if (!light && !candidates.has(i)) continue;
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
        places[i] = find.of(i, kind, light != nullptr, candidates.is_foot(scene.nodes[i].parent));
        const SourceKind& used = *kind.standard || kind.candela > 0 ? kind : plain_lamp();
        texts[i] = text_of(scene, i, &kind_of(std::span(parts).first(1)) != &plain_lamp());
        const nlohmann::ordered_json rule = rule_of(used, places[i], light);
        const SourceReason reason = light ? SourceReason::Light : SourceReason::Name;
        nlohmann::ordered_json elsewhere = rule;
        elsewhere.erase("c0"), elsewhere.erase("offset_m");
        const std::string family = family_of(texts[i]) + "\n", ending = used.name + std::string(name_of(reason));
        Group& group =
            groups
                .try_emplace(family + rule.dump() + ending,
                             Group{.rule = {reason, &used, {}, rule, {}}, .alike = family + elsewhere.dump() + ending})
                .first->second;
        group.rule.members.push_back(i);
        if (light && &used == &plain_lamp() && !is_plausible(*light)) group.add_implausible(double(light->intensity));
    }
    std::vector<Group> all;
    for (auto& [_, group] : groups) all.push_back(std::move(group));
    NamedGroups made = named_or_merged(scene, index, std::move(all), texts);
    counts.left_out_rules += made.left_out_rules, counts.left_out_sources += made.left_out_sources;
    std::vector<TemplateRule> rules;
    for (Group& group : made.groups) {
        TemplateRule& rule = group.rule;
        for (const uint32_t i : rule.members)
            rule.lamps.push_back({i, places[i].world, find.axis(i, places[i]), {}, {}});
        rule.comment = comment_of(group, places);
        rule.members = std::move(group.matched);
        rules.push_back(std::move(rule));
    }
    return rules;
}

}  // namespace vesper::scene
