// `vesper display`: test patterns, and a profile from what was measured on them. SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "arguments/command_line.h"

#include "analysis/display_fit.h"
#include "arguments/arguments.h"
#include "arguments/picture_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "commands.h"
#include "io/file_gate.h"
#include "print.h"
#include "scene/display_file.h"
#include "test_patterns.h"

namespace vesper::commands {
namespace {

struct PatternArguments {
    std::string folder, size = "1920x1080";
    PatternSettings settings;
};

struct FitArguments {
    std::string measurements, output, name, kind = "auto", primaries = "rec709";
    uint32_t bits = 8;
    float ambient = 0, reflection = 0.01f;
};

const std::map<std::string, vision::Eotf> kKinds(vision::kEotfNames.begin(), vision::kEotfNames.end());
const std::map<std::string, io::Primaries> kPrimaries(io::kPrimariesNames.begin(), io::kPrimariesNames.end());

const char* name_of(vision::Eotf eotf) {
    for (const auto& [name, value] : vision::kEotfNames)
        if (value == eotf) return name;
    return "";
}

/// In the order of the table.
template <class Table>
std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const auto& [name, value] : table) names.emplace_back(name);
    return names;
}

void run_patterns(PatternArguments& a) {
    const VkExtent2D size = apps::parse_size(a.size, 64, 8192);
    a.settings.width = size.width, a.settings.height = size.height;
    if (!std::filesystem::is_directory(a.folder)) throw Error("-o " + one_line(a.folder) + ": there is no such folder");
    const auto names = write_test_patterns(a.folder, a.settings);
    apps::print("wrote %zu test patterns and %s\n", names.size() - 1, names.back().c_str());
}

void run_fit(const FitArguments& a) {
    if (!a.output.ends_with(".json")) throw Error("-o " + one_line(a.output) + ": a .json file is expected");
    io::announce_read(a.measurements);
    io::announce_write("-o", a.output);
    const auto measured = analysis::read_display_measurements(a.measurements, a.bits);
    analysis::DisplayFit fit;
    try {
        fit = a.kind == "auto" ? analysis::fit_display(measured, a.bits)
                               : analysis::fit_display(measured, a.bits, kKinds.at(a.kind));
        fit.display.ambient = a.ambient, fit.display.reflection = a.reflection;
        fit.display.primaries = kPrimaries.at(a.primaries);
        vision::check_display(fit.display);
    } catch (const Error& error) {
        throw Error(one_line(a.measurements) + ": " + error.what());
    }
    const vision::Display& d = fit.display;
    apps::print("%s: %s, %.5g to %.5g cd/m^2 (%.4g : 1)", a.measurements.c_str(), name_of(d.eotf), double(d.black),
                double(d.peak), double(d.peak) / double(d.black));
    if (d.eotf == vision::Eotf::Gamma) apps::print(", gamma %.4f", double(d.gamma));
    apps::print(
        "\nresiduals: root mean square %.2f %%, largest %.2f %%\n  line   code    measured     profile  residual\n",
        100 * fit.rms, 100 * fit.largest);
    const vision::DisplayCurve curve(d);
    std::string rows;
    for (size_t i = 0; i < measured.size(); ++i)
        rows +=
            apps::format("%6zu %6u %11.5g %11.5g %8.2f%%\n", measured[i].line, measured[i].code, measured[i].luminance,
                         curve.emitted(double(measured[i].code) / d.largest_code()), 100 * fit.residuals[i]);
    apps::print_report(rows);
    if (d.eotf == vision::Eotf::Table && fit.largest > 0.03)
        apps::print_note(
            one_line(a.measurements) +
            ": luminances of one code, or of codes where they do not rise, differ by so much that no display is "
            "within 3 % of all");
    apps::write_text(a.output, scene::display_json(d, a.name));
    apps::print("wrote %s\n", a.output.c_str());
}

void run_list() {
    for (const vision::NamedDisplay& known : vision::known_displays())
        apps::print("%-10s %s\n", known.name, known.description);
}

}  // namespace

void add_display(apps::Command program) {
    apps::Command command =
        program.add_command("display", "Test patterns, and a display's profile from measurements (docs/display.md)");
    command.requires_command();
    command.footer(
        "Example:\n  vesper display patterns -o patterns/ --size 1920x1080    # show each patch, measure it, fill in "
        "measurements.csv\n"
        "  vesper display fit patterns/measurements.csv -o wall.json\n"
        "  vesper render night.gltf --display wall.json -o night.png\n");

    const auto p = std::make_shared<PatternArguments>();
    apps::Command patterns =
        command.add_command("patterns", "Write ramps, black and near-black steps, and patches to measure");
    patterns.add_option("--output,-o", p->folder, "A folder that exists").required();
    patterns.add_option("--size,-s", p->size, "WIDTHxHEIGHT of the display, px").shows_default();
    patterns.add_option("--bits", p->settings.bits, "Of a channel's code; 10 are written as PNG of 16 bits")
        .check(apps::one_of({8, 10}))
        .shows_default();
    patterns.add_option("--patches", p->settings.patches, "How many codes to measure, besides some near black")
        .check(apps::range(3u, 256u))
        .shows_default();
    patterns.add_option("--window", p->settings.window, "Side of the patch as part of the picture's; 1: all of it")
        .check(apps::between(0.01, 1.0))
        .shows_default();
    patterns.footer("Example:\n  vesper display patterns -o patterns/ --size 1920x1080 --bits 8\n");
    patterns.callback([p] { run_patterns(*p); });

    const auto f = std::make_shared<FitArguments>();
    std::vector<std::string> kinds = names_of(vision::kEotfNames);
    kinds.insert(kinds.begin(), "auto");
    apps::Command fit = command.add_command("fit", "Make a profile from measured luminances");
    fit.add_option("measurements", f->measurements, "Lines of code,cd/m^2, measured in the dark").required();
    fit.add_option("--output,-o", f->output, "PROFILE.json").required();
    fit.add_option("--kind", f->kind, "Transfer function; auto: the simplest within 1 %, or the table")
        .check(apps::one_of(kinds))
        .shows_default();
    fit.add_option("--bits", f->bits, "Of a channel's code").check(apps::one_of({8, 10})).shows_default();
    fit.add_option("--primaries", f->primaries, "Of the display; others can be written into the profile")
        .check(apps::one_of(names_of(io::kPrimariesNames)))
        .shows_default();
    fit.add_option("--ambient", f->ambient, "Illuminance on the screen when in use, lx")
        .check(apps::between(0.0, 1e5))
        .shows_default();
    fit.add_option("--reflection", f->reflection, "Diffuse reflectance of the screen")
        .check(apps::between(0.0, 1.0))
        .shows_default();
    fit.add_option("--name", f->name, "What the profile calls the display");
    fit.footer("Example:\n  vesper display fit measurements.csv --name 'wall of cave 2' --ambient 0 -o wall.json\n");
    fit.callback([f] { run_fit(*f); });

    command.add_command("list", "The displays that are known by name").callback(run_list);
}

}  // namespace vesper::commands
