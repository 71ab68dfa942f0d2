// Lamps of photometry rules on nodes. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <glm/gtc/quaternion.hpp>

#include "base/angle.h"
#include "photometry/ies.h"
#include "scene/apply_rules.h"
#include "scene/lamp.h"
#include "scene/photometry_measured.h"
#include "scene/rotation.h"

namespace vesper::scene {
namespace {

std::string number_of(size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

void remove_lights(Application& application) {
    Scene& scene = application.scene;
    const std::vector<Lamp> lamps = std::exchange(scene.lamps, {});
    scene.distributions.clear();
    for (Node& node : scene.nodes) node.lamp = kNone;
    if (lamps.empty()) return;
    const auto suns = static_cast<size_t>(
        std::count_if(lamps.begin(), lamps.end(), [](const Lamp& l) { return l.kind == Lamp::Kind::Directional; }));
    application.report.changes.push_back("lights: removed " + number_of(lamps.size(), "light") + " of the original");
    if (suns > 0)
        application.report.warnings.push_back("lights: " + number_of(suns, "directional light") +
                                              " of the original (sun or sky) removed");
}

/// How long the node's axes are in the world: offsets are given in metres, whatever scale lies above.
glm::dvec3 axis_lengths(const glm::dmat4& m) {
    glm::dvec3 lengths;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(glm::dvec3(m[axis][0], m[axis][1], m[axis][2]));
        lengths[axis] = length > 0 ? length : 1;
    }
    return lengths;
}

/// Distributions of the scene, by that of the rules and the opening of the lamp: a light profile of a file has one.
using Profiles = std::map<std::tuple<uint32_t, double, double, bool, bool>, uint32_t>;

/// The scene's distribution for a measured lamp. Its numbers are those that a file of the scene would hold.
uint32_t profile_of(Application& application, const Lamp& lamp, Profiles& profiles) {
    const photometry::LuminousOpening& o = lamp.opening;
    std::vector<photometry::Distribution>& all = application.scene.distributions;
    const auto [known, is_new] = profiles.try_emplace({lamp.distribution, o.length, o.width, o.round, o.drawn},
                                                      static_cast<uint32_t>(all.size()));
    if (is_new) {
        const photometry::Distribution& measured = application.photometry.measured[lamp.distribution].distribution;
        const std::string text = photometry::write_ies(measured);
        all.push_back(
            photometry::parse_ies({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, measured.name));
        if (!measured.name.empty()) all.back().name = measured.name;
    }
    return known->second;
}

/// Appends the lamp of a rule to the scene's. Returns its index.
uint32_t lamp_of(Application& application, const LampRule& rule, Profiles& profiles) {
    Lamp made;
    made.kind = rule.lamp.kind;
    made.name = rule.name;
    made.intensity = rule.lamp.intensity;
    made.colour = rule.lamp.colour;
    if (rule.lamp.opening.area() > 0) {
        made.opening = rule.lamp.opening;
        made.opening.height = 0;
    }
    if (made.kind == Lamp::Kind::Spot || made.kind == Lamp::Kind::CosinePower) {
        made.outer_cone = rule.lamp.outer_cone;
        made.inner_cone = std::min(rule.lamp.inner_cone, made.outer_cone * 0.9999f);  // as of a file
    }
    if (made.kind == Lamp::Kind::CosinePower) made.exponent = rule.lamp.exponent;
    if (made.kind == Lamp::Kind::Measured) {
        made.distribution = profile_of(application, rule.lamp, profiles);
        made.name = application.scene.distributions[made.distribution].name;
    }
    application.scene.lamps.push_back(std::move(made));
    return static_cast<uint32_t>(application.scene.lamps.size() - 1);
}

/// Puts a lamp on a node, or on a new child of it. Returns the node that has it.
uint32_t add_lamp(Scene& scene, const LampRule& rule, uint32_t lamp, uint32_t node, const glm::dmat4& world) {
    // A measured lamp has no name but that of its node.
    const bool named = rule.lamp.kind != Lamp::Kind::Measured || scene.nodes[node].name == rule.name;
    const bool turned = rule.aim || rule.turn || is_turned_down(rule, world);
    const bool plain = named && !turned && rule.offset == glm::dvec3(0);
    if (plain && scene.nodes[node].lamp == kNone) {
        scene.nodes[node].lamp = lamp;
        return node;
    }
    Node child;
    child.name = rule.name;
    child.parent = node;
    child.lamp = lamp;
    child.translation = rule.offset / axis_lengths(world);
    if (turned) child.rotation = settled_rotation(turn_of(rule, world));
    scene.nodes.push_back(std::move(child));
    return static_cast<uint32_t>(scene.nodes.size() - 1);
}

/// Puts the lamp of a rule on all nodes that match it, and states its fixture.
void add_lamps(Application& application, const LampRule& rule, const std::vector<uint32_t>& nodes,
               const std::vector<glm::dmat4>& world, Profiles& profiles) {
    const bool own = rule.fixture == "own", none = rule.fixture == "none";
    std::vector<uint32_t> fixtures(nodes.size(), kNone);
    if (!own && !none) fixtures = named_fixtures(application, rule, nodes);
    const uint32_t lamp = lamp_of(application, rule, profiles);
    for (size_t i = 0; i < nodes.size(); ++i) {
        const uint32_t holder = add_lamp(application.scene, rule, lamp, nodes[i], world[nodes[i]]);
        if (!own) application.scene.nodes[holder].fixture = fixtures[i];
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

std::string describe(const Application& application, const LampRule& rule, size_t nodes) {
    const Lamp& lamp = rule.lamp;
    if (lamp.kind == Lamp::Kind::Measured) {
        const MeasuredLamp& measured = application.photometry.measured[lamp.distribution];
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

/// Nodes whose mesh the file places many times.
std::vector<bool> instanced_nodes(const Application& application) {
    std::vector<bool> instanced(application.nodes);
    for (uint32_t i = 0; i < application.nodes; ++i)
        if (marked(application.source.instances, i)) instanced[application.scene.nodes[i].parent] = true;
    return instanced;
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
void warn_of_mirrors(Application& application, const LampRule& rule, const std::vector<uint32_t>& nodes,
                     const std::vector<glm::dmat4>& world) {
    if (rule.lamp.kind != Lamp::Kind::Measured) return;
    const MeasuredLamp& lamp = application.photometry.measured[rule.lamp.distribution];
    if (lamp.mirror || is_symmetric(lamp.distribution)) return;
    size_t mirrored_nodes = 0;
    std::string first;
    for (const uint32_t node : nodes) {
        if (!(glm::determinant(glm::dmat3(world[node])) < 0)) continue;
        if (mirrored_nodes++ == 0) first = application.scene.nodes[node].name;
    }
    if (mirrored_nodes > 0)
        application.report.warnings.push_back(
            "lamp " + in_quotes(rule.name) + ": node " + in_quotes(first) +
            (mirrored_nodes > 1 ? " and " + number_of(mirrored_nodes - 1, "other") : "") +
            (mirrored_nodes > 1 ? " are" : " is") +
            " mirrored by a scale, and so is the distribution there: a rule of its own with \"mirror\": true undoes "
            "it");
}

/// Of the distribution of a rule, and of where it shines.
void warn_of_measurement(Application& application, const LampRule& rule, const std::vector<uint32_t>& nodes,
                         const std::vector<glm::dmat4>& world, std::set<uint32_t>& told) {
    if (rule.lamp.kind != Lamp::Kind::Measured) return;
    std::vector<std::string>& warnings = application.report.warnings;
    const MeasuredLamp& lamp = application.photometry.measured[rule.lamp.distribution];
    if (told.insert(rule.lamp.distribution).second)
        for (const std::string& note : lamp.distribution.notes)
            warnings.push_back((lamp.standard ? "built-in lamp " : "") + in_quotes(lamp.file) + ": " + note);
    const auto turned = static_cast<size_t>(
        std::count_if(nodes.begin(), nodes.end(), [&](uint32_t node) { return is_turned_down(rule, world[node]); }));
    if (turned > 0)
        warnings.push_back("lamp " + in_quotes(rule.name) + ": " + number_of(turned, "node") +
                           " with -Z more than 45 degrees from straight down: the distribution of type C shines down "
                           "there (\"aim\" states another direction)");
}

}  // namespace

void apply_lamps(Application& application) {
    const Scene& scene = application.scene;
    if (!application.photometry.keep_lights) remove_lights(application);
    size_t depth = 1;
    for (const LampRule& rule : application.photometry.lamps)
        for (const std::string& pattern : rule.nodes)
            depth = std::max(depth, static_cast<size_t>(std::count(pattern.begin(), pattern.end(), '/')) + 1);

    const std::vector<glm::dmat4> world = world_transforms(scene, 0);
    const std::vector<bool> instanced = instanced_nodes(application);
    std::vector<std::vector<uint32_t>> matched(application.photometry.lamps.size());
    for (uint32_t i = 0; i < application.nodes; ++i) {
        if (application.is_added(i)) continue;
        const auto path = path_of(scene, i, depth);
        for (size_t r = 0; r < matched.size(); ++r) {
            const LampRule& rule = application.photometry.lamps[r];
            if (std::none_of(rule.nodes.begin(), rule.nodes.end(),
                             [&](const auto& p) { return matches_path(p, path); }))
                continue;
            matched[r].push_back(i);
            if (instanced[i])
                application.report.warnings.push_back("lamp " + in_quotes(rule.name) + ": node " +
                                                      in_quotes(scene.nodes[i].name) +
                                                      " is instanced; the lamp is placed once, at the node");
        }
    }
    std::set<uint32_t> lamp_nodes;
    for (const auto& rule : matched) lamp_nodes.insert(rule.begin(), rule.end());
    check_plausibility(application, lamp_nodes);

    Profiles profiles;
    std::set<uint32_t> told;
    for (size_t r = 0; r < matched.size(); ++r) {
        const LampRule& rule = application.photometry.lamps[r];
        if (matched[r].empty()) {
            application.report.warnings.push_back("lamp " + in_quotes(rule.name) + ": no node matches " +
                                                  in_quotes(rule.nodes.front()) +
                                                  (rule.nodes.size() > 1 ? " or its other patterns" : ""));
            continue;
        }
        warn_of_mirrors(application, rule, matched[r], world);
        warn_of_measurement(application, rule, matched[r], world, told);
        add_lamps(application, rule, matched[r], world, profiles);
        application.report.changes.push_back(describe(application, rule, matched[r].size()) + fixture_text(rule));
    }
    application.lamp_nodes = std::move(matched);
}

}  // namespace vesper::scene
