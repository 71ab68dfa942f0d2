// Reading a scene from glTF: the table of contents. SPDX-License-Identifier: MIT
#include "scene/gltf.h"

#include <new>
#include <string_view>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "scene/gltf_reader.h"
#include "scene/rotation.h"

namespace vesper::scene {
namespace {

/// A damaged file is refused also where the damage does not show.
void check_unused(GltfReader& reader) {
    GltfDocument& document = reader.document;
    const size_t buffers = document.list("buffers").size();
    for (uint32_t i = 0; i < buffers; ++i)
        if (document.has_bytes(i)) document.buffer(i);
    for (uint32_t i = 0; i < document.list("bufferViews").size(); ++i)
        if (document.has_bytes(document.list("bufferViews")[i].at("buffer").index(buffers, "buffers")))
            document.view(i);
    for (uint32_t i = 0; i < document.list("meshes").size(); ++i)
        if (const auto read = reader.meshes.lower_bound({i, 0, {}});
            read == reader.meshes.end() || std::get<0>(read->first) != i)
            check_mesh(reader, i);
}

void note_extensions(GltfReader& reader) {
    for (const JsonValue& extension : reader.document.root().elements_of("extensionsUsed"))
        if (!is_supported_extension(extension.text()))
            reader.notes.add("extension " + extension.text() + " is not read");
}

}  // namespace

std::vector<std::string> Notes::lines() const {
    std::vector<std::string> lines;
    for (const std::string& text : order_) {
        const uint64_t times = times_.at(text);
        lines.push_back(one_line(text + (times > 1 ? " (" + std::to_string(times) + " times)" : "")));
    }
    return lines;
}

void read_all(GltfReader& reader) {
    note_extensions(reader);
    read_materials(reader);
    read_lights(reader);
    read_distributions(reader);
    read_photometry_block(reader);
    read_nodes(reader);
    read_fixtures(reader);
    read_animations(reader);
    check_transforms(reader.scene, reader.document.name());
    check_unused(reader);
}

bool begins_like_gltf(std::span<const uint8_t> start) {
    const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
    const size_t first = text.find_first_not_of(" \t\r\n");
    return text.starts_with("glTF") || (first != text.npos && text[first] == '{');
}

LoadedScene read_gltf(const std::filesystem::path& file, const SceneLimits& limits) {
    const Budget budget("reading " + one_line(file.string()));
    try {
        GltfDocument document(file, limits);
        GltfReader reader{.document = document, .limits = limits};
        read_all(reader);
        return {std::move(reader.scene), reader.notes.lines(), reader.photometric, std::move(reader.source)};
    } catch (const std::bad_alloc&) {
        throw OutOfHostMemory(one_line(file.string()) + ": not enough memory");
    }
}

}  // namespace vesper::scene
