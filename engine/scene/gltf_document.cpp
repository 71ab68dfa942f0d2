// A glTF file as it stands on disk: container format, version, extensions, buffers. SPDX-License-Identifier: MIT
#include "scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/read_file.h"
#include "scene/gltf_compressed.h"
#include "scene/gltf_model.h"
#include "scene/uri.h"

namespace vesper::scene {
namespace {

constexpr std::array<std::string_view, 15> kSupported = {
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_texture_transform",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "EXT_lights_ies",
    "KHR_node_visibility",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    // Pictures: a material whose picture cannot be read shows its factors.
    "EXT_texture_webp",
    "EXT_texture_avif",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
};
constexpr uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

uint32_t word_at(std::span<const uint8_t> bytes, size_t offset) {
    return static_cast<uint32_t>(bytes[offset]) | static_cast<uint32_t>(bytes[offset + 1]) << 8 |
           static_cast<uint32_t>(bytes[offset + 2]) << 16 | static_cast<uint32_t>(bytes[offset + 3]) << 24;
}

struct Chunks {
    std::span<const uint8_t> json;
    std::optional<std::span<const uint8_t>> binary;
};

/// The chunks of a binary glTF (specification 2.0, chapter 4). Unknown chunks are skipped, as it demands.
Chunks split_glb(std::span<const uint8_t> file, const std::string& name) {
    const auto fail = [&](size_t offset, const std::string& reason) -> Error {
        return Error(name + ": byte " + std::to_string(offset) + ": " + reason);
    };
    if (file.size() < 12) throw fail(file.size(), "binary glTF header is cut off");
    if (word_at(file, 4) != 2)
        throw fail(4, "binary glTF of version " + std::to_string(word_at(file, 4)) + ": only version 2 is read");
    const uint32_t length = word_at(file, 8);
    if (length > file.size())
        throw fail(8, "the file is cut off: " + std::to_string(length) + " bytes stated, " +
                          std::to_string(file.size()) + " there");
    if (length < 12) throw fail(8, "stated length of " + std::to_string(length) + " bytes is less than its header");
    file = file.first(length);

    Chunks chunks;
    for (size_t at = 12, number = 0; at < file.size(); ++number) {
        if (file.size() - at < 8) throw fail(at, "chunk header is cut off");
        const uint64_t size = word_at(file, at);
        const uint32_t type = word_at(file, at + 4);
        if (size > file.size() - at - 8)
            throw fail(at, "chunk of " + std::to_string(size) + " bytes does not fit into the file");
        const auto bytes = file.subspan(at + 8, size);
        if (number == 0 && type != kJsonChunk) throw fail(at + 4, "the first chunk must be JSON");
        if (number == 0) chunks.json = bytes;
        if (number == 1 && type == kBinaryChunk) chunks.binary = bytes;
        at += 8 + size + (4 - size % 4) % 4;
    }
    if (chunks.json.empty()) throw fail(12, "there is no JSON chunk");
    return chunks;
}

/// Major and minor of "2.0".
std::optional<std::pair<uint32_t, uint32_t>> parse_version(const std::string& text) {
    unsigned major = 0, minor = 0;
    int used = 0;
    if (text.size() > 12 || std::sscanf(text.c_str(), "%5u.%5u%n", &major, &minor, &used) != 2) return std::nullopt;
    if (static_cast<size_t>(used) != text.size()) return std::nullopt;
    return std::pair(major, minor);
}

}  // namespace

void erase_extension(nlohmann::json& holder, const char* name) {
    const auto extensions = holder.find("extensions");
    if (extensions == holder.end() || !extensions->is_object()) return;
    extensions->erase(name);
    if (extensions->empty()) holder.erase("extensions");
}

bool is_supported_extension(std::string_view name) {
    if (name == "KHR_draco_mesh_compression") return reads_draco();
    return std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
}

GltfDocument::GltfDocument(const std::filesystem::path& file, const SceneLimits& limits)
    : folder_(file.parent_path()), limits_(limits) {
    const std::string name = one_line(file.string());
    const std::vector<uint8_t> bytes = io::read_file(file, limits.file_bytes);
    if (bytes.empty()) throw Error(name + ": is empty");
    if (bytes.size() >= 4 && word_at(bytes, 0) == kMagic) {
        const Chunks chunks = split_glb(bytes, name);
        json_ = parse_json(chunks.json, name);
        has_binary_chunk_ = chunks.binary.has_value();
        if (chunks.binary) binary_chunk_.assign(chunks.binary->begin(), chunks.binary->end());
    } else {
        json_ = parse_json(bytes, name);
    }
    check_format();
    buffers_.resize(list("buffers").size());
    expand_draco(*this);
}

void GltfDocument::check_format() {
    const JsonValue asset = root().at("asset");
    const JsonValue version = asset.at("version");
    const auto stated = parse_version(version.text());
    if (!stated || stated->first != 2) version.fail("glTF version '" + version.text() + "': only 2.0 is read");
    if (const auto minimum = asset.find("minVersion")) {
        const auto least = parse_version(minimum->text());
        if (!least || *least > std::pair(2u, 0u))
            minimum->fail("needs a reader of glTF '" + minimum->text() + "': this one reads 2.0");
    }
    for (const JsonValue& extension : root().elements_of("extensionsRequired"))
        if (!is_supported_extension(extension.text()))
            extension.fail("the file requires the extension " + extension.text() + ", which is not supported");
    for (const JsonValue& extension : root().elements_of("extensionsUsed")) extension.text();
}

std::span<const JsonValue> GltfDocument::list(const char* key) {
    for (const auto& [name, values] : lists_)
        if (name == key) return values;
    return lists_.emplace_back(key, root().elements_of(key)).second;
}

JsonValue GltfDocument::element(const char* key, const JsonValue& reference) {
    const auto values = list(key);
    const JsonValue found = values[reference.index(values.size(), key)];
    if (!found.json().is_object()) found.fail("must be an object");
    return found;
}

std::vector<uint8_t> GltfDocument::bytes_of_uri(const JsonValue& uri) {
    // Many URIs may name the same large file: the sum is bounded as well.
    std::vector<uint8_t> bytes;
    std::filesystem::path file;
    const bool data = is_data_uri(uri.text());
    try {
        if (!data) file = resolve_uri(folder_, uri.text());
    } catch (const Error& error) {
        uri.fail(error.what());
    }
    try {
        if (data) return decode_data_uri(uri.text());
        bytes = io::read_file(file, limits_.file_bytes);
    } catch (const OutOfHostMemory&) {
        throw;
    } catch (const io::WouldReplace&) {
        throw;
    } catch (const OverLimit& error) {
        uri.fail(error.what());
    } catch (const Error& error) {
        throw UnreadFile(uri.place() + ": " + error.what(), error.what());
    }
    bytes_read_ += bytes.size();
    if (bytes_read_ / 4 > limits_.file_bytes)
        uri.fail("the files named add up to more than four times the limit for one");
    return bytes;
}

bool GltfDocument::has_bytes(uint32_t buffer) {
    if (buffer < buffers_.size() && buffers_[buffer]) return true;
    return list("buffers")[buffer].find("uri").has_value() || (buffer == 0 && has_binary_chunk_) ||
           is_compressed(buffer);
}

bool GltfDocument::is_compressed(uint32_t buffer) {
    const JsonValue holder = list("buffers")[buffer];
    if (holder.find("uri")) return false;
    const auto extensions = holder.find("extensions");
    return extensions && (extensions->find("EXT_meshopt_compression") || extensions->find("KHR_meshopt_compression"));
}

std::span<const uint8_t> GltfDocument::buffer(uint32_t index) {
    const JsonValue buffer = list("buffers")[index];
    const uint64_t length = buffer.at("byteLength").integer();
    const auto uri = buffer.find("uri");
    std::span<const uint8_t> bytes;
    if (index >= buffers_.size()) buffers_.resize(list("buffers").size());  // the converter adds some
    if (!buffers_[index] && uri) buffers_[index] = bytes_of_uri(*uri);
    if (!buffers_[index] && is_compressed(index)) buffers_[index] = decode_meshopt(*this, index);
    if (buffers_[index])
        bytes = *buffers_[index];
    else if (has_bytes(index))
        bytes = binary_chunk_;
    else
        buffer.fail("has neither a uri nor a binary chunk to lie in");
    if (length > bytes.size())
        buffer.fail("is cut off: " + std::to_string(length) + " bytes stated, " + std::to_string(bytes.size()) +
                    " there");
    return bytes.first(length);
}

std::span<const uint8_t> GltfDocument::view(uint32_t index) {
    const JsonValue view = list("bufferViews")[index];
    const auto bytes = buffer(view.at("buffer").index(list("buffers").size(), "buffers"));
    const uint64_t offset = view.integer_or("byteOffset", 0), length = view.at("byteLength").integer();
    if (offset > bytes.size() || length > bytes.size() - offset)
        view.fail("reaches beyond its buffer of " + std::to_string(bytes.size()) + " bytes");
    return bytes.subspan(offset, length);
}

void GltfDocument::take_unwritten(const JsonValue& accessor, uint64_t count) {
    const uint64_t limit = limits_.vertices / 50;  // a file of a few bytes should not take gigabytes
    if (count > limit - unwritten_)
        accessor.fail("has no buffer view: its " + std::to_string(count) +
                      " elements take those that the file does not hold over the limit of " + std::to_string(limit));
    unwritten_ += count;
}

std::vector<uint8_t> GltfDocument::file_of(const JsonValue& holder) {
    if (const auto uri = holder.find("uri")) return bytes_of_uri(*uri);
    if (const auto number = holder.find("bufferView")) {
        const auto bytes = view(number->index(list("bufferViews").size(), "bufferViews"));
        return {bytes.begin(), bytes.end()};
    }
    holder.fail("has neither uri nor bufferView");
}

const tinygltf::Model& GltfDocument::model() {
    if (!model_) model_ = read_model(*this);
    return *model_;
}

nlohmann::json& GltfDocument::edit() {
    lists_.clear();
    model_.reset();
    return json_.root;
}

void GltfDocument::add_buffer(std::vector<uint8_t> bytes) {
    buffers_.resize(list("buffers").size());
    edit()["buffers"].push_back({{"byteLength", bytes.size()}});
    buffers_.emplace_back(std::move(bytes));
}

}  // namespace vesper::scene
