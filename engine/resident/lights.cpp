#include "resident/lights.h"

#include <algorithm>

#include "scene/light.h"

namespace vesper {
namespace {

int order(Light::Kind kind) {
    switch (kind) {
        case Light::Kind::CosinePower: return 1;
        case Light::Kind::Measured: return 2;
        case Light::Kind::Directional: return 3;
        default: return 0;
    }
}

// A column of a matrix at length 1; something in its place where a node is squeezed flat and has no direction left.
glm::vec3 unit(glm::vec4 column, glm::vec3 otherwise) {
    const float length = glm::length(glm::vec3(column));
    return length > 0 ? glm::vec3(column) / length : otherwise;
}

// The frame of a measurement (shared/light.h) and where its angles fall in the map.
void place_map(shared::Light& light, const LightMaps::Intensities& map, glm::vec3 x, glm::vec3 y, glm::vec3 z) {
    glm::vec3 turn;  // where azimuth goes from `start`
    switch (map.goniometry) {
        case Goniometry::CGamma: light.start = x, light.pole = -z, turn = y; break;
        case Goniometry::TypeA: light.start = -z, light.pole = y, turn = x; break;
        case Goniometry::TypeB: light.start = -z, light.pole = x, turn = -y; break;
    }
    light.start -= glm::dot(light.start, light.pole) * light.pole;
    const glm::vec3 across = glm::cross(light.pole, std::abs(light.pole.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
    light.start = unit(glm::vec4(light.start, 0), glm::normalize(across));  // of a flat node
    const bool mirrored = glm::dot(glm::cross(light.start, light.pole), turn) < 0;
    const glm::dvec2 scale = 1.0 / map.step;
    light.grid = {float(scale.x), float(1 - map.low.x * scale.x), float(scale.y), float(1 - map.low.y * scale.y)};
    light.intensity *= map.largest;
    light.map = float(map.first);
    light.last_azimuth = (mirrored ? -1.0f : 1.0f) * float(map.cells.x - 1), light.lobe_b = float(map.cells.y - 1);
}

}  // namespace

std::vector<PlacedLight> placed_lights(const Scene& scene) {
    std::vector<PlacedLight> placed;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].light != kNone) placed.push_back({scene.lights[scene.nodes[i].light], i});
    std::stable_sort(placed.begin(), placed.end(),
                     [](const PlacedLight& a, const PlacedLight& b) { return order(a.light.kind) < order(b.light.kind); });
    return placed;
}

LightList light_list(const std::vector<PlacedLight>& lights, const LightMaps& maps, const SceneFrame& frame, const View& view) {
    LightList list;
    for (const PlacedLight& placed : lights) {
        const Light& light = placed.light;
        const bool measured = light.kind == Light::Kind::Measured;
        const float intensity = light.intensity * frame.dimming_of(placed.node);
        if (!(intensity > 0) || (measured && !(maps.intensities.at(light.distribution).largest > 0))) continue;
        const glm::mat4 m = view.from(frame.world[placed.node]);
        const glm::vec3 x = unit(m[0], {1, 0, 0}), y = unit(m[1], {0, 0, -1}), z = unit(m[2], {0, 1, 0});
        const bool power = light.kind == Light::Kind::CosinePower;
        const glm::vec2 lobe = power ? glm::vec2(light.exponent, 0) : glm::vec2(cone_ramp(light));
        shared::Light made{.position = glm::vec3(m[3]), .intensity = intensity, .axis = -z, .lobe_a = lobe.x,
                           .colour = light.colour, .lobe_b = lobe.y, .start = x, .map = -1, .pole = -z, .last_azimuth = 0, .grid = {}};
        if (measured) place_map(made, maps.intensities[light.distribution], x, y, z);
        list.lights.push_back(made);
        switch (order(light.kind)) {
            case 0: ++list.counts.cones; break;
            case 1: ++list.counts.powers; break;
            case 2: ++list.counts.maps; break;
            default: ++list.counts.directional;
        }
    }
    return list;
}

void set_to_one(LightList& list, float reference_distance) {
    for (size_t i = 0; i < list.lights.size(); ++i) {
        shared::Light& light = list.lights[i];
        const bool directional = i >= list.lamps();
        light.intensity = directional ? 1 : reference_distance * reference_distance;
        light.colour /= std::max({light.colour.r, light.colour.g, light.colour.b, 1e-6f});
    }
}

}  // namespace vesper
