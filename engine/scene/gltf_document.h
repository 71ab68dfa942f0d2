// A glTF file as it stands on disk: its JSON, the parts that tinygltf reads from it, and its bytes.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/json_value.h"
#include "scene/read_scene.h"
#include "scene/tinygltf.h"

namespace vesper::scene {

/// A file that a document names is missing or damaged. The message has the place; `reason` does not.
struct UnreadFile : Error {
    UnreadFile(const std::string& message, std::string why) : Error(message), reason(std::move(why)) {}
    std::string reason;
};

/// A part of a file as tinygltf reads it, and the JSON that it is read from, for messages and extensions.
template <class T>
struct GltfPart {
    const T* part;
    JsonValue json;

    const T* operator->() const { return part; }
};

/// JSON and binary parts of a .gltf or .glb file. Format, version, required extensions and every range it hands out
/// are checked; everything else is for the reader.
class GltfDocument {
public:
    /// Throws Error.
    GltfDocument(const std::filesystem::path& file, const SceneLimits& limits);
    GltfDocument(const GltfDocument&) = delete;
    GltfDocument& operator=(const GltfDocument&) = delete;

    JsonValue root() const { return JsonValue(json_); }
    const std::string& name() const { return json_.name; }
    const SceneLimits& limits() const { return limits_; }

    /// An array of the root object: "nodes", "meshes", ...; empty where missing.
    std::span<const JsonValue> list(const char* key);
    /// The element an index names. `reference` is the value that holds the index.
    JsonValue element(const char* key, const JsonValue& reference);

    /// The lists of the file as tinygltf reads them, with types, lengths and references checked, but for cameras,
    /// images, buffers, strides, extensions and extras: of those there is the JSON. Throws Error.
    const tinygltf::Model& model();
    GltfPart<tinygltf::Accessor> accessor(size_t i) { return {&model().accessors[i], list("accessors")[i]}; }
    GltfPart<tinygltf::Material> material(size_t i) { return {&model().materials[i], list("materials")[i]}; }
    GltfPart<tinygltf::Mesh> mesh(size_t i) { return {&model().meshes[i], list("meshes")[i]}; }
    GltfPart<tinygltf::Node> node(size_t i) { return {&model().nodes[i], list("nodes")[i]}; }
    GltfPart<tinygltf::Skin> skin(size_t i) { return {&model().skins[i], list("skins")[i]}; }

    /// Whether a buffer has bytes at all: one without uri and without compressed views is a placeholder.
    bool has_bytes(uint32_t buffer);
    /// Bytes of buffer or buffer view `index`, valid as long as the document.
    std::span<const uint8_t> buffer(uint32_t index);
    std::span<const uint8_t> view(uint32_t index);
    /// Bytes of an encoded picture, from buffer view, data URI or file. Throws UnreadFile where they are not there.
    std::vector<uint8_t> image(uint32_t index) { return file_of(list("images")[index]); }
    /// Bytes of a file that an object names by `uri` or `bufferView`.
    std::vector<uint8_t> file_of(const JsonValue& holder);

    /// Counts elements that an accessor makes of no bytes; throws where all of them are over the limit.
    void take_unwritten(const JsonValue& accessor, uint64_t count);

    /// For changes. Whatever was obtained above is invalid after one.
    nlohmann::json& edit();
    /// Appends a buffer, as after edit().
    void add_buffer(std::vector<uint8_t> bytes);

private:
    void check_format();
    bool is_compressed(uint32_t buffer);
    std::vector<uint8_t> bytes_of_uri(const JsonValue& uri);

    std::filesystem::path folder_;
    SceneLimits limits_;
    JsonFile json_;
    std::vector<uint8_t> binary_chunk_;
    bool has_binary_chunk_ = false;
    uint64_t bytes_read_ = 0, unwritten_ = 0;
    std::vector<std::pair<std::string, std::vector<JsonValue>>> lists_;
    std::vector<std::optional<std::vector<uint8_t>>> buffers_;
    std::unique_ptr<const tinygltf::Model> model_;
};

/// Takes an extension from an object of a document, and "extensions" with the last one.
void erase_extension(nlohmann::json& holder, const char* name);

/// Whether we read, or may ignore, a glTF extension that a file requires.
bool is_supported_extension(std::string_view name);

}  // namespace vesper::scene
