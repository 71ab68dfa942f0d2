// Reading a scene from glTF: the table of contents. SPDX-License-Identifier: MIT
#include "scene/gltf.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "base/decimal.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "scene/gltf_reader.h"

namespace vesper {
namespace {

/// Finite numbers may still multiply to infinity along a branch of the tree.
void check_world(const GltfReader& reader) {
    const std::vector<glm::mat4> world = world_transforms(reader.scene, 0);
    for (size_t i = 0; i < world.size(); ++i)
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                if (!std::isfinite(world[i][c][r]))
                    throw Error(reader.document.name() + ": node '" + one_line(reader.scene.nodes[i].name) +
                                "': its transform and those above it multiply to a number that is not finite");
}

/// Places are of single precision once nodes have been multiplied out: far from the origin what stands beside a lamp, or the eye, is not where it should be.
void note_distance(GltfReader& reader) {
    constexpr double kFar = 8192;  // m: beyond, floats are a millimetre apart
    const std::vector<glm::mat4> world = world_transforms(reader.scene, 0);
    double farthest = 0;
    for (size_t i = 0; i < world.size(); ++i)
        if (reader.scene.nodes[i].light != kNone || reader.scene.nodes[i].camera != kNone) farthest = std::max(farthest, glm::length(glm::dvec3(world[i][3])));
    if (farthest <= kFar) return;
    const double apart = 1000 * std::ldexp(1.0, std::ilogb(farthest) - 23);
    reader.notes.add("lamps or cameras are " + decimal(farthest / 1000) + " km from the origin, where places are exact to " + decimal(apart, 2) +
                     " mm only: a node above all others with a translation that brings them back loses nothing");
}

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
        if (const auto read = reader.meshes.lower_bound({i, 0, {}}); read == reader.meshes.end() || std::get<0>(read->first) != i)
            check_mesh(reader, document.list("meshes")[i]);
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
    read_animations(reader);
    check_world(reader);
    note_distance(reader);
    check_unused(reader);
    note_broken_rules(reader);
}

LoadedScene read_gltf(const std::filesystem::path& file, const SceneLimits& limits) {
    try {
        GltfDocument document(file, limits);
        GltfReader reader{.document = document, .limits = limits};
        read_all(reader);
        return {std::move(reader.scene), reader.notes.lines(), reader.photometric};
    } catch (const std::bad_alloc&) {
        throw OutOfHostMemory(one_line(file.string()) + ": not enough memory");
    }
}

}  // namespace vesper
