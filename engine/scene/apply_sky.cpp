// Directional lights and the sky of a photometry file. SPDX-License-Identifier: MIT
#include <algorithm>

#include "base/angle.h"
#include "scene/apply_rules.h"
#include "scene/half_sky.h"
#include "scene/photometry_measured.h"
#include "scene/rotation.h"

namespace vesper::scene {
namespace {

void add_directional(Application& application, const DirectionalRule& rule) {
    Scene& scene = application.scene;
    Lamp lamp;
    lamp.name = rule.name;
    lamp.kind = Lamp::Kind::Directional;
    lamp.intensity = static_cast<float>(rule.illuminance);
    lamp.colour = glm::vec3(rule.colour);
    if (rule.angular_diameter) lamp.angular_diameter = static_cast<float>(*rule.angular_diameter * kRadiansPerDegree);
    Node node;
    node.name = rule.name;
    node.rotation = settled_rotation(turn_to(rule.direction));
    node.lamp = static_cast<uint32_t>(scene.lamps.size());
    scene.lamps.push_back(std::move(lamp));
    scene.nodes.push_back(std::move(node));
    application.report.changes.push_back("directional " + in_quotes(rule.name) + ": " + decimal(rule.illuminance) +
                                         " lx");
}

void set_environment(Application& application, const SkyPicture& sky) {
    const photometry::Environment& e = sky.environment;
    application.scene.environment = as_half_floats(e);
    application.report.changes.push_back("sky: " + in_quotes(sky.file) + ", " + decimal(photometry::sky_luminance(e)) +
                                         " cd/m^2 in the mean, " + decimal(photometry::horizontal_illuminance(e)) +
                                         " lx on the ground");
    for (const std::string& note : sky.notes)
        application.report.warnings.push_back("sky: " + in_quotes(sky.file) + ": " + note);
    if (sky.cleaned > 0)
        application.report.warnings.push_back("sky: " + std::to_string(sky.cleaned) +
                                              " pixels that were negative or not finite are black");
}

}  // namespace

void apply_sky(Application& application) {
    const Photometry& p = application.photometry;
    Scene& scene = application.scene;
    scene.transfer = p.transfer;
    if (p.ambient) {
        scene.ambient_illuminance = static_cast<float>(p.ambient->value);
        scene.ambient_colour = glm::vec3(p.ambient->colour);
    }
    if (p.sky) {
        scene.sky_luminance = static_cast<float>(p.sky->value);
        scene.sky_colour = glm::vec3(p.sky->colour);
    }
    for (const DirectionalRule& rule : p.directional) add_directional(application, rule);
    if (p.sky_picture) set_environment(application, *p.sky_picture);
}

}  // namespace vesper::scene
