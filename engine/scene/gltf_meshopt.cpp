// EXT_meshopt_compression. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <meshoptimizer.h>

#include "base/budget.h"
#include "scene/gltf_compressed.h"
#include "scene/gltf_document.h"

namespace vesper::scene {
namespace {

/// The format takes two bits for sixteen bytes at least.
constexpr uint64_t kMostPerByte = 64, kAlways = 4096;
constexpr uint8_t kLaterVersion = 0xA1;  // first byte of attributes in version 1
constexpr uint64_t kPadding = 64;        // bytes of a buffer that belong to no view, for each of its views

/// A buffer view as it stands compressed.
struct Compressed {
    JsonValue json;
    std::span<const uint8_t> bytes;
    std::string mode, filter;
    uint64_t count = 0, stride = 0;
};

std::optional<JsonValue> compression_of(const JsonValue& holder) {
    const auto extensions = holder.find("extensions");
    if (!extensions) return std::nullopt;
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (auto found = extensions->find(name)) return found;
    return std::nullopt;
}

Compressed read(GltfDocument& document, const JsonValue& json, uint32_t buffer) {
    const uint32_t from = json.at("buffer").index(document.list("buffers").size(), "buffers");
    const JsonValue holder = document.list("buffers")[from];
    if (from == buffer || !document.has_bytes(from) || (!holder.find("uri") && compression_of(holder)))
        json.at("buffer").fail("names a buffer without bytes of its own");
    const auto bytes = document.buffer(from);
    const uint64_t offset = json.integer_or("byteOffset", 0), length = json.at("byteLength").integer();
    if (offset > bytes.size() || length > bytes.size() - offset)
        json.fail("reaches beyond its buffer of " + std::to_string(bytes.size()) + " bytes");
    Compressed made{.json = json,
                    .bytes = bytes.subspan(offset, length),
                    .mode = json.at("mode").text(),
                    .filter = json.text_or("filter", "NONE"),
                    .count = json.at("count").integer(UINT32_MAX),
                    .stride = json.at("byteStride").integer(256)};
    const bool is_attributes = made.mode == "ATTRIBUTES", is_triangles = made.mode == "TRIANGLES";
    if (!is_attributes && !is_triangles && made.mode != "INDICES") json.at("mode").fail("is no mode of compression");
    const bool fits = is_attributes ? made.stride > 0 && made.stride % 4 == 0 : made.stride == 2 || made.stride == 4;
    if (!fits) json.at("byteStride").fail("does not fit the mode " + made.mode);
    if (is_triangles && made.count % 3 != 0) json.at("count").fail("is no multiple of three");
    if (is_attributes && length > 0 && made.bytes[0] == kLaterVersion)
        json.fail("is of a later version of the format, which is not read");
    if (made.count * made.stride > kAlways + kMostPerByte * length)
        json.at("count").fail("states more elements than its " + std::to_string(length) + " bytes can hold");
    return made;
}

bool decode(const Compressed& from, uint8_t* to) {
    if (from.mode == "ATTRIBUTES")
        return meshopt_decodeVertexBuffer(to, from.count, from.stride, from.bytes.data(), from.bytes.size()) == 0;
    if (from.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(to, from.count, from.stride, from.bytes.data(), from.bytes.size()) == 0;
    return meshopt_decodeIndexSequence(to, from.count, from.stride, from.bytes.data(), from.bytes.size()) == 0;
}

void filter(const Compressed& from, uint8_t* to) {
    if (from.filter == "NONE") return;
    const bool is_attributes = from.mode == "ATTRIBUTES";
    if (is_attributes && from.filter == "OCTAHEDRAL" && (from.stride == 4 || from.stride == 8))
        return meshopt_decodeFilterOct(to, from.count, from.stride);
    if (is_attributes && from.filter == "QUATERNION" && from.stride == 8)
        return meshopt_decodeFilterQuat(to, from.count, from.stride);
    if (is_attributes && from.filter == "EXPONENTIAL") return meshopt_decodeFilterExp(to, from.count, from.stride);
    from.json.at("filter").fail("does not fit the mode and the stride");
}

}  // namespace

std::vector<uint8_t> decode_meshopt(GltfDocument& document, uint32_t buffer) {
    struct Part {
        Compressed from;
        uint64_t offset;
    };
    std::vector<Part> parts;
    uint64_t end = 0, decoded = 0;
    for (const JsonValue& view : document.list("bufferViews")) {
        if (view.at("buffer").index(document.list("buffers").size(), "buffers") != buffer) continue;
        const auto compression = compression_of(view);
        if (!compression) view.fail("lies in a buffer that has compressed bytes alone, and is not compressed");
        const uint64_t offset = view.integer_or("byteOffset", 0, uint64_t{1} << 40),
                       length = view.at("byteLength").integer(uint64_t{1} << 40);
        parts.push_back({read(document, *compression, buffer), offset});
        const uint64_t bytes = parts.back().from.count * parts.back().from.stride;
        if (offset % (parts.back().from.mode == "ATTRIBUTES" ? 4 : parts.back().from.stride) != 0)
            view.at("byteOffset").fail("is no multiple of the size of its elements");
        if (bytes > length) view.at("byteLength").fail("is less than the compressed elements take");
        end = std::max(end, offset + length), decoded += bytes;
    }
    const JsonValue stated = document.list("buffers")[buffer].at("byteLength");
    const uint64_t size = stated.integer();
    if (std::max(size, end) > decoded + kPadding * (parts.size() + 1))
        stated.fail("is more than its compressed views, which have " + std::to_string(decoded) + " bytes");
    spend(std::max(size, end));
    std::vector<uint8_t> made(std::max(size, end), 0);
    for (const Part& part : parts) {
        check_time();
        if (!decode(part.from, made.data() + part.offset)) part.from.json.fail("is damaged");
        filter(part.from, made.data() + part.offset);
    }
    return made;
}

}  // namespace vesper::scene
