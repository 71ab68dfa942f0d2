// Sources are described twice, by candela and by cd/m^2: L = I / A must hold. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "base/one_line.h"
#include "scene/apply_rules.h"
#include "scene/lamp.h"
#include "scene/lamp_glass.h"
#include "scene/photometry_measured.h"

namespace vesper::scene {
namespace {

using glm::dvec3;
constexpr double kAgreement = 1.1;  // ratio of the two luminances from which they disagree

double axis_intensity(const Application& application, const LampRule& rule) {
    Lamp lamp = rule.lamp;
    if (lamp.kind != Lamp::Kind::Measured) return luminous_intensity(lamp, {}, {0, 0, -1});
    lamp.distribution = 0;
    const photometry::Distribution& distribution = application.photometry.measured[rule.lamp.distribution].distribution;
    return luminous_intensity(lamp, {&distribution, 1}, {0, 0, -1});
}

std::vector<GlassLamp> reported_lamps(const Application& application, const std::vector<glm::dmat4>& world,
                                      size_t rule_index) {
    const LampRule& rule = application.photometry.lamps[rule_index];
    std::vector<GlassLamp> lamps;
    for (const uint32_t node : application.lamp_nodes[rule_index]) {
        const glm::dmat4& m = world[node];
        dvec3 position(m[3]);
        for (int axis = 0; axis < 3; ++axis)
            if (glm::length(dvec3(m[axis])) > 0) position += rule.offset[axis] * glm::normalize(dvec3(m[axis]));
        const dvec3 direction = glm::dmat3(m) * (turn_of(rule, m) * dvec3(0, 0, -1));
        if (glm::length(direction) > 0) lamps.push_back({node, position, glm::normalize(direction)});
    }
    return lamps;
}

std::string disagreement(const EmitterRule& emitter, const LampRule& lamp, double luminance, double intensity,
                         double area) {
    return "emitter " + in_quotes(emitter.name) + ": " + decimal(luminance) + " cd/m^2 " +
           (emitter.picture == kNone ? "given, " : "in the mean of its picture, ") + decimal(intensity) +
           " cd of lamp " + in_quotes(lamp.name) + " over " + decimal(area) + " m^2 is " + decimal(intensity / area) +
           " cd/m^2 (" + deviation(intensity / area / luminance) + ")";
}

bool disagree(double a, double b) { return a > kAgreement * b || b > kAgreement * a; }

/// Emitters that name their lamps.
void check_named(Application& application, const EmitterRule& emitter) {
    for (const LampRule& lamp : application.photometry.lamps) {
        if (std::find(emitter.lamps.begin(), emitter.lamps.end(), lamp.name) == emitter.lamps.end()) continue;
        const double intensity = axis_intensity(application, lamp), area = lamp.lamp.opening.area();
        if (emitter.luminance > 0 && area > 0 && disagree(intensity / area, emitter.luminance))
            application.report.warnings.push_back(disagreement(emitter, lamp, emitter.luminance, intensity, area));
    }
}

/// Boxes, in the world, around what hangs together in a primitive: triangles with corners at the same place.
std::vector<Bounds> pieces_of(const Primitive& primitive, const glm::dmat4& world) {
    std::vector<uint32_t> first(primitive.vertices.size());  // of each vertex's piece, by way of others
    const auto root = [&](uint32_t v) {
        while (first[v] != v) v = first[v] = first[first[v]];
        return v;
    };
    std::map<std::array<float, 3>, uint32_t> places;
    for (uint32_t v = 0; v < first.size(); ++v) {
        const glm::vec3 p = primitive.vertices[v].position;
        first[v] = places.try_emplace({p.x, p.y, p.z}, v).first->second;
    }
    for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
        for (const size_t c : {i + 1, i + 2}) first[root(primitive.indices[c])] = root(primitive.indices[i]);
    std::map<uint32_t, Bounds> boxes;
    for (const uint32_t v : primitive.indices)
        boxes[root(v)].add(glm::vec3(world * glm::dvec4(primitive.vertices[v].position, 1)));
    std::vector<Bounds> pieces;
    for (const auto& [_, box] : boxes) pieces.push_back(box);
    return pieces;
}

/// Glass whose lamps are to show in it, but where none is: it is dark.
void check_lit(Application& application, const EmitterRule& emitter, const std::vector<uint32_t>& shining,
               const std::vector<glm::dmat4>& world) {
    const Scene& scene = application.scene;
    std::vector<dvec3> lamps;
    for (size_t r = 0; r < application.photometry.lamps.size(); ++r)
        if (std::find(emitter.lamps.begin(), emitter.lamps.end(), application.photometry.lamps[r].name) !=
            emitter.lamps.end())
            for (const GlassLamp& lamp : reported_lamps(application, world, r)) lamps.push_back(lamp.position);
    size_t surfaces = 0, dark = 0;
    std::string first;
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == kNone) continue;
        for (const Primitive& p : scene.meshes[scene.nodes[node].mesh].primitives) {
            if (std::find(shining.begin(), shining.end(), p.material) == shining.end()) continue;
            for (const Bounds& box : pieces_of(p, world[node])) {
                const dvec3 low(box.low), high(box.high);
                ++surfaces;
                if (std::any_of(lamps.begin(), lamps.end(), [&](dvec3 lamp) {
                        return glm::distance(lamp, glm::clamp(lamp, low, high)) <= kGlassReach;
                    }))
                    continue;
                if (dark++ == 0) first = scene.nodes[node].name;
            }
        }
    }
    if (dark > 0)
        application.report.warnings.push_back(
            "emitter " + in_quotes(emitter.name) + ": " + std::to_string(dark) + " of " + std::to_string(surfaces) +
            (dark == 1 ? " surfaces has" : " surfaces have") + " no lamp " + in_quotes(emitter.lamps.front()) +
            " within " + decimal(kGlassReach) + " m and " + (dark == 1 ? "is" : "are") + " dark (node " +
            in_quotes(first) + ")");
}

