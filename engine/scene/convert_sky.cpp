// Directional lights and the sky of a converted file. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/packing.hpp>

#include "scene/convert_rules.h"
#include "scene/photometry_measured.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

/// A node of the scene that is shown.
void add_root_node(json& root, json node) {
    const size_t index = root.contains("nodes") ? root["nodes"].size() : 0;
    root["nodes"].push_back(std::move(node));
    if (!root.contains("scenes") || root["scenes"].empty()) return;  // then every node without a parent is shown
    root["scenes"][root.value("scene", size_t{0})]["nodes"].push_back(index);
}

void add_directional(Conversion& conversion, const DirectionalRule& rule) {
    json& root = conversion.document.edit();
    json& extension = object_member(conversion.document, object_member(conversion.document, root, "extensions"),
                                    "KHR_lights_punctual");
    if (!extension.contains("lights")) extension["lights"] = json::array();
    const size_t lamp = extension["lights"].size();
    const double brightest = std::max({rule.colour.r, rule.colour.g, rule.colour.b});
    extension["lights"].push_back(
        {{"name", rule.name},
         {"type", "directional"},
         {"intensity", rule.illuminance * brightest},
         {"color", {rule.colour.r / brightest, rule.colour.g / brightest, rule.colour.b / brightest}}});
    if (rule.angular_diameter)
        conversion.openings.push_back({{"light", lamp}, {"angular_diameter_deg", *rule.angular_diameter}});
    use_extension(root, "KHR_lights_punctual");
    const glm::dquat turn = turn_to(rule.direction);
    add_root_node(root, {{"name", rule.name},
                         {"rotation", {turn.x, turn.y, turn.z, turn.w}},
                         {"extensions", {{"KHR_lights_punctual", {{"light", lamp}}}}}});
    conversion.report.changes.push_back("directional " + in_quotes(rule.name) + ": " + decimal(rule.illuminance) +
                                        " lx");
}

/// Half floats times a scale that brings the brightest to 60,000: nine decades in full precision below it.
void add_environment(Conversion& conversion, const SkyPicture& sky) {
    const photometry::Environment& e = sky.environment;
    const float brightest = *std::max_element(e.rgb.begin(), e.rgb.end());
    const double scale = brightest > 0 ? brightest / 60000.0 : 1;
    std::vector<uint8_t> bytes;
    bytes.reserve(e.rgb.size() * 2);
    for (const float value : e.rgb) {
        const uint16_t half = glm::packHalf1x16(static_cast<float>(value / scale));
        bytes.push_back(static_cast<uint8_t>(half & 255)), bytes.push_back(static_cast<uint8_t>(half >> 8));
    }
    conversion.environment = {{"bufferView", add_buffer_view(conversion.document.edit(), bytes)},
                              {"width", e.width},
                              {"height", e.height},
                              {"scale", scale},
                              {"rotation_deg", e.rotation * 180 / std::numbers::pi},
                              {"name", sky.file}};
    conversion.report.changes.push_back("sky: " + in_quotes(sky.file) + ", " + decimal(photometry::sky_luminance(e)) +
                                        " cd/m^2 in the mean, " + decimal(photometry::horizontal_illuminance(e)) +
                                        " lx on the ground");
    if (sky.cleaned > 0)
        conversion.report.warnings.push_back("sky: " + std::to_string(sky.cleaned) +
                                             " pixels that were negative or not finite are black");
}

}  // namespace

void convert_sky(Conversion& conversion) {
    const Photometry& p = conversion.photometry;
    for (const DirectionalRule& rule : p.directional) add_directional(conversion, rule);
    if (p.sky_picture) add_environment(conversion, *p.sky_picture);
}

}  // namespace vesper::scene
