#include "roads/layout_scene.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "roads/road_lighting.h"
#include "scene/colour.h"

namespace vesper::roads {
namespace {

using scene::Scene;

/// Columns: the axes of the layout in the world.
const glm::dmat3 kToWorld{{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}};

constexpr double kMargin = 80;  // m, of surface behind the observers

scene::Primitive carriageway(const LoadedLayout& layout, double first, double last) {
    scene::Primitive plane;
    for (const glm::dvec2 corner :
         {glm::dvec2(first, 0), glm::dvec2(last, 0), glm::dvec2(last, layout.width), glm::dvec2(first, layout.width)}) {
        scene::Vertex vertex;
        vertex.position = glm::vec3(layout_to_world({corner.x, corner.y, 0}));
        vertex.uv = glm::vec2(corner);
        plane.vertices.push_back(vertex);
        plane.bounds.add(vertex.position);
    }
    plane.indices = {0, 1, 2, 0, 2, 3};
    return plane;
}

void add_luminaires(Scene& scene, const LoadedLayout& layout, const std::vector<PlacedLuminaire>& lamps, double factor,
                    const photometry::LuminousOpening& opening) {
    scene.distributions.push_back(layout.distribution);
    scene::Lamp lamp{.name = layout.distribution.name, .kind = scene::Lamp::Kind::Measured};
    lamp.intensity = static_cast<float>(layout.flux_factor * factor);
    lamp.opening = opening;
    if (layout.colour_temperature > 0) lamp.colour = glm::vec3(scene::colour_of_temperature(layout.colour_temperature));
    lamp.distribution = 0;
    scene.lamps.push_back(lamp);
    for (const PlacedLuminaire& luminaire : lamps) {
        scene::Node node{.name = "luminaire " + std::to_string(scene.nodes.size() + 1)};
        node.translation = glm::vec3(layout_to_world(luminaire.position));
        node.rotation = glm::quat(glm::normalize(glm::quat_cast(kToWorld * luminaire.axes)));
        node.lamp = 0;
        scene.nodes.push_back(node);
    }
}

void add_observers(Scene& scene, const LoadedLayout& layout) {
    for (const LaneObserver& observer : lane_observers(layout)) {
        const std::string name = "observer lane " + std::to_string(observer.lane);
        scene::Node node{.name = name};
        node.translation = glm::vec3(layout_to_world(vector_of(observer.eye)));
        node.rotation = glm::angleAxis(static_cast<float>(-kRadiansPerDegree), glm::vec3(1, 0, 0));
        node.camera = static_cast<uint32_t>(scene.cameras.size());
        scene.cameras.push_back({.name = name, .vertical_fov = 0.35f});
        scene.nodes.push_back(node);
    }
}

Scene bare_road(const LoadedLayout& layout, double last) {
    const double eye = lane_observers(layout)[0].eye.x;
    Scene scene{.name = layout.name};
    scene.reflection_tables.push_back(layout.surface);
    scene::Material material{.name = "road " + layout.surface.name};
    const auto reflectance = static_cast<float>(
        std::min(kPi * photometry::diffuse_luminance_coefficient(photometry::extended(layout.surface)), 1.0));
    material.base_colour = {reflectance, reflectance, reflectance, 1};
    material.reflection_table = 0;
    scene.materials.push_back(material);
    scene::Mesh mesh{.name = "carriageway"};
    mesh.primitives.push_back(carriageway(layout, eye - kMargin, last));
    scene.meshes.push_back(mesh);
    scene::Node surface{.name = "carriageway"};
    surface.mesh = 0;
    scene.nodes.push_back(surface);
    return scene;
}

}  // namespace

glm::dvec3 layout_to_world(glm::dvec3 point) { return kToWorld * point; }

std::vector<PlacedLuminaire> layout_scene_luminaires(const LoadedLayout& layout) {
    const double height = mounting_height(layout);
    return placed_luminaires(layout, lane_observers(layout)[0].eye.x - 5 * height, layout.spacing + 12 * height);
}

Scene layout_scene(const LoadedLayout& layout) {
    check_layout(layout);
    Scene scene = bare_road(layout, layout.spacing + 12 * mounting_height(layout));
    add_luminaires(scene, layout, layout_scene_luminaires(layout), layout.maintenance_factor, {});
    add_observers(scene, layout);
    return scene;
}

Scene layout_glare_scene(const LoadedLayout& layout, double from) {
    check_layout(layout);
    Scene scene = bare_road(layout, from + kGlareRange);
    scene.materials[0].base_colour = {0, 0, 0, 1};
    scene.materials[0].reflection_table = scene::kNone;
    scene.reflection_tables.clear();
    photometry::LuminousOpening opening;
    opening.length = 0.02, opening.width = 0.02;
    add_luminaires(scene, layout, placed_luminaires(layout, from, from + kGlareRange), 1, opening);
    return scene;
}

}  // namespace vesper::roads
