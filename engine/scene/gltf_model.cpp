// Reading the lists of a glTF file with tinygltf. SPDX-License-Identifier: MIT
#include "scene/gltf_model.h"

#include <cmath>
#include <exception>
#include <new>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

constexpr const char* kLists[]{"bufferViews", "accessors", "meshes",   "nodes", "scenes",
                               "materials",   "textures",  "samplers", "skins", "animations"};

/// What tinygltf is given: no extensions and extras, which stay JSON (its values take 150 bytes each and cut whole
/// numbers), and no 3.0 where it reads a whole number.
json plain(const json& value) {
    if (value.is_array()) {
        json elements = json::array();
        for (const json& element : value) elements.push_back(plain(element));
        return elements;
    }
    if (value.is_object()) {
        json members = json::object();
        for (const auto& [key, member] : value.items())
            if (key != "extensions" && key != "extras") members[key] = plain(member);
        return members;
    }
    if (value.is_number_float())
        if (const double number = value.get<double>();
            number == std::floor(number) && number < 1e15 && !std::signbit(number))
            return static_cast<uint64_t>(number);
    return value;
}

/// Bytes of memory for the elements that tinygltf makes.
uint64_t memory_of(const json& root) {
    const auto count = [](const json& holder, const char* key) -> uint64_t {
        const auto list = holder.find(key);
        return list == holder.end() ? 0 : list->size();
    };
    uint64_t bytes =
        count(root, "accessors") * sizeof(tinygltf::Accessor) + count(root, "nodes") * sizeof(tinygltf::Node) +
        count(root, "scenes") * sizeof(tinygltf::Scene) + count(root, "textures") * sizeof(tinygltf::Texture) +
        count(root, "materials") * sizeof(tinygltf::Material) + count(root, "meshes") * sizeof(tinygltf::Mesh) +
        count(root, "samplers") * sizeof(tinygltf::Sampler) + count(root, "skins") * sizeof(tinygltf::Skin) +
        count(root, "animations") * sizeof(tinygltf::Animation) +
        count(root, "bufferViews") * sizeof(tinygltf::BufferView);
    if (root.contains("meshes"))
        for (const json& mesh : root["meshes"]) bytes += count(mesh, "primitives") * sizeof(tinygltf::Primitive);
    if (root.contains("animations"))
        for (const json& animation : root["animations"])
            bytes += count(animation, "channels") * sizeof(tinygltf::AnimationChannel) +
                     count(animation, "samplers") * sizeof(tinygltf::AnimationSampler);
    return bytes;
}

}  // namespace

std::unique_ptr<const tinygltf::Model> read_model(GltfDocument& document) {
    check_parts(document);
    const json& whole = document.root().json();
    JsonFile parts(document.name(), json{{"asset", json::object()}});
    for (const char* list : kLists)
        if (whole.contains(list)) parts.root[list] = plain(whole[list]);
    // tinygltf refuses strides that are no multiple of four. Bytes are read elsewhere, with any.
    if (parts.root.contains("bufferViews"))
        for (json& view : parts.root["bufferViews"]) view.erase("byteStride");
    const std::string text = parts.root.dump(-1, ' ', false, json::error_handler_t::replace);
    // A small file must not ask for much: elements that say something take more text than this.
    constexpr uint64_t kMostPerByte = 64, kAlways = 64 << 20;
    if (const uint64_t bytes = memory_of(parts.root); bytes > kAlways + kMostPerByte * text.size())
        throw Error(document.name() + ": its lists of empty elements would take " + std::to_string(bytes) + " bytes");

    auto model = std::make_unique<tinygltf::Model>();
    std::string error, warning;
    try {
        if (tinygltf::TinyGLTF().LoadASCIIFromString(model.get(), &error, &warning, text.data(),
                                                     static_cast<unsigned>(text.size()), "", tinygltf::NO_REQUIRE))
            return model;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& thrown) {
        error = thrown.what();
    }
    if (error == std::bad_alloc().what()) throw std::bad_alloc();  // caught where tinygltf parses
    throw Error(document.name() + ": " + one_line(error));
}

}  // namespace vesper::scene
