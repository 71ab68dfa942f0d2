// Key frames of a glTF file. SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/gltf_reader.h"

namespace vesper {
namespace {

std::optional<Channel::Path> path_of(GltfReader& reader, const JsonValue& target) {
    const std::string& path = target.at("path").text();
    if (path == "translation") return Channel::Path::Translation;
    if (path == "rotation") return Channel::Path::Rotation;
    if (path == "scale") return Channel::Path::Scale;
    reader.notes.add("an animation of '" + path + "' is left out");
    return std::nullopt;
}

Channel::Interpolation interpolation_of(GltfReader& reader, const JsonValue& sampler) {
    const std::string mode = sampler.text_or("interpolation", "LINEAR");
    if (mode == "LINEAR") return Channel::Interpolation::Linear;
    if (mode == "STEP") return Channel::Interpolation::Step;
    if (mode == "CUBICSPLINE") return Channel::Interpolation::Cubic;
    reader.notes.add("an interpolation that glTF does not have is read as LINEAR");
    return Channel::Interpolation::Linear;
}

void read_times(GltfReader& reader, Channel& channel, const JsonValue& input) {
    channel.times = read_floats(reader.document, input, {"SCALAR"}, reader.limits.vertices - reader.keys).values;
    reader.keys += channel.times.size();
    for (size_t i = 0; i < channel.times.size(); ++i)
        if (!std::isfinite(channel.times[i]) || channel.times[i] < (i == 0 ? 0 : channel.times[i - 1]))
            input.fail("key " + std::to_string(i) + ": times must be finite, from 0 and ascending");
}

void read_values(GltfReader& reader, Channel& channel, const JsonValue& output) {
    const bool rotation = channel.path == Channel::Path::Rotation,
               cubic = channel.interpolation == Channel::Interpolation::Cubic;
    const Floats values = read_floats(reader.document, output, {rotation ? "VEC4" : "VEC3"}, reader.limits.vertices);
    const size_t wanted = channel.times.size() * (cubic ? 3 : 1);
    if (values.count != wanted)
        output.fail("has " + std::to_string(values.count) + " values for " + std::to_string(channel.times.size()) +
                    " keys");
    channel.values.resize(wanted, glm::vec4(0));
    for (size_t i = 0; i < wanted; ++i) {
        for (uint32_t c = 0; c < values.components; ++c) {
            const float value = values[i][c];
            if (!std::isfinite(value)) output.fail("value " + std::to_string(i) + " is not finite");
            channel.values[i][static_cast<int>(c)] = value;
        }
    }
}

void read_channel(GltfReader& reader, const JsonValue& animation, const JsonValue& source) {
    const JsonValue target = source.at("target");
    const auto node = target.find("node");
    const auto path = path_of(reader, target);
    if (!node || !path) return;
    const uint32_t index = node->index(reader.node_of.size(), "nodes"), moved = reader.node_of[index];
    if (moved == kNone) return;  // not in this scene
    if (reader.skinned.contains(index) && reader.scene.nodes[moved].mesh != kNone) return;  // its joints say where it is
    if (reader.scene.nodes[moved].matrix) {
        reader.notes.add("the animation of a node that has a matrix is left out");
        return;
    }
    const auto samplers = animation.at("samplers");
    const JsonValue sampler = samplers.element_at(source.at("sampler"), "samplers");
    Channel channel;
    channel.node = moved;
    channel.path = *path;
    channel.interpolation = interpolation_of(reader, sampler);
    read_times(reader, channel, sampler.at("input"));
    read_values(reader, channel, sampler.at("output"));
    reader.scene.channels.push_back(std::move(channel));
}

}  // namespace

void read_animations(GltfReader& reader) {
    for (const JsonValue& animation : reader.document.list("animations"))
        for (const JsonValue& channel : animation.at("channels").elements()) read_channel(reader, animation, channel);
}

}  // namespace vesper
