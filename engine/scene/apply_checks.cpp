// What is warned of when photometry is applied: values that cannot be right, and lights that may have been forgotten.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/lower.h"
#include "scene/apply_rules.h"
#include "scene/reflectance.h"
#include "scene/scene_warnings.h"

namespace vesper::scene {
namespace {

constexpr double kHighestReflectance = 0.9;  // fresh snow; plaster has 0.8

}  // namespace

void check_reflectances(const Scene& scene, PhotometryReport& report) {
    const std::vector<MaterialUse> uses = material_uses(scene);
    for (size_t i = 0; i < uses.size(); ++i) {
        const Material& material = scene.materials[i];
        // Metal has no diffuse reflectance; what shines hides what it reflects.
        if (material.metallic > 0.5f || material.emission != glm::vec3(0)) continue;
        if (material.alpha == Material::Alpha::Mask && material.base_colour.a < material.alpha_cutoff)
            continue;  // glass
        const double mean = mean_reflectance(scene, material, uses[i]);
        if (mean > kHighestReflectance)
            report.warnings.push_back("material " + in_quotes(material.name) + ": a mean reflectance of " +
                                      decimal(mean) + " is more than real surfaces have");
    }
}

namespace {

void check_lamps(Application& application) {
    for (const LampRule& rule : application.photometry.lamps) {
        double candela = rule.lamp.intensity;
        if (rule.lamp.kind == Lamp::Kind::Measured)
            candela *=
                photometry::largest_intensity(application.photometry.measured[rule.lamp.distribution].distribution);
        if (candela < kFaintestLamp || candela > kBrightestLamp)
            application.report.warnings.push_back("lamp " + in_quotes(rule.name) + ": " + decimal(candela) +
                                                  " cd is beyond the lamps of a street (0.1 to 1e6 cd)");
    }
}

void check_size(Application& application) {
    const Scene& scene = application.scene;
    const std::vector<glm::dmat4> world = world_transforms(scene, 0);
    Bounds bounds;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == kNone) continue;
        for (const Primitive& primitive : scene.meshes[scene.nodes[i].mesh].primitives)
            for (const glm::dvec3 corner : placed_corners(primitive.bounds, world[i])) bounds.add(glm::vec3(corner));
    }
    if (bounds.empty()) return;
    const glm::vec3 size = bounds.high - bounds.low;
    const double longest = std::max({size.x, size.y, size.z});
    if (longest < 1 || longest > 1e5)
        application.report.warnings.push_back(
            "the scene is " + decimal(longest) +
            " m long: are its lengths in metres? Illuminance falls with their square");
}

/// Scene nodes that show a material some emitter rule matches.
std::set<uint32_t> glowing_nodes(const Application& application) {
    const Scene& scene = application.scene;
    const auto emits = [&](const Primitive& primitive) {
        const std::string& name = scene.materials[primitive.material].name;
        for (const EmitterRule& rule : application.photometry.emitters)
            for (const std::string& pattern : rule.materials)
                if (matches_name(pattern, name)) return true;
        return false;
    };
    std::vector<bool> glowing;
    for (const Mesh& mesh : scene.meshes)
        glowing.push_back(std::any_of(mesh.primitives.begin(), mesh.primitives.end(), emits));
    std::set<uint32_t> nodes;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].mesh != kNone && glowing[scene.nodes[i].mesh]) nodes.insert(i);
    return nodes;
}

/// Nodes that sound like lights, with no lamp on them, above them or below them.
void check_forgotten(Application& application, const std::set<uint32_t>& lamp_nodes) {
    const std::vector<Node>& nodes = application.scene.nodes;
    std::vector<bool> lit(nodes.size()), below(nodes.size());
    const auto light_up = [&](uint32_t node) {
        for (; node != kNone && !lit[node]; node = nodes[node].parent) lit[node] = true;
    };
    for (const uint32_t lamp : lamp_nodes) {
        below[lamp] = true;
        light_up(lamp);
    }
    for (const uint32_t glowing : glowing_nodes(application)) light_up(glowing);
    std::vector<std::string> forgotten;
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        const std::string& name = nodes[i].name;
        if (lit[i] || application.is_added(i) || !sounds_like_light(name)) continue;
        bool under_a_lamp = false;
        uint32_t up = i;
        for (int level = 0; level < 100 && up != kNone && !under_a_lamp; ++level, up = nodes[up].parent)
            under_a_lamp = below[up];
        if (!under_a_lamp) forgotten.push_back(name);
    }
    if (forgotten.empty()) return;
    std::string names;
    for (size_t i = 0; i < std::min<size_t>(3, forgotten.size()); ++i)
        names += (i ? ", " : "") + in_quotes(forgotten[i]);
    application.report.warnings.push_back(
        std::to_string(forgotten.size()) + (forgotten.size() == 1 ? " node sounds" : " nodes sound") +
        " like a light, but no lamp rule matches: " + names + (forgotten.size() > 3 ? ", ..." : ""));
}

}  // namespace

void check_plausibility(Application& application, const std::set<uint32_t>& lamp_nodes) {
    check_size(application);
    check_lamps(application);
    check_forgotten(application, lamp_nodes);
}

}  // namespace vesper::scene
