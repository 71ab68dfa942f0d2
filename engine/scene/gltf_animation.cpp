// Key frames of a glTF file. SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/gltf_reader.h"

namespace vesper::scene {
namespace {

std::optional<Channel::Path> path_of(GltfReader& reader, const std::string& path) {
    if (path == "translation") return Channel::Path::Translation;
    if (path == "rotation") return Channel::Path::Rotation;
    if (path == "scale") return Channel::Path::Scale;
    reader.notes.add("an animation of '" + path + "' is left out");
    return std::nullopt;
}

Channel::Interpolation interpolation_of(GltfReader& reader, const std::string& mode) {
    if (mode == "LINEAR") return Channel::Interpolation::Linear;
    if (mode == "STEP") return Channel::Interpolation::Step;
    if (mode == "CUBICSPLINE") return Channel::Interpolation::Cubic;
    reader.notes.add("an interpolation that glTF does not have is read as LINEAR");
    return Channel::Interpolation::Linear;
}

void read_times(GltfReader& reader, Channel& channel, const GltfPart<tinygltf::AnimationSampler>& sampler) {
    channel.times =
        read_floats(reader.document, sampler->input, {TINYGLTF_TYPE_SCALAR}, reader.limits.vertices - reader.keys)
            .values;
    reader.keys += channel.times.size();
    const JsonValue input = sampler.json.at("input");
    for (size_t i = 0; i < channel.times.size(); ++i)
        if (!std::isfinite(channel.times[i]) || channel.times[i] < (i == 0 ? 0 : channel.times[i - 1]))
            input.fail("key " + std::to_string(i) + ": times must be finite, from 0 and ascending");
}

void read_values(GltfReader& reader, Channel& channel, const GltfPart<tinygltf::AnimationSampler>& sampler) {
    const bool rotation = channel.path == Channel::Path::Rotation,
               cubic = channel.interpolation == Channel::Interpolation::Cubic;
    const Floats values = read_floats(reader.document, sampler->output,
                                      {rotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3}, reader.limits.vertices);
    const JsonValue output = sampler.json.at("output");
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

void read_channel(GltfReader& reader, const GltfPart<tinygltf::Animation>& animation,
                  const tinygltf::AnimationChannel& source) {
    const auto path = path_of(reader, source.target_path);
    if (!path) return;
    const auto index = static_cast<uint32_t>(source.target_node), moved = reader.node_of[index];
    if (moved == kNone) return;  // not in this scene
    if (reader.skinned.contains(index) && reader.scene.nodes[moved].mesh != kNone)
        return;  // its joints say where it is
    if (reader.scene.nodes[moved].matrix) {
        reader.notes.add("the animation of a node that has a matrix is left out");
        return;
    }
    const auto number = static_cast<size_t>(source.sampler);
    const GltfPart<tinygltf::AnimationSampler> sampler{&animation->samplers[number],
                                                       animation.json.at("samplers").elements()[number]};
    Channel channel;
    channel.node = moved;
    channel.path = *path;
    channel.interpolation = interpolation_of(reader, sampler->interpolation);
    read_times(reader, channel, sampler);
    read_values(reader, channel, sampler);
    reader.scene.channels.push_back(std::move(channel));
}

}  // namespace

void read_animations(GltfReader& reader) {
    const auto& animations = reader.document.model().animations;
    for (size_t i = 0; i < animations.size(); ++i) {
        const GltfPart<tinygltf::Animation> animation{&animations[i], reader.document.list("animations")[i]};
        // tinygltf leaves out those without a node, which extensions have.
        if (animation.json.at("channels").json().size() > animation->channels.size())
            reader.notes.add("an animation of no node is left out");
        for (const tinygltf::AnimationChannel& channel : animation->channels) read_channel(reader, animation, channel);
    }
}

}  // namespace vesper::scene
