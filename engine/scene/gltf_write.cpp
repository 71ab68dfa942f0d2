// Writing a glTF document as one file (specification 2.0, chapter 4 for .glb). SPDX-License-Identifier: MIT
#include "scene/gltf_write.h"

#include <algorithm>

#include "base/error.h"
#include "io/image_file.h"
#include "scene/uri.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

/// What lies outside the document, or in data URIs, in memory.
struct Parts {
    std::vector<std::optional<std::span<const uint8_t>>> buffers;  ///< nothing: a placeholder, which stays one
    std::vector<std::vector<uint8_t>> images;  ///< empty where the picture lies in a buffer view, or nowhere
};

Parts collect(GltfDocument& document, std::vector<std::string>& warnings) {
    Parts parts;
    for (uint32_t i = 0; i < document.list("buffers").size(); ++i)
        parts.buffers.push_back(document.has_bytes(i) ? std::optional(document.buffer(i)) : std::nullopt);
    const auto images = document.list("images");
    parts.images.resize(images.size());
    for (uint32_t i = 0; i < images.size(); ++i)
        if (images[i].find("uri")) try {
                parts.images[i] = document.image(i);
            } catch (const OutOfHostMemory&) {
                throw;
            } catch (const Error& error) {  // nothing shows it: the document was read before
                warnings.push_back(std::string(error.what()) + "; the output names it as before");
            }
    return parts;
}

/// Views and buffers that name compressed bytes would be wrong where buffers are put together; the document has them
/// without compression.
void drop_compression(json& root) {
    for (const char* list : {"bufferViews", "buffers"})
        if (root.contains(list))
            for (json& one : root[list])
                for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
                    erase_extension(one, name);
    if (root.contains("meshes"))  // where Draco is not read, these have plain geometry beside it
        for (json& mesh : root["meshes"])
            for (json& primitive : mesh["primitives"]) erase_extension(primitive, "KHR_draco_mesh_compression");
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const auto names = root.find(list);
        if (names == root.end()) continue;
        for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_draco_mesh_compression"})
            names->erase(std::remove(names->begin(), names->end(), json(name)), names->end());
        if (names->empty()) root.erase(list);
    }
}

/// Light profiles that lie in files beside the document come into it as data URIs.
void embed_profiles(GltfDocument& document) {
    std::vector<std::pair<size_t, std::string>> embedded;
    const auto extensions = document.root().find("extensions");
    const auto extension = extensions ? extensions->find("EXT_lights_ies") : std::nullopt;
    if (!extension) return;
    const auto profiles = extension->elements_of("lights");
    for (size_t i = 0; i < profiles.size(); ++i)
        if (profiles[i].find("uri"))
            embedded.emplace_back(i, encode_data_uri("application/x-ies-lm-63", document.file_of(profiles[i])));
    for (const auto& [i, uri] : embedded) document.edit()["extensions"]["EXT_lights_ies"]["lights"][i]["uri"] = uri;
}

std::string type_of(const json& image, std::span<const uint8_t> bytes) {
    std::string known = io::media_type(bytes);
    if (!known.empty()) return known;
    const auto stated = image.find("mimeType");
    return stated != image.end() && stated->is_string() ? stated->get<std::string>() : "application/octet-stream";
}

void append(std::vector<uint8_t>& file, std::span<const uint8_t> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
}

void append_word(std::vector<uint8_t>& file, uint64_t value) {
    for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<uint8_t>(value >> shift));
}

void pad(std::vector<uint8_t>& file, uint8_t with) {
    while (file.size() % 4 != 0) file.push_back(with);
}

void append_chunk(std::vector<uint8_t>& file, uint32_t type, std::span<const uint8_t> bytes) {
    append_word(file, bytes.size());
    append_word(file, type);
    append(file, bytes);
}

/// A picture without a name keeps that of its file.
void keep_name(json& image) {
    const auto uri = image.find("uri");
    if (uri == image.end() || !uri->is_string() || image.contains("name")) return;
    if (!is_data_uri(uri->get_ref<const std::string&>())) image["name"] = *uri;
}

std::vector<uint8_t> encode_text(json& root, const Parts& parts) {
    for (size_t i = 0; i < parts.buffers.size(); ++i)
        if (parts.buffers[i])
            root["buffers"][i]["uri"] = encode_data_uri("application/octet-stream", *parts.buffers[i]);
    for (size_t i = 0; i < parts.images.size(); ++i) {
        json& image = root["images"][i];
        if (parts.images[i].empty()) continue;
        keep_name(image);
        image["uri"] = encode_data_uri(type_of(image, parts.images[i]), parts.images[i]);
    }
    const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
    return {text.begin(), text.end()};
}

std::vector<uint8_t> encode_binary(json& root, const Parts& parts, const std::string& name) {
    std::vector<uint8_t> chunk;
    std::vector<uint64_t> starts;
    for (const auto& buffer : parts.buffers) {
        starts.push_back(chunk.size());
        if (!buffer) throw Error(name + ": has a buffer without bytes, which .glb cannot hold");
        append(chunk, *buffer);
        pad(chunk, 0);
    }
    // All indices are in range: every buffer view was read before.
    if (root.contains("bufferViews"))
        for (json& view : root["bufferViews"]) {
            const auto buffer = view["buffer"].get<size_t>();
            view["buffer"] = 0;
            const auto offset = view.find("byteOffset");
            view["byteOffset"] = starts[buffer] + (offset == view.end() ? 0 : offset->get<uint64_t>());
        }
    for (size_t i = 0; i < parts.images.size(); ++i) {
        json& image = root["images"][i];
        if (parts.images[i].empty()) continue;
        keep_name(image);
        image["mimeType"] = type_of(image, parts.images[i]);
        image["bufferView"] = root["bufferViews"].size();
        image.erase("uri");
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", chunk.size()}, {"byteLength", parts.images[i].size()}});
        append(chunk, parts.images[i]);
        pad(chunk, 0);
    }
    if (chunk.empty())
        root.erase("buffers");
    else
        root["buffers"] = json::array({{{"byteLength", chunk.size()}}});

    const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
    std::vector<uint8_t> header(text.begin(), text.end());
    pad(header, ' ');
    const uint64_t length = 12 + 8 + header.size() + (chunk.empty() ? 0 : 8 + chunk.size());
    if (length > UINT32_MAX)
        throw Error(name + ": as .glb it would have more than 4 GiB, which that format cannot hold");
    std::vector<uint8_t> file;
    file.reserve(length);
    append_word(file, 0x46546C67);
    append_word(file, 2);
    append_word(file, length);
    append_chunk(file, 0x4E4F534A, header);
    if (!chunk.empty()) append_chunk(file, 0x004E4942, chunk);
    return file;
}

}  // namespace

std::vector<uint8_t> encode_gltf(GltfDocument& document, bool binary, std::vector<std::string>& warnings) {
    embed_profiles(document);
    const Parts parts = collect(document, warnings);
    json& root = document.edit();
    drop_compression(root);
    return binary ? encode_binary(root, parts, document.name()) : encode_text(root, parts);
}

}  // namespace vesper::scene
