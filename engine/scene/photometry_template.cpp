// The text of a photometry file that is ready to fill in. SPDX-License-Identifier: MIT
#include "scene/photometry_template.h"

#include <cmath>
#include <map>

#include "base/one_line.h"
#include "scene/template_rules.h"

namespace vesper::scene {
namespace {

/// On one line; names that are no UTF-8 are made so.
std::string line_of(const nlohmann::ordered_json& json) {
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Adds name and comment; names are those of the kinds, numbered where a kind has several rules.
nlohmann::ordered_json finished(const TemplateRule& rule, const std::string& what, size_t number) {
    nlohmann::ordered_json json;
    json["name"] = number > 1 ? what + " " + std::to_string(number) : what;
    json["comment"] = "suggestion, by " + std::string(name_of(rule.reason)) + ": " + rule.comment;
    json.update(rule.json);
    return json;
}

/// One rule a line. Counts the rules; beyond the limit they are left out.
std::string written(const char* key, const std::vector<TemplateRule>& rules, const char* ending,
                    PhotometryTemplate& made, size_t& number) {
    std::string text;
    std::map<std::string, size_t> used;
    for (const TemplateRule& rule : rules) {
        if (number == kMostTemplateRules) {
            ++made.left_out_rules, made.left_out_sources += rule.members.size();
            continue;
        }
        const std::string what = rule.kind->name + std::string(ending);
        text += (number++ ? ",\n    " : "\n    ") + line_of(finished(rule, what, ++used[what]));
        ++made.rules[size_t(rule.reason)];
        made.sources[size_t(rule.reason)] += rule.members.size();
    }
    return ",\n  \"" + std::string(key) + "\": [" + text + (number ? "\n  ]" : "]");
}

}  // namespace

const char* name_of(SourceReason reason) {
    constexpr std::array<const char*, kSourceReasons> kNames{"light of the file", "emission", "name", "bright"};
    return kNames[size_t(reason)];
}

nlohmann::ordered_json rounded(double value) {
    const double near = std::round(value * 1000) / 1000;
    if (near == std::round(near) && std::abs(near) < 1e15) return static_cast<int64_t>(near);
    return near;
}

nlohmann::ordered_json rounded(glm::dvec3 v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

nlohmann::ordered_json json_of_patterns(const std::vector<std::string>& patterns) {
    return patterns.size() == 1 ? nlohmann::ordered_json(patterns[0]) : nlohmann::ordered_json(patterns);
}

PhotometryTemplate make_photometry_template(const Scene& scene, const std::string& name, const SceneSource& source) {
    PhotometryTemplate made;
    std::vector<TemplateRule> emitters = emitter_rules(scene, source, made);
    std::vector<bool> shining(scene.materials.size());
    for (const TemplateRule& rule : emitters)
        for (const uint32_t material : rule.members) shining[material] = true;
    const std::vector<TemplateRule> lamps = lamp_rules(scene, source, shining, made);
    match_glass(scene, emitters, lamps);
    const nlohmann::ordered_json comment =
        "Suggestions for " + one_line(name) + ": usual values, none of them measured there. Check and correct each.";
    made.text = "{\n  \"version\": 1,\n  \"comment\": " + line_of(comment) +
                written("lamps", lamps, "", made, made.lamps) +
                written("emitters", emitters, " surface", made, made.emitters) + "\n}\n";
    return made;
}

}  // namespace vesper::scene
