// Building the scene of a road. SPDX-License-Identifier: MIT
#include "scene/road_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/colour.h"

namespace vesper {
namespace {

/// Columns: the world's directions of the road's axes.
const glm::dmat3 kToWorld{{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}};

constexpr double kMargin = 80;  // m, of surface behind the observers

Primitive carriageway(const RoadLayout& road, double first, double last) {
    Primitive plane;
    for (const glm::dvec2 corner :
         {glm::dvec2(first, 0), glm::dvec2(last, 0), glm::dvec2(last, road.width), glm::dvec2(first, road.width)}) {
        Vertex vertex;
        vertex.position = glm::vec3(road_to_world({corner.x, corner.y, 0}));
        vertex.uv = glm::vec2(corner);
        plane.vertices.push_back(vertex);
        plane.bounds.add(vertex.position);
    }
    plane.indices = {0, 1, 2, 0, 2, 3};
    return plane;
}

void add_luminaires(Scene& scene, const RoadLayout& road, const std::vector<RoadLuminaire>& lamps, double factor,
                    const LuminousOpening& opening) {
    scene.distributions.push_back(road.distribution);
    Lamp lamp{.name = road.distribution.name, .kind = Lamp::Kind::Measured};
    lamp.intensity = static_cast<float>(road.flux_factor * factor);
    lamp.opening = opening;
    if (road.colour_temperature > 0) lamp.colour = glm::vec3(colour_of_temperature(road.colour_temperature));
    lamp.distribution = 0;
    scene.lamps.push_back(lamp);
    for (const RoadLuminaire& luminaire : lamps) {
        Node node{.name = "luminaire " + std::to_string(scene.nodes.size() + 1)};
        node.translation = glm::vec3(road_to_world(luminaire.position));
        node.rotation = glm::quat(glm::normalize(glm::quat_cast(kToWorld * luminaire.axes)));
        node.lamp = 0;
        scene.nodes.push_back(node);
    }
}

void add_observers(Scene& scene, const RoadLayout& road) {
    for (const RoadObserver& observer : road_observers(road)) {
        const std::string name = "observer lane " + std::to_string(observer.lane);
        Node node{.name = name};
        node.translation = glm::vec3(road_to_world(observer.eye));
        node.rotation = glm::angleAxis(static_cast<float>(-std::numbers::pi / 180), glm::vec3(1, 0, 0));
        node.camera = static_cast<uint32_t>(scene.cameras.size());
        scene.cameras.push_back({.name = name, .vertical_fov = 0.35f});
        scene.nodes.push_back(node);
    }
}

Scene bare_road(const RoadLayout& road, double last) {
    const double eye = road_observers(road)[0].eye.x;
    Scene scene{.name = road.name};
    scene.reflection_tables.push_back(road.surface);
    Material material{.name = "road " + road.surface.name};
    const auto reflectance =
        static_cast<float>(std::min(std::numbers::pi * diffuse_luminance_coefficient(extended(road.surface)), 1.0));
    material.base_colour = {reflectance, reflectance, reflectance, 1};
    material.reflection_table = 0;
    scene.materials.push_back(material);
    Mesh mesh{.name = "carriageway"};
    mesh.primitives.push_back(carriageway(road, eye - kMargin, last));
    scene.meshes.push_back(mesh);
    Node surface{.name = "carriageway"};
    surface.mesh = 0;
    scene.nodes.push_back(surface);
    return scene;
}

}  // namespace

glm::dvec3 road_to_world(glm::dvec3 point) { return kToWorld * point; }

std::vector<RoadLuminaire> road_scene_luminaires(const RoadLayout& road) {
    const double height = road_height(road);
    return road_luminaires(road, road_observers(road)[0].eye.x - 5 * height, road.spacing + 12 * height);
}

Scene road_scene(const RoadLayout& road) {
    check_road(road);
    Scene scene = bare_road(road, road.spacing + 12 * road_height(road));
    add_luminaires(scene, road, road_scene_luminaires(road), road.maintenance_factor, {});
    add_observers(scene, road);
    return scene;
}

Scene road_glare_scene(const RoadLayout& road, double from) {
    check_road(road);
    Scene scene = bare_road(road, from + kGlareRange);
    scene.materials[0].base_colour = {0, 0, 0, 1};
    scene.materials[0].reflection_table = kNone;
    scene.reflection_tables.clear();
    LuminousOpening opening;
    opening.length = 0.02, opening.width = 0.02;
    add_luminaires(scene, road, road_luminaires(road, from, from + kGlareRange), 1, opening);
    return scene;
}

}  // namespace vesper
