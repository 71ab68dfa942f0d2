#include "gpu_scene/lamps.h"

#include <algorithm>

#include "scene/lamp.h"
#include "scene/scene.h"

namespace vesper::gpu_scene {
namespace {

int order(scene::Lamp::Kind kind) {
    switch (kind) {
        case scene::Lamp::Kind::CosinePower:
            return 1;
        case scene::Lamp::Kind::Measured:
            return 2;
        case scene::Lamp::Kind::Directional:
            return 3;
        default:
            return 0;
    }
}

// A column of a matrix at length 1; something in its place where a node is squeezed flat and has no direction left.
glm::vec3 unit(glm::vec4 column, glm::vec3 otherwise) {
    const float length = glm::length(glm::vec3(column));
    return length > 0 ? glm::vec3(column) / length : otherwise;
}

// The frame of a measurement (shared/lamp.h) and where its angles fall in the table.
void place_table(shared::Lamp& lamp, const IntensityTables::Intensities& table, glm::vec3 x, glm::vec3 y, glm::vec3 z) {
    glm::vec3 turn;  // where azimuth goes from `start`
    switch (table.goniometry) {
        case photometry::Goniometry::CGamma:
            lamp.start = x, lamp.pole = -z, turn = y;
            break;
        case photometry::Goniometry::TypeA:
            lamp.start = -z, lamp.pole = y, turn = x;
            break;
        case photometry::Goniometry::TypeB:
            lamp.start = -z, lamp.pole = x, turn = -y;
            break;
    }
    lamp.start -= glm::dot(lamp.start, lamp.pole) * lamp.pole;
    const glm::vec3 across =
        glm::cross(lamp.pole, std::abs(lamp.pole.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
    lamp.start = unit(glm::vec4(lamp.start, 0), glm::normalize(across));  // of a flat node
    const bool mirrored = glm::dot(glm::cross(lamp.start, lamp.pole), turn) < 0;
    const glm::dvec2 scale = 1.0 / table.step;
    lamp.grid = {float(scale.x), float(1 - table.low.x * scale.x), float(scale.y), float(1 - table.low.y * scale.y)};
    lamp.intensity *= table.largest;
    lamp.table = float(table.first);
    lamp.last_azimuth = (mirrored ? -1.0f : 1.0f) * float(table.cells.x - 1), lamp.lobe_b = float(table.cells.y - 1);
}

}  // namespace

std::vector<PlacedLamp> placed_lamps(const scene::Scene& scene) {
    std::vector<PlacedLamp> placed;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != scene::kNone) placed.push_back({scene.lamps[scene.nodes[i].lamp], i});
    std::stable_sort(placed.begin(), placed.end(),
                     [](const PlacedLamp& a, const PlacedLamp& b) { return order(a.lamp.kind) < order(b.lamp.kind); });
    return placed;
}

LampList lamp_list(const std::vector<PlacedLamp>& lamps, const IntensityTables& tables, const SceneFrame& frame,
                   const View& view) {
    LampList list;
    for (const PlacedLamp& placed : lamps) {
        const scene::Lamp& lamp = placed.lamp;
        const bool measured = lamp.kind == scene::Lamp::Kind::Measured;
        const float intensity = lamp.intensity * frame.dimming_of(placed.node);
        if (!(intensity > 0) || (measured && !(tables.intensities.at(lamp.distribution).largest > 0))) continue;
        const glm::mat4 m = view.from(frame.world[placed.node]);
        const glm::vec3 x = unit(m[0], {1, 0, 0}), y = unit(m[1], {0, 0, -1}), z = unit(m[2], {0, 1, 0});
        const bool power = lamp.kind == scene::Lamp::Kind::CosinePower;
        const glm::vec2 lobe = power ? glm::vec2(lamp.exponent, 0) : glm::vec2(scene::cone_ramp(lamp));
        shared::Lamp made{.position = glm::vec3(m[3]),
                          .intensity = intensity,
                          .axis = -z,
                          .lobe_a = lobe.x,
                          .colour = lamp.colour,
                          .lobe_b = lobe.y,
                          .start = x,
                          .table = -1,
                          .pole = -z,
                          .last_azimuth = 0,
                          .grid = {}};
        if (measured) place_table(made, tables.intensities[lamp.distribution], x, y, z);
        list.lamps.push_back(made);
        list.indices.push_back(uint32_t(&placed - lamps.data()));
        switch (order(lamp.kind)) {
            case 0:
                ++list.counts.cones;
                break;
            case 1:
                ++list.counts.powers;
                break;
            case 2:
                ++list.counts.tables;
                break;
            default:
                ++list.counts.directional;
        }
    }
    return list;
}

void set_to_one(LampList& list, float reference_distance) {
    for (size_t i = 0; i < list.lamps.size(); ++i) {
        shared::Lamp& lamp = list.lamps[i];
        const bool directional = i >= list.placed();
        lamp.intensity = directional ? 1 : reference_distance * reference_distance;
        lamp.colour /= std::max({lamp.colour.r, lamp.colour.g, lamp.colour.b, 1e-6f});
    }
}

}  // namespace vesper::gpu_scene
