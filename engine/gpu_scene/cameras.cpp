#include "gpu_scene/cameras.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "scene/scene.h"

namespace vesper::gpu_scene {
namespace {

scene::Bounds world_bounds(const scene::Scene& scene, const SceneFrame& frame) {
    scene::Bounds bounds;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == scene::kNone) continue;
        for (const scene::Primitive& primitive : scene.meshes[scene.nodes[i].mesh].primitives) {
            if (primitive.bounds.empty()) continue;
            for (const glm::dvec3 corner : scene::placed_corners(primitive.bounds, frame.world[i]))
                bounds.add(glm::vec3(corner));
        }
    }
    return bounds;
}

View framing_view(const scene::Scene& scene, const SceneFrame& frame, VkExtent2D extent) {
    constexpr float kFov = 0.6435f;  // rad, the default of Camera
    scene::Bounds bounds = world_bounds(scene, frame);
    if (bounds.empty()) bounds.add({-1, -1, -1}), bounds.add({1, 1, 1});
    const glm::vec3 centre = (bounds.low + bounds.high) * 0.5f;
    const float radius = std::max(1e-3f, glm::length(bounds.high - centre));
    const float narrow = std::min(1.0f, float(extent.width) / float(extent.height));
    const float distance = radius / std::sin(std::atan(std::tan(kFov / 2) * narrow));
    const glm::vec3 eye = centre + glm::normalize(glm::vec3(0.35f, 0.4f, 1)) * distance;
    return View::symmetric(extent, kFov, glm::lookAt(eye, centre, glm::vec3(0, 1, 0)),
                           std::max(1e-4f, (distance - radius) * 0.1f));
}

// World to the frame of a node, without its scale.
glm::dmat4 view_from(const glm::dmat4& world) {
    glm::dmat4 pose(1);
    const glm::dvec3 back(world[2]), up(world[1]);
    pose[2] = glm::dvec4(glm::normalize(back), 0);
    pose[0] = glm::dvec4(glm::normalize(glm::cross(up, back)), 0);
    pose[1] = glm::dvec4(glm::cross(glm::dvec3(pose[2]), glm::dvec3(pose[0])), 0);
    pose[3] = world[3];
    return glm::inverse(pose);
}

}  // namespace

std::vector<std::string> camera_names(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const scene::Node& node : scene.nodes)
        if (node.camera != scene::kNone)
            names.push_back(scene.cameras[node.camera].name.empty() ? node.name : scene.cameras[node.camera].name);
    return names;
}

View camera_view(const scene::Scene& scene, const SceneFrame& frame, const std::string& name, VkExtent2D extent) {
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].camera == scene::kNone) continue;
        const scene::Camera& camera = scene.cameras[scene.nodes[i].camera];
        if (!name.empty() && name != camera.name && name != scene.nodes[i].name) continue;
        return View::symmetric(extent, camera.vertical_fov, view_from(frame.world[i]), camera.near);
    }
    if (name.empty()) return framing_view(scene, frame, extent);
    std::string known;
    for (const std::string& n : camera_names(scene)) known += (known.empty() ? "" : ", ") + n;
    throw Error((scene.name.empty() ? "the scene" : scene.name) + ": no camera '" + name + "'; there is " +
                (known.empty() ? "none" : known));
}

}  // namespace vesper::gpu_scene
