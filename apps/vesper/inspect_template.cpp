// A photometry file that is ready to fill in, of a scene. SPDX-License-Identifier: MIT
#include <filesystem>

#include "arguments/arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "inspect.h"
#include "io/file_gate.h"
#include "print.h"
#include "scene/photometry_template.h"
#include "scene/read_scene.h"

namespace vesper::commands {
namespace {

std::string rows_of(const scene::PhotometryTemplate& made) {
    std::string text;
    for (size_t i = 0; i < scene::kSourceReasons; ++i)
        text += apps::format("  by %-18s rules: %zu, nodes or materials: %zu\n",
                             scene::name_of(static_cast<scene::SourceReason>(i)), made.rules[i], made.sources[i]);
    if (made.suns > 0) text += apps::format("  directional lights (sun or sky) without a rule: %zu\n", made.suns);
    if (made.nameless > 0)
        text += apps::format("  sources without a name, which no rule can match: %zu\n", made.nameless);
    if (made.dark > 0) text += apps::format("  lights that are black or of 0 cd, without a rule: %zu\n", made.dark);
    if (made.parts > 0) text += apps::format("  parts of lamps, which have the rule of their lamp: %zu\n", made.parts);
    if (made.left_out_sources > 0)
        text += apps::format("  left out, as rules or lamps are too many: %zu rules, %zu nodes or materials\n",
                             made.left_out_rules, made.left_out_sources);
    return text;
}

}  // namespace

void announce_template(const InspectArguments& arguments) {
    const std::string& file = arguments.photometry_template;
    io::announce_write("--photometry-template", file);
    std::error_code failed;
    if (!file.empty() && std::filesystem::is_regular_file(file, failed))
        throw Error("--photometry-template " + one_line(file) + ": is there already, and a template replaces no file");
}

Inspection inspect_template(const InspectArguments& arguments) {
    const scene::LoadedScene loaded = scene::read_scene(arguments.file);
    if (loaded.photometric)
        throw Error(one_line(arguments.file) + ": has its photometry already: a template is for the original");
    const scene::PhotometryTemplate made = scene::make_photometry_template(loaded.scene, arguments.file, loaded.source);
    apps::write_text(arguments.photometry_template, made.text);
    Inspection report;
    report.text = apps::format("%s: rules for lamps: %zu, for emitters: %zu\n", one_line(arguments.file).c_str(),
                               made.lamps, made.emitters) +
                  rows_of(made) + notes_text(loaded.notes) + "wrote " + one_line(arguments.photometry_template) + "\n";
    report.json = {{"kind", "photometry template"}, {"lamp_rules", made.lamps}, {"emitter_rules", made.emitters}};
    for (size_t i = 0; i < scene::kSourceReasons; ++i)
        report.json["reasons"].push_back({{"reason", scene::name_of(static_cast<scene::SourceReason>(i))},
                                          {"rules", made.rules[i]},
                                          {"sources", made.sources[i]}});
    report.json["directional_lights"] = made.suns;
    report.json["nameless"] = made.nameless;
    report.json["dark_lights"] = made.dark;
    report.json["parts_of_lamps"] = made.parts;
    report.json["left_out"] = {{"rules", made.left_out_rules}, {"sources", made.left_out_sources}};
    report.json["notes"] = loaded.notes;
    return report;
}

}  // namespace vesper::commands
