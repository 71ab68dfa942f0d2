#include "approach.h"

#include <algorithm>
#include <map>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "base/one_line.h"
#include "gpu_scene/cameras.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "scene/photometry.h"
#include "scene/placement.h"

namespace vesper::commands {
namespace {

using glm::dmat4, glm::dvec3;

/// The nodes that match and have none above them that does, per node. Throws Error if there is none.
std::vector<bool> nodes_that_match(const scene::Scene& scene, const std::string& option, const std::string& pattern) {
    std::vector<bool> found(scene.nodes.size()), within(scene.nodes.size());
    bool any = false;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const uint32_t parent = scene.nodes[i].parent;
        within[i] = parent != scene::kNone && (within[parent] || found[parent]);
        found[i] = !within[i] && scene::matches_node(pattern, scene, i);
        any |= found[i];
    }
    if (!any) throw Error(option + " " + one_line(pattern) + ": no node of the scene matches it");
    return found;
}

bool is_below(const scene::Scene& scene, uint32_t node, uint32_t above) {
    while (node != above && node != scene::kNone) node = scene.nodes[node].parent;
    return node == above;
}

/// A box about the meshes at and below a node, along the axes of the world.
scene::Bounds box_of(const scene::Scene& scene, uint32_t node, const std::vector<dmat4>& world) {
    scene::Bounds box;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == scene::kNone || !is_below(scene, i, node)) continue;
        for (const scene::Primitive& primitive : scene.meshes[scene.nodes[i].mesh].primitives)
            for (const scene::Vertex& vertex : primitive.vertices)
                box.add(glm::vec3(world[i] * glm::dvec4(vertex.position, 1)));
    }
    return box;
}

}  // namespace

Approach::Approach(scene::Scene scene, const ApproachSettings& settings, const std::vector<Beam>& beams)
    : scene_(std::move(scene)), rest_(scene::world_transforms(scene_, 0)) {
    find_car(settings);
    find_obstacle(settings);
    oncoming_.assign(scene_.nodes.size(), false);
    if (!settings.oncoming.empty())
        oncoming_ = scene::at_and_below(scene_, nodes_that_match(scene_, "--oncoming", settings.oncoming));
    if (oncoming_[car_] || oncoming_[camera_])
        throw Error("--oncoming " + one_line(settings.oncoming) + ": this is the car of the camera");
    leave_out(settings);
    for (const Beam& beam : beams) {
        beams_.emplace_back();
        if (beam.distribution)
            add_beam(*beam.distribution, beam.name);
        else
            beams_.back() = lamps_;
    }
    rest_ = scene::world_transforms(scene_, 0);
    oncoming_.resize(scene_.nodes.size());
}

// The nearest node above the camera with headlamps.
void Approach::find_car(const ApproachSettings& settings) {
    gpu_scene::camera_view(scene_, {rest_}, settings.camera, {16, 16});  // names the cameras there are
    const auto named = [&](const scene::Node& node) {
        if (node.camera == scene::kNone) return false;
        const std::string& name = scene_.cameras[node.camera].name;
        return settings.camera.empty() || (name.empty() ? node.name : name) == settings.camera;
    };
    const auto camera = std::ranges::find_if(scene_.nodes, named);
    if (camera == scene_.nodes.end()) throw Error("--camera: the scene has no camera that could ride in a car");
    camera_ = uint32_t(camera - scene_.nodes.begin());
    const std::vector<bool> named_so = nodes_that_match(scene_, "--headlamps", settings.headlamps);
    const std::vector<uint32_t> all = scene::nodes_with_lamps(scene_);
    for (car_ = scene_.nodes[camera_].parent; car_ != scene::kNone && lamps_.empty();) {
        for (uint32_t headlamp = 0; headlamp < named_so.size(); ++headlamp) {
            if (!named_so[headlamp] || !is_below(scene_, headlamp, car_)) continue;
            const size_t before = lamps_.size();
            for (const uint32_t lamp : all)
                if (is_below(scene_, lamp, headlamp)) lamps_.push_back(lamp);
            if (lamps_.size() > before) headlamps_.push_back(lamps_[before]);
        }
        if (lamps_.empty()) car_ = scene_.nodes[car_].parent;
    }
    if (lamps_.empty())
        throw Error("--headlamps " + one_line(settings.headlamps) + ": no node above the camera " +
                    one_line(camera->name) + " has lamps of that name below it");
    dvec3 axis(0);
    for (const uint32_t lamp : lamps_) axis -= glm::normalize(dvec3(rest_[lamp][2]));
    axis.y = 0;
    if (glm::length(axis) < 0.1 * double(lamps_.size()))
        throw Error("--headlamps " + one_line(settings.headlamps) + ": these lamps do not shine ahead");
    forward_ = glm::normalize(axis);
}

