// Lamps on nodes: photometry rules to KHR_lights_punctual and EXT_lights_ies. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "base/angle.h"
#include "photometry/ies.h"
#include "scene/convert_rules.h"
#include "scene/lamp.h"
#include "scene/photometry_measured.h"
#include "scene/uri.h"

namespace vesper::scene {
namespace {

using nlohmann::json;
constexpr const char *kLights = "KHR_lights_punctual", *kMeasured = "EXT_lights_ies";

std::string number_of(size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

void remove_extension(json& holder) {
    const auto extensions = holder.find("extensions");
    if (extensions == holder.end()) return;
    if (extensions->is_object())
        for (const char* name : {kLights, kMeasured}) extensions->erase(name);
    if (extensions->empty()) holder.erase("extensions");
}

void remove_from_list(json& root, const char* list) {
    const auto names = root.find(list);
    if (names == root.end()) return;
    for (const char* name : {kLights, kMeasured})
        names->erase(std::remove(names->begin(), names->end(), json(name)), names->end());
    if (names->empty()) root.erase(list);
}

void remove_lights(Conversion& conversion) {
    const std::vector<Lamp>& lamps = conversion.original.scene.lamps;
    json& root = conversion.document.edit();
    remove_extension(root);
    if (root.contains("nodes"))
        for (json& node : root["nodes"]) remove_extension(node);
    remove_from_list(root, "extensionsUsed");
    remove_from_list(root, "extensionsRequired");
    if (lamps.empty()) return;
    const auto suns = static_cast<size_t>(
        std::count_if(lamps.begin(), lamps.end(), [](const Lamp& l) { return l.kind == Lamp::Kind::Directional; }));
    conversion.report.changes.push_back("lights: removed " + number_of(lamps.size(), "light") + " of the original");
    if (suns > 0)
        conversion.report.warnings.push_back("lights: " + number_of(suns, "directional light") +
                                             " of the original (sun or sky) removed");
}

json light_of(const LampRule& rule) {
    const Lamp& lamp = rule.lamp;
    // The format wants components of at most 1; the intensity makes up for it, so that intensity * Y(color) is in cd.
    const glm::dvec3 colour(lamp.colour);
    const double brightest = std::max({colour.r, colour.g, colour.b});
    json made = {{"name", rule.name},
                 {"type", lamp.kind == Lamp::Kind::Point ? "point" : "spot"},
                 {"intensity", lamp.intensity * brightest},
                 {"color", {colour.r / brightest, colour.g / brightest, colour.b / brightest}}};
    if (lamp.kind != Lamp::Kind::Point)
        made["spot"] = {{"innerConeAngle", lamp.inner_cone}, {"outerConeAngle", lamp.outer_cone}};
    return made;
}

/// How long the node's axes are in the world: offsets are given in metres, whatever scale lies above.
glm::dvec3 axis_lengths(const Conversion& conversion, const std::vector<glm::dmat4>& world, uint32_t node) {
    const uint32_t placed = conversion.original.node_of[node];
    if (placed == kNone) return glm::dvec3(1);
    const glm::dmat4& m = world[placed];
    glm::dvec3 lengths;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(glm::dvec3(m[axis][0], m[axis][1], m[axis][2]));
        lengths[axis] = length > 0 ? length : 1;
    }
    return lengths;
}

/// The light of a rule, as a node refers to it.
struct Reference {
    const char* extension;
    json use;
};

/// The opening of a light or a light profile, for the extras block.
void add_opening(Conversion& conversion, const char* of, size_t index, const photometry::LuminousOpening& opening) {
    if (!(opening.area() > 0)) return;
    conversion.openings.push_back({{of, index}, {"width_m", opening.length}, {"height_m", opening.width}});
    if (opening.round) conversion.openings.back()["round"] = true;
    if (!opening.drawn) conversion.openings.back()["drawn"] = false;
}

/// Puts the file of a measured lamp into the document, once for all rules that name it.
size_t profile_of(Conversion& conversion, const LampRule& rule) {
    const photometry::LuminousOpening& opening = rule.lamp.opening;
    const auto [known, is_new] = conversion.profiles.try_emplace(
        {rule.lamp.distribution, opening.length, opening.width, opening.round, opening.drawn});
    if (!is_new) return known->second;
    json& root = conversion.document.edit();
    json& extension =
        object_member(conversion.document, object_member(conversion.document, root, "extensions"), kMeasured);
    if (!extension.contains("lights")) extension["lights"] = json::array();
    if (!root.contains("bufferViews")) root["bufferViews"] = json::array();
    use_extension(root, kMeasured);
    const photometry::Distribution& distribution = conversion.photometry.measured[rule.lamp.distribution].distribution;
    const std::string text = photometry::write_ies(distribution);
    root["bufferViews"].push_back({{"buffer", root.contains("buffers") ? root["buffers"].size() : 0},
                                   {"byteOffset", conversion.profile_bytes.size()},
                                   {"byteLength", text.size()}});
    conversion.profile_bytes.insert(conversion.profile_bytes.end(), text.begin(), text.end());
    extension["lights"].push_back({{"name", distribution.name},
                                   {"bufferView", root["bufferViews"].size() - 1},
                                   {"mimeType", "application/x-ies-lm-63"}});
    known->second = extension["lights"].size() - 1;
    add_opening(conversion, "profile", known->second, opening);
    return known->second;
}

void add_profile_buffer(Conversion& conversion) {
    if (conversion.profile_bytes.empty()) return;
    conversion.document.edit()["buffers"].push_back(
        {{"byteLength", conversion.profile_bytes.size()},
         {"uri", encode_data_uri("application/octet-stream", conversion.profile_bytes)}});
}

Reference reference_of(Conversion& conversion, const LampRule& rule) {
    if (rule.lamp.kind == Lamp::Kind::Measured) {
        // As for intensity: multiplier * Y(color) is the factor.
        const glm::dvec3 colour(rule.lamp.colour);
        const double brightest = std::max({colour.r, colour.g, colour.b});
        return {kMeasured,
                {{"light", profile_of(conversion, rule)},
                 {"multiplier", rule.lamp.intensity * brightest},
                 {"color", {colour.r / brightest, colour.g / brightest, colour.b / brightest}}}};
    }
    json& root = conversion.document.edit();
    json& extension =
        object_member(conversion.document, object_member(conversion.document, root, "extensions"), kLights);
    if (!extension.contains("lights")) extension["lights"] = json::array();
    const size_t lamp = extension["lights"].size();
    extension["lights"].push_back(light_of(rule));
    use_extension(root, kLights);
    if (rule.lamp.kind == Lamp::Kind::CosinePower)
        conversion.lobes.push_back({{"light", lamp}, {"type", "cosine_power"}, {"exponent", rule.lamp.exponent}});
    add_opening(conversion, "light", lamp, rule.lamp.opening);
    return {kLights, {{"light", lamp}}};
}

/// Returns the node that has the lamp: this one, or a new child.
size_t add_lamp(Conversion& conversion, const LampRule& rule, const Reference& reference, uint32_t node,
                glm::dvec3 scale) {
    json& root = conversion.document.edit();
    // A measured lamp has no name but that of its node.
    const bool named = reference.extension != kMeasured || root["nodes"][node].value("name", "") == rule.name;
    const bool plain = named && !rule.aim && !rule.turn && rule.offset == glm::dvec3(0);
    json& extensions = object_member(conversion.document, root["nodes"][node], "extensions");
    if (plain && !extensions.contains(kLights) && !extensions.contains(kMeasured)) {
        extensions[reference.extension] = reference.use;
        return node;
    }
    if (extensions.empty()) root["nodes"][node].erase("extensions");
    json child = {{"name", rule.name}, {"extensions", {{reference.extension, reference.use}}}};
    const glm::dvec3 offset = rule.offset / scale;
    if (offset != glm::dvec3(0)) child["translation"] = {offset.x, offset.y, offset.z};
    if (rule.aim || rule.turn) {
        const glm::dquat turn = rule.turn ? *rule.turn : turn_to(*rule.aim);
        child["rotation"] = {turn.x, turn.y, turn.z, turn.w};
    }
    root["nodes"][node]["children"].push_back(root["nodes"].size());
    root["nodes"].push_back(std::move(child));
    return root["nodes"].size() - 1;
}

/// Puts the lamp of a rule on all nodes that match it, and notes its fixture for the extras block.
void add_lamps(Conversion& conversion, const LampRule& rule, const std::vector<uint32_t>& nodes,
               const std::vector<glm::dmat4>& world, const std::vector<uint32_t>& parents) {
    const bool own = rule.fixture == "own", none = rule.fixture == "none";
    std::vector<uint32_t> fixtures;
    if (!own && !none) fixtures = named_fixtures(conversion, rule, nodes, parents);
    const Reference reference = reference_of(conversion, rule);
    for (size_t i = 0; i < nodes.size(); ++i) {
        const size_t lamp = add_lamp(conversion, rule, reference, nodes[i], axis_lengths(conversion, world, nodes[i]));
        if (own || conversion.original.node_of[nodes[i]] == kNone) continue;
        conversion.fixtures.push_back({{"node", lamp}, {"fixture", none ? json("none") : json(fixtures[i])}});
    }
}

std::string fixture_text(const LampRule& rule) {
    if (rule.fixture == "own") return "";
    return rule.fixture == "none" ? ", no fixture" : ", fixture " + in_quotes(rule.fixture);
}

/// What the opening of a lamp shows on its axis.
std::string seen(Lamp lamp, const photometry::Distribution& distribution) {
    if (!(lamp.opening.area() > 0) || !lamp.opening.drawn) return "";
    lamp.distribution = 0;
    return ", " + decimal(axis_luminance(lamp, {&distribution, 1})) + " cd/m^2 over " + decimal(lamp.opening.area()) +
           " m^2";
}

std::string describe(const Conversion& conversion, const LampRule& rule, size_t nodes) {
    const Lamp& lamp = rule.lamp;
    if (lamp.kind == Lamp::Kind::Measured) {
        const MeasuredLamp& measured = conversion.photometry.measured[lamp.distribution];
        return "lamp " + in_quotes(rule.name) + ": " + number_of(nodes, "node") + ", " + in_quotes(measured.file) +
               (measured.mirror ? " mirrored, " : ", ") +
               decimal(lamp.intensity * photometry::largest_intensity(measured.distribution)) + " cd at most, " +
               (rule.kelvin > 0 ? decimal(rule.kelvin) + " K, " : "") +
               decimal(lamp.intensity * photometry::luminous_flux(measured.distribution)) + " lm each" +
               seen(lamp, measured.distribution);
    }
    std::string lobe = "point";
    if (lamp.kind == Lamp::Kind::Spot)
        lobe = "spot " + decimal(lamp.inner_cone * kDegreesPerRadian) + "-" +
               decimal(lamp.outer_cone * kDegreesPerRadian) + " deg";
    if (lamp.kind == Lamp::Kind::CosinePower) lobe = "cosine power " + decimal(lamp.exponent);
    return "lamp " + in_quotes(rule.name) + ": " + number_of(nodes, "node") + ", " + lobe + ", " +
           decimal(lamp.intensity) + " cd, " + (rule.kelvin > 0 ? decimal(rule.kelvin) + " K, " : "") +
           decimal(luminous_flux(lamp)) + " lm each" + seen(lamp, {});
}

void warn_of_instances(Conversion& conversion, const JsonValue& node, const LampRule& rule) {
    const auto extensions = node.find("extensions");
    if (extensions && extensions->find("EXT_mesh_gpu_instancing"))
        conversion.report.warnings.push_back("lamp " + in_quotes(rule.name) + ": node " +
                                             in_quotes(node.text_or("name", "")) +
                                             " is instanced; the lamp is placed once, at the node");
}

/// Whether left and right of a distribution are alike.
bool is_symmetric(const photometry::Distribution& d) {
    const photometry::Distribution other = photometry::mirrored(d);
    const double limit = 1e-3 * photometry::largest_intensity(d);
    return other.horizontal == d.horizontal &&
           std::equal(d.candela.begin(), d.candela.end(), other.candela.begin(), other.candela.end(),
                      [&](double a, double b) { return std::abs(a - b) <= limit; });
}

/// A scale of negative determinant turns a beam for right-hand traffic into one for left-hand, which no lamp does.
void warn_of_mirrors(Conversion& conversion, const LampRule& rule, const std::vector<uint32_t>& nodes,
                     const std::vector<glm::dmat4>& world) {
    if (rule.lamp.kind != Lamp::Kind::Measured) return;
    const MeasuredLamp& lamp = conversion.photometry.measured[rule.lamp.distribution];
    if (lamp.mirror || is_symmetric(lamp.distribution)) return;
    size_t mirrored_nodes = 0;
    std::string first;
    for (const uint32_t node : nodes) {
        const uint32_t placed = conversion.original.node_of[node];
        if (placed == kNone || !(glm::determinant(glm::dmat3(world[placed])) < 0)) continue;
        if (mirrored_nodes++ == 0) first = conversion.original.scene.nodes[placed].name;
    }
    if (mirrored_nodes > 0)
        conversion.report.warnings.push_back(
            "lamp " + in_quotes(rule.name) + ": node " + in_quotes(first) +
            (mirrored_nodes > 1 ? " and " + number_of(mirrored_nodes - 1, "other") : "") +
            (mirrored_nodes > 1 ? " are" : " is") +
            " mirrored by a scale, and so is the distribution there: a rule of its own with \"mirror\": true undoes "
            "it");
}

}  // namespace

void convert_lamps(Conversion& conversion) {
    if (!conversion.photometry.keep_lights) remove_lights(conversion);
    size_t depth = 1;
    for (const LampRule& rule : conversion.photometry.lamps)
        for (const std::string& pattern : rule.nodes)
            depth = std::max(depth, static_cast<size_t>(std::count(pattern.begin(), pattern.end(), '/')) + 1);

    const size_t count = conversion.original.node_of.size();
    const std::vector<glm::dmat4> world = world_transforms(conversion.original.scene, 0);
    std::vector<std::vector<uint32_t>> matched(conversion.photometry.lamps.size());
    std::set<size_t> lamp_nodes;
    std::vector<uint32_t> parents(count, kNone);
    {
        const auto nodes = conversion.document.list("nodes");
        for (uint32_t i = 0; i < count; ++i)
            for (const JsonValue& child : nodes[i].elements_of("children")) parents[child.index(count, "nodes")] = i;
        for (uint32_t i = 0; i < count; ++i) {
            const auto path = path_of(nodes, parents, i, depth);
            for (size_t r = 0; r < matched.size(); ++r) {
                const LampRule& rule = conversion.photometry.lamps[r];
                if (std::none_of(rule.nodes.begin(), rule.nodes.end(),
                                 [&](const auto& p) { return matches_path(p, path); }))
                    continue;
                matched[r].push_back(i);
                warn_of_instances(conversion, nodes[i], rule);
            }
        }
        for (const auto& rule : matched) lamp_nodes.insert(rule.begin(), rule.end());
        check_plausibility(conversion, lamp_nodes);
    }

    for (size_t r = 0; r < matched.size(); ++r) {
        const LampRule& rule = conversion.photometry.lamps[r];
        if (matched[r].empty()) {
            conversion.report.warnings.push_back("lamp " + in_quotes(rule.name) + ": no node matches " +
                                                 in_quotes(rule.nodes.front()) +
                                                 (rule.nodes.size() > 1 ? " or its other patterns" : ""));
            continue;
        }
        warn_of_mirrors(conversion, rule, matched[r], world);
        add_lamps(conversion, rule, matched[r], world, parents);
        conversion.report.changes.push_back(describe(conversion, rule, matched[r].size()) + fixture_text(rule));
    }
    add_profile_buffer(conversion);
    conversion.lamp_nodes = std::move(matched);
}

}  // namespace vesper::scene