/// One emitter against one lamp rule, by the meshes beside its lamps; one line for all nodes.
void check_pair(Application& application, const EmitterRule& emitter, const std::vector<uint32_t>& shining,
                size_t rule_index, const std::vector<glm::dmat4>& world) {
    const Scene& scene = application.scene;
    const LampRule& rule = application.photometry.lamps[rule_index];
    std::vector<GlassLamp> lamps = reported_lamps(application, world, rule_index);
    std::optional<photometry::PictureMeans> means;
    if (emitter.picture != kNone) means.emplace(application.photometry.pictures[emitter.picture].picture);
    add_glass(scene, world, shining, emitter, means ? &*means : nullptr, lamps);
    const double intensity = axis_intensity(application, rule);
    size_t glazed = 0, wrong = 0;
    double worst = 0, its_area = 0, its_luminance = 0;
    for (const GlassLamp& lamp : lamps) {
        const auto [area, candela] = lamp.seen();
        if (!(area > 0) || !(candela > 0) || !(intensity > 0)) continue;
        ++glazed;
        const double off = std::abs(std::log(intensity / candela));
        if (disagree(intensity, candela)) ++wrong;
        if (off > worst) worst = off, its_area = area, its_luminance = candela / area;
    }
    if (glazed > 0 && rule.lamp.opening.area() > 0 && rule.lamp.opening.drawn)
        application.report.warnings.push_back(
            "emitter " + in_quotes(emitter.name) + ": lies where lamp " + in_quotes(rule.name) +
            " shows its opening and would be seen twice: give it \"lamp\": \"" + one_line(rule.name) + "\"");
    if (wrong > 0)
        application.report.warnings.push_back(disagreement(emitter, rule, its_luminance, intensity, its_area) +
                                              (wrong > 1 ? ", the most of " + std::to_string(wrong) + " nodes" : ""));
}

}  // namespace

std::string deviation(double factor) {
    const long percent = std::lround(100 * std::abs(factor - 1));
    return factor > 3 ? std::to_string(std::lround(factor)) + " times as much"
                      : std::to_string(percent) + (factor < 1 ? " % less" : " % more");
}

void check_sources(Application& application, const std::vector<std::vector<uint32_t>>& emitting) {
    const Photometry& photometry = application.photometry;
    const std::vector<glm::dmat4> world = world_transforms(application.scene, 0);
    for (size_t e = 0; e < photometry.emitters.size(); ++e) {
        const EmitterRule& emitter = photometry.emitters[e];
        if (!emitter.lamps.empty()) {
            check_named(application, emitter);
            check_lit(application, emitter, emitting[e], world);
        }
        // The mean of a texture of 8 bits is not known here, and what is off is meant to be.
        if (!emitter.lamps.empty() || emitter.modulate || !(emitter.luminance > 0) || emitting[e].empty()) continue;
        for (size_t r = 0; r < photometry.lamps.size(); ++r) check_pair(application, emitter, emitting[e], r, world);
    }
}

}  // namespace vesper::scene