void Approach::find_obstacle(const ApproachSettings& settings) {
    const std::vector<bool> found = nodes_that_match(scene_, "--obstacle", settings.obstacle);
    const auto fail = [&](const std::string& reason) {
        throw Error("--obstacle " + one_line(settings.obstacle) + ": " + reason);
    };
    if (const auto count = std::ranges::count(found, true); count > 1)
        fail(std::to_string(count) + " nodes match, and one is wanted");
    obstacle_ = uint32_t(std::ranges::find(found, true) - found.begin());
    if (is_below(scene_, obstacle_, car_) || is_below(scene_, car_, obstacle_)) fail("this is the car of the camera");
    obstacle_pose_ = rest_[obstacle_];
    if (settings.obstacle_place) obstacle_pose_[3] = glm::dvec4(*settings.obstacle_place, 1);
    const scene::Bounds box =
        box_of(scene_, obstacle_, scene::placed_transforms(scene_, 0, {{obstacle_, glm::mat4(obstacle_pose_)}}));
    if (box.empty()) fail("it has no surfaces");
    target_ = 0.5 * (dvec3(box.low) + dvec3(box.high));
}

void Approach::leave_out(const ApproachSettings& settings) {
    for (const std::string& pattern : settings.without) {
        const std::vector<bool> gone = scene::at_and_below(scene_, nodes_that_match(scene_, "--without", pattern));
        for (uint32_t i = 0; i < scene_.nodes.size(); ++i)
            if (gone[i] && !oncoming_[i] && !is_below(scene_, i, car_) && !is_below(scene_, i, obstacle_))
                scene_.nodes[i].mesh = scene_.nodes[i].lamp = scene::kNone;
    }
}

void Approach::add_beam(const photometry::Distribution& distribution, const std::string& name) {
    scene_.distributions.push_back(distribution);
    const dvec3 up(0, 1, 0);
    const glm::dmat3 level(glm::cross(forward_, up), up, -forward_);
    for (const uint32_t headlamp : headlamps_) {
        scene::Lamp lamp = scene_.lamps[scene_.nodes[headlamp].lamp];
        lamp.name = name;
        lamp.kind = scene::Lamp::Kind::Measured;
        lamp.intensity = 1;
        lamp.distribution = uint32_t(scene_.distributions.size() - 1);
        const glm::dmat3 axes(rest_[headlamp]);
        const glm::dmat3 turn(glm::normalize(axes[0]), glm::normalize(axes[1]), glm::normalize(axes[2]));
        glm::dmat3 local = glm::transpose(turn) * level;
        scene::Node node;
        node.name = name;
        node.parent = headlamp;
        if (glm::determinant(local) < 0) local[0] = -local[0], node.scale.x = -1;  // a mirrored headlamp; beams are not
        node.rotation = glm::quat(glm::normalize(glm::quat_cast(local)));
        node.lamp = uint32_t(scene_.lamps.size());
        node.fixture = scene_.nodes[headlamp].fixture;
        beams_.back().push_back(uint32_t(scene_.nodes.size()));
        scene_.lamps.push_back(lamp);
        scene_.nodes.push_back(node);
    }
}

double Approach::aside() const {
    return glm::dot(target_ - dvec3(rest_[camera_][3]), glm::cross(forward_, dvec3(0, 1, 0)));
}

double Approach::road_illuminance(size_t beam, double ahead, double right) const {
    const dvec3 eye(rest_[camera_][3]), aside = glm::cross(forward_, dvec3(0, 1, 0));
    dvec3 place = eye + ahead * forward_ + right * aside;
    place.y = rest_[car_][3].y;
    double sum = 0;
    for (const uint32_t node : beams_[beam]) {
        const dvec3 way = place - dvec3(rest_[node][3]);
        const double distance = glm::length(way);
        if (way.y >= 0) continue;
        const dvec3 direction = glm::transpose(scene::lamp_frame(rest_[node])) * way;
        sum += scene::luminous_intensity(scene_.lamps[scene_.nodes[node].lamp], scene_.distributions, direction) *
               -way.y / (distance * distance * distance);
    }
    return sum;
}

gpu_scene::SceneFrame Approach::at(double distance, size_t beam, bool oncoming) const {
    const double ahead = glm::dot(target_ - dvec3(rest_[camera_][3]), forward_);
    dmat4 car = rest_[car_];
    car[3] += glm::dvec4((ahead - distance) * forward_, 0);
    gpu_scene::SceneFrame frame{
        scene::placed_transforms(scene_, 0, {{car_, glm::mat4(car)}, {obstacle_, glm::mat4(obstacle_pose_)}})};
    frame.dimming.assign(scene_.nodes.size(), 1);
    for (uint32_t i = 0; i < scene_.nodes.size(); ++i)
        if (oncoming_[i] && !oncoming) frame.dimming[i] = 0;
    for (const uint32_t node : lamps_) frame.dimming[node] = 0;
    for (const std::vector<uint32_t>& nodes : beams_)
        for (const uint32_t node : nodes) frame.dimming[node] = 0;
    for (const uint32_t node : beams_[beam]) frame.dimming[node] = 1;
    std::vector<bool> moving = scene::animated_nodes(scene_);
    moving[car_] = true;
    frame.moving = scene::at_and_below(scene_, moving);
    return frame;
}

}  // namespace vesper::commands
