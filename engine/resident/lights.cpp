#include "resident/lights.h"

#include <algorithm>
#include <cmath>

namespace vesper {
namespace {

// Slope and offset of KHR_lights_punctual's ramp, clamp(a cos + b, 0, 1): 1 within the inner cone, 0 beyond the outer. A
// point lamp is 1 in every direction. The difference of the cosines is taken as a product: between narrow cones they agree
// in most of their digits. Cones that coincide get an edge of 1e-5 in the cosine, outwards.
glm::vec2 cone_ramp(const Light& light) {
    if (light.kind == Light::Kind::Point) return {0, 1};
    const double outer = double(light.outer_cone), inner = std::min(double(light.inner_cone), outer);
    const double difference = 2 * std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2);
    const double slope = 1 / std::max(1e-5, difference);
    return {float(slope), float(1 - slope * std::cos(inner))};
}

int order(Light::Kind kind) { return kind == Light::Kind::Directional ? 2 : kind == Light::Kind::CosinePower ? 1 : 0; }

}  // namespace

std::vector<PlacedLight> placed_lights(const Scene& scene) {
    std::vector<PlacedLight> placed;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].light != kNone) placed.push_back({scene.lights[scene.nodes[i].light], i});
    std::stable_sort(placed.begin(), placed.end(),
                     [](const PlacedLight& a, const PlacedLight& b) { return order(a.light.kind) < order(b.light.kind); });
    return placed;
}

LightList light_list(const std::vector<PlacedLight>& lights, const SceneFrame& frame, const View& view) {
    LightList list;
    for (const PlacedLight& placed : lights) {
        const Light& light = placed.light;
        if (!(light.intensity > 0)) continue;
        const glm::mat4 m = view.world_to_view * frame.world[placed.node];
        const glm::vec3 axis = -glm::vec3(m[2]), right(m[0]);
        const float axis_length = glm::length(axis), right_length = glm::length(right);
        const bool power = light.kind == Light::Kind::CosinePower;
        const glm::vec2 lobe = power ? glm::vec2(light.exponent, 0) : cone_ramp(light);
        // A node squeezed flat has no direction left; its lamp keeps shining, downwards.
        list.lights.push_back({glm::vec3(m[3]), light.intensity, axis_length > 0 ? axis / axis_length : glm::vec3(0, -1, 0), lobe.x,
                               light.colour, lobe.y, right_length > 0 ? right / right_length : glm::vec3(1, 0, 0), -1});
        ++(light.kind == Light::Kind::Directional ? list.counts.directional : power ? list.counts.powers : list.counts.cones);
    }
    return list;
}

void set_to_one(LightList& list, float reference_distance) {
    for (size_t i = 0; i < list.lights.size(); ++i) {
        shared::Light& light = list.lights[i];
        const bool directional = i >= list.counts.cones + list.counts.powers;
        light.intensity = directional ? 1 : reference_distance * reference_distance;
        light.colour /= std::max({light.colour.r, light.colour.g, light.colour.b, 1e-6f});
    }
}

}  // namespace vesper
