#include "scene/convert.h"

#include <new>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/new_file.h"
#include "scene/gltf_patch.h"
#include "scene/gltf_save.h"
#include "scene/gltf_write.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

PhotometryReport convert_checked(const std::filesystem::path& input, const std::filesystem::path& photometry,
                                 const std::filesystem::path& output, const std::optional<Transfer>& transfer,
                                 const SceneLimits& limits) {
    const io::FileGate gate;
    const Budget budget("converting " + one_line(input.string()));
    if (!is_gltf_name(output)) throw Error(one_line(output.string()) + ": the output must be named .gltf or .glb");
    Photometry rules = read_photometry_for(input, photometry);
    if (transfer) rules.transfer = *transfer;

    GltfDocument document(input, limits);
    if (const auto extras = document.root().find("extras"); extras && extras->json().is_object()) {
        if (const auto block = extras->find("vesper"))
            block->fail("the file has been converted already: convert the original");
    }
    GltfReader original{.document = document, .limits = limits};
    read_all(original);
    const SceneBefore before(original);
    PhotometryReport report = apply_photometry(original.scene, rules, document.name(), original.source);

    json block = patch_gltf(document, original, before, rules, report);
    block["provenance"] = {{"input", input.filename().string()},
                           {"photometry", photometry.filename().string()},
                           {"vesper", VESPER_VERSION}};
    json& root = document.edit();
    // Extras of a file may be of any kind; those of a photometric one are an object.
    if (const auto extras = root.find("extras"); extras != root.end() && !extras->is_object()) {
        *extras = {{"extras", std::move(*extras)}};
        report.changes.emplace_back("extras of the file, which are no object, became extras/extras");
    }
    object_member(document, root, "extras")["vesper"] = std::move(block);

    // What will be written is read first: it must load, with nothing else beside it.
    original.scene = {};  // two large scenes at once would be one too many
    GltfReader result{.document = document, .limits = limits};
    read_all(result);
    for (const std::string& note : result.notes.lines()) report.warnings.push_back(note);
    io::replace_file(output, encode_gltf(document, output.extension() == ".glb", report.warnings));
    return report;
}

}  // namespace

PhotometryReport convert(const std::filesystem::path& input, const std::filesystem::path& photometry,
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
