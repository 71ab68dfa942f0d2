// From a daytime database to a photometric one: the table of contents. SPDX-License-Identifier: MIT
#include "scene/convert.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/named_file.h"
#include "io/new_file.h"
#include "scene/convert_rules.h"
#include "scene/gltf_save.h"
#include "scene/gltf_write.h"
#include "scene/photometry_parts.h"
#include "scene/uri.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

json colour_of(glm::dvec3 colour) { return {colour.r, colour.g, colour.b}; }

json quantity_of(const char* name, const ColouredQuantity& quantity) {
    return {{name, quantity.value}, {"colour", colour_of(quantity.colour)}};
}

/// The extras block, docs/gltf.md.
json block_of(const Conversion& conversion, const std::filesystem::path& input,
              const std::filesystem::path& photometry) {
    const Photometry& p = conversion.photometry;
    json block = {{"version", 1}};
    block["transfer"] = {{"kind", p.transfer.kind == Transfer::Kind::Gamma ? "gamma" : "srgb"}};
    // 2.2f as a double has a long tail.
    if (p.transfer.kind == Transfer::Kind::Gamma)
        block["transfer"]["gamma"] = std::round(double(p.transfer.gamma) * 1e4) / 1e4;
    if (p.ambient) block["ambient"] = quantity_of("illuminance_lx", *p.ambient);
    if (p.sky) block["sky"] = quantity_of("luminance_cd_m2", *p.sky);
    if (!conversion.environment.is_null()) block["environment"] = conversion.environment;
    if (!conversion.lobes.empty()) block["lobes"] = conversion.lobes;
    if (!conversion.openings.empty()) block["openings"] = conversion.openings;
    if (!conversion.fixtures.empty()) block["fixtures"] = conversion.fixtures;
    if (!conversion.roads.empty()) {
        block["reflection_tables"] = conversion.reflection_tables;
        block["roads"] = conversion.roads;
    }
    if (!conversion.retroreflective.empty()) {
        block["retroreflectors"] = conversion.retroreflectors;
        block["retroreflective"] = conversion.retroreflective;
    }
    if (!conversion.luminous.empty()) {
        block["luminance_pictures"] = conversion.luminance_pictures;
        block["luminous"] = conversion.luminous;
    }
    block["provenance"] = {{"input", input.filename().string()},
                           {"photometry", photometry.filename().string()},
                           {"vesper", VESPER_VERSION}};
    return block;
}

void describe_rest(Conversion& conversion) {
    const Photometry& p = conversion.photometry;
    auto& changes = conversion.report.changes;
    const bool gamma = p.transfer.kind == Transfer::Kind::Gamma;
    changes.push_back("textures: " + std::to_string(conversion.document.list("images").size()) +
                      " pictures kept as they are, read as reflectance by " +
                      (gamma ? "code^" + decimal(p.transfer.gamma) : "the sRGB curve"));
    if (p.ambient)
        changes.push_back("ambient: " + decimal(p.ambient->value) + " lx, in pictures without indirect light");
    if (p.sky) changes.push_back("sky: " + decimal(p.sky->value) + " cd/m^2");
}

}  // namespace

nlohmann::json& object_member(const GltfDocument& document, nlohmann::json& holder, const std::string& key) {
    json& member = holder[key];
    if (member.is_null()) member = json::object();
    if (!member.is_object()) throw Error(document.name() + ": \"" + key + "\" must be an object");
    return member;
}

void use_extension(nlohmann::json& root, const std::string& name) {
    json& used = root["extensionsUsed"];
    if (std::find(used.begin(), used.end(), json(name)) == used.end()) used.push_back(name);
}

size_t add_buffer_view(nlohmann::json& root, std::span<const uint8_t> bytes) {
    root["bufferViews"].push_back(
        {{"buffer", root.contains("buffers") ? root["buffers"].size() : 0}, {"byteLength", bytes.size()}});
    root["buffers"].push_back(
        {{"byteLength", bytes.size()}, {"uri", encode_data_uri("application/octet-stream", bytes)}});
    return root["bufferViews"].size() - 1;
}

