// Where nodes stand at a time: key frames by step, linear or cubic interpolation (glTF 2.0, appendix C).
// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/placement.h"

namespace vesper::scene {
namespace {

glm::quat rotation_of(glm::vec4 xyzw) {
    const glm::quat q(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
    const float length = glm::length(q);
    return length > 0 ? q / length : glm::quat(1, 0, 0, 0);
}

glm::vec4 interpolate_linear(const Channel& channel, size_t key, float fraction) {
    const glm::vec4 from = channel.values[key], to = channel.values[key + 1];
    if (channel.path != Channel::Path::Rotation) return glm::mix(from, to, fraction);
    const glm::quat q = glm::slerp(rotation_of(from), rotation_of(to), fraction);
    return {q.x, q.y, q.z, q.w};
}

/// Hermite spline; the tangents are per second.
glm::vec4 interpolate_cubic(const Channel& channel, size_t key, float fraction, float duration) {
    const glm::vec4 from = channel.values[3 * key + 1], out_tangent = duration * channel.values[3 * key + 2];
    const glm::vec4 to = channel.values[3 * key + 4], in_tangent = duration * channel.values[3 * key + 3];
    const float t = fraction, t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * out_tangent + (3 * t2 - 2 * t3) * to +
           (t3 - t2) * in_tangent;
}

glm::vec4 value_at(const Channel& channel, double seconds) {
    const bool cubic = channel.interpolation == Channel::Interpolation::Cubic;
    const auto held = [&](size_t key) { return channel.values[cubic ? 3 * key + 1 : key]; };
    const std::vector<float>& times = channel.times;
    if (seconds <= times.front()) return held(0);
    if (seconds >= times.back()) return held(times.size() - 1);
    const auto next =
        std::upper_bound(times.begin(), times.end(), seconds, [](double t, float key) { return t < key; });
    const auto key = static_cast<size_t>(next - times.begin()) - 1;
    if (channel.interpolation == Channel::Interpolation::Step) return held(key);
    // The key found is the last one at or before `seconds`, so the next is later and the duration positive.
    const double duration = static_cast<double>(times[key + 1]) - times[key];
    const auto fraction = static_cast<float>((seconds - times[key]) / duration);
    return cubic ? interpolate_cubic(channel, key, fraction, static_cast<float>(duration))
                 : interpolate_linear(channel, key, fraction);
}

void pose(Node& node, Channel::Path path, glm::vec4 value) {
    switch (path) {
        case Channel::Path::Translation:
            node.translation = glm::vec3(value);
            break;
        case Channel::Path::Rotation:
            node.rotation = rotation_of(value);
            break;
        case Channel::Path::Scale:
            node.scale = glm::vec3(value);
            break;
    }
}

}  // namespace

glm::dmat4 local_transform(const Node& node) {
    if (node.matrix) return *node.matrix;
    const glm::dmat3 rotation = glm::mat3_cast(glm::dquat(node.rotation));
    const glm::dvec3 scale(node.scale);
    return {glm::dvec4(rotation[0] * scale.x, 0), glm::dvec4(rotation[1] * scale.y, 0),
            glm::dvec4(rotation[2] * scale.z, 0), glm::dvec4(node.translation, 1)};
}

std::vector<glm::dmat4> world_transforms(const Scene& scene, double seconds) {
    return placed_transforms(scene, seconds, {});
}

std::vector<glm::dmat4> placed_transforms(const Scene& scene, double seconds,
                                          const std::map<uint32_t, glm::mat4>& places) {
    std::vector<glm::dmat4> world(scene.nodes.size());
    for (size_t i = 0; i < scene.nodes.size(); ++i) world[i] = local_transform(scene.nodes[i]);

    // Several channels may move one node: it is posed from its values at rest, then its matrix is made again.
    std::vector<std::pair<uint32_t, Node>> moved;
    std::vector<uint32_t> place(scene.channels.empty() ? 0 : scene.nodes.size(), kNone);
    for (const Channel& channel : scene.channels) {
        if (channel.times.empty()) continue;
        if (place[channel.node] == kNone) {
            place[channel.node] = static_cast<uint32_t>(moved.size());
            moved.emplace_back(channel.node, scene.nodes[channel.node]);
        }
        pose(moved[place[channel.node]].second, channel.path, value_at(channel, seconds));
    }
    for (const auto& [index, node] : moved) world[index] = local_transform(node);

    auto put = places.begin();
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (put != places.end() && put->first == i)
            world[i] = glm::dmat4((put++)->second);
        else if (scene.nodes[i].parent != kNone)
            world[i] = world[scene.nodes[i].parent] * world[i];
    }
    return world;
}

std::vector<bool> at_and_below(const Scene& scene, std::vector<bool> nodes) {
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)  // children come after their parents
        if (scene.nodes[i].parent != kNone && nodes[scene.nodes[i].parent]) nodes[i] = true;
    return nodes;
}

std::vector<bool> animated_nodes(const Scene& scene) {
    std::vector<bool> animated(scene.nodes.size());
    for (const Channel& channel : scene.channels) animated[channel.node] = true;
    return at_and_below(scene, std::move(animated));
}

double animation_length(const Scene& scene) {
    double length = 0;
    for (const Channel& channel : scene.channels)
        if (!channel.times.empty()) length = std::max(length, static_cast<double>(channel.times.back()));
    return length;
}

}  // namespace vesper::scene