std::string in_quotes(const std::string& name) { return "'" + one_line(name) + "'"; }

namespace {

/// A scene has so many lamps at most, and it is the photometry file that asks for more.
void check_count(const Conversion& conversion, const std::filesystem::path& photometry) {
    size_t placed = conversion.photometry.directional.size();
    for (const auto& nodes : conversion.lamp_nodes)
        placed += static_cast<size_t>(std::count_if(
            nodes.begin(), nodes.end(), [&](uint32_t node) { return conversion.original.node_of[node] != kNone; }));
    const size_t most = conversion.original.limits.lamps;
    if (placed > most)
        throw Error(one_line(photometry.string()) + ": /lamps: " + std::to_string(placed) +
                    " lamps, more than the limit of " + std::to_string(most));
}

ConversionReport convert_checked(const std::filesystem::path& input, const std::filesystem::path& photometry,
                                 const std::filesystem::path& output, const std::optional<Transfer>& transfer,
                                 const SceneLimits& limits) {
    const io::FileGate gate;
    const Budget budget("converting " + one_line(input.string()));
    if (!is_gltf_name(output)) throw Error(one_line(output.string()) + ": the output must be named .gltf or .glb");
    std::optional<io::AllowedFolder> beside_scene(std::in_place, input.has_parent_path() ? input.parent_path() : ".");
    Photometry stated = read_photometry(photometry);
    beside_scene.reset();  // the scene may not name what lies beside the photometry
    if (transfer) stated.transfer = *transfer;
    const Photometry rules = with_night_sky(stated);

    GltfDocument document(input, limits);
    if (const auto extras = document.root().find("extras"); extras && extras->json().is_object()) {
        if (const auto block = extras->find("vesper"))
            block->fail("the file has been converted already: convert the original");
    }
    GltfReader original{.document = document, .limits = limits};
    read_all(original);

    ConversionReport report;
    Conversion conversion{document, original, rules, report};
    convert_lamps(conversion);
    check_count(conversion, photometry);
    convert_materials(conversion);
    convert_sky(conversion);
    describe_rest(conversion);
    if (rules.ambient.has_value() != stated.ambient.has_value() || rules.sky.has_value() != stated.sky.has_value())
        report.changes.push_back("ambient and sky: what is not stated is that of a clear night over a city");
    json& root = document.edit();
    // Extras of a file may be of any kind; those of a photometric one are an object.
    if (const auto extras = root.find("extras"); extras != root.end() && !extras->is_object()) {
        *extras = {{"extras", std::move(*extras)}};
        report.changes.emplace_back("extras of the file, which are no object, became extras/extras");
    }
    object_member(document, root, "extras")["vesper"] = block_of(conversion, input, photometry);

    // What will be written is read first: it must load, and be plausible, with nothing else beside it.
    original.scene = {};  // two large scenes at once would be one too many
    GltfReader result{.document = document, .limits = limits};
    read_all(result);
    check_reflectances(result.scene, report);
    for (const std::string& note : result.notes.lines()) report.warnings.push_back(note);
    io::replace_file(output, encode_gltf(document, output.extension() == ".glb", report.warnings));
    return report;
}

}  // namespace

ConversionReport convert(const std::filesystem::path& input, const std::filesystem::path& photometry,
                         const std::filesystem::path& output, const std::optional<Transfer>& transfer,
                         const SceneLimits& limits) {
    try {
        return convert_checked(input, photometry, output, transfer, limits);
    } catch (const json::exception& error) {  // parts of the file that reading it did not look at
        throw Error(one_line(input.string() + ": " + error.what()));
    } catch (const std::bad_alloc&) {
        throw OutOfHostMemory(one_line(input.string()) + ": not enough memory");
    }
}

}  // namespace vesper::scene
