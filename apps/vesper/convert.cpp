#include "scene/convert.h"

#include <cstdio>
#include <map>
#include <memory>

#include "arguments/command_line.h"
#include "base/budget.h"

#include "base/error.h"
#include "base/one_line.h"
#include "commands.h"
#include "io/file_gate.h"
#include "print.h"
#include "roads/convert_roads.h"

namespace vesper::commands {
namespace {

const std::map<std::string, roads::LampSide> kSides{{"auto", roads::LampSide::Auto},
                                                    {"right", roads::LampSide::Right},
                                                    {"left", roads::LampSide::Left},
                                                    {"both", roads::LampSide::Both},
                                                    {"alternating", roads::LampSide::Alternating}};

const std::map<std::string, roads::SignalState> kSignals{{"plan", roads::SignalState::Plan},
                                                         {"red", roads::SignalState::Red},
                                                         {"amber", roads::SignalState::Amber},
                                                         {"green", roads::SignalState::Green},
                                                         {"off", roads::SignalState::Off}};

struct ConvertArguments {
    std::string input, photometry, output;
    bool srgb = false;
    roads::StreetLampOptions lamps;
    std::string side = "auto", luminaire, signals = "plan";
    double signal_time = 0;
    std::vector<apps::Option> for_databases, for_lamps;
};

void report(const std::vector<std::string>& changes, const std::vector<std::string>& warnings,
            const std::string& output) {
    apps::print_notes(changes, "");
    apps::print_notes(warnings, "warning: ");
    apps::print("wrote %s\n", output.c_str());
}

void refuse(const std::vector<apps::Option>& options, const std::string& why) {
    for (const apps::Option& option : options)
        if (option.count() > 0) throw Error(option.name() + why);
}

void run_roads(const ConvertArguments& arguments) {
    refuse(arguments.for_databases, " has no meaning for an OpenDRIVE file: it has no materials and no nodes");
    const std::filesystem::path input = arguments.input;
    const std::string output = arguments.output.empty() ? input.stem().string() + ".gltf" : arguments.output;
    io::announce_read(input);
    io::announce_write("-o", output);
    roads::ConvertOptions options{.lamps = arguments.lamps, .luminaire = arguments.luminaire};
    options.lamps.side = kSides.at(arguments.side);
    options.signals = kSignals.at(arguments.signals), options.signal_time = arguments.signal_time;
    const roads::RoadConversion made = roads::convert_roads(input, output, options);
    report(made.parts, made.notes, output);
}

void run(const ConvertArguments& arguments) {
    if (roads::is_opendrive_name(arguments.input)) return run_roads(arguments);
    refuse(arguments.for_lamps, " has a meaning only for an OpenDRIVE file (.xodr)");
    if (arguments.photometry.empty()) throw Error("--photometry is required for a glTF database");
    if (arguments.output.empty()) throw Error("--output is required for a glTF database");
    io::announce_read(arguments.input);
    io::announce_read(arguments.photometry);
    io::announce_write("-o", arguments.output);
    std::optional<scene::Transfer> transfer;
    if (arguments.srgb) transfer = scene::Transfer{scene::Transfer::Kind::Srgb};
    const scene::PhotometryReport made =
        scene::convert(arguments.input, arguments.photometry, arguments.output, transfer);
    report(made.changes, made.warnings, arguments.output);
}

}  // namespace

void add_convert(apps::Command program) {
    apps::Command command = program.add_command(
        "convert", "Make a daytime glTF database photometric, or a night street of an OpenDRIVE file");
    const auto a = std::make_shared<ConvertArguments>();
    command.add_option("input", a->input, "The database: .gltf or .glb; or roads: .xodr (docs/roads.md)").required();
    a->for_databases = {
        command.add_option("--photometry,-p", a->photometry,
                           "Which nodes are lamps, which materials shine (docs/photometry.md); required for databases"),
        command.add_flag("--srgb", a->srgb,
                         "Decode textures as sRGB instead of with the gamma of the photometry file")};
    command.add_option("--output,-o", a->output,
                       "One self-contained .gltf or .glb (default for roads: the input's name with .gltf)");
    a->for_lamps = {
        command
            .add_option("--lamp-spacing", a->lamps.spacing,
                        "Roads: m between street lamps, 0 for none (default: 30, or those of the file)")
            .check(apps::range(0.0, 1000.0)),
        command
            .add_option("--lamp-height", a->lamps.height,
                        "Roads: m, of the light points (default: 8, up to 12 on wide roads)")
            .check(apps::range(2.0, 60.0)),
        command.add_option("--lamp-side", a->side, "Roads: on which side of the way").check(apps::one_of_keys(kSides)),
        command.add_option("--lamp-overhang", a->lamps.overhang, "Roads: m from the pole towards the road")
            .check(apps::range(0.1, 20.0)),
        command.add_option("--luminaire", a->luminaire, "Roads: another luminaire: .ies or .ldt"),
        command
            .add_option("--signals", a->signals,
                        "Roads: the lit lens of traffic lights; plan: ways that cross are not green together")
            .check(apps::one_of_keys(kSignals)),
        command.add_option("--signal-time", a->signal_time, "Roads: s of that plan that is shown")
            .check(apps::range(0.0, 1e6))};
    command.add_allow_outside();
    command.footer(
        "Examples:\n  vesper convert data/rivoli/rivoli.gltf --photometry data/rivoli/rivoli.photometry.json -o "
        "out/night.gltf\n"
        "  vesper convert data/rivoli/rivoli.xodr --lamp-spacing 25 --lamp-side both -o out/lanes.gltf\n");
    command.callback([a] { run(*a); });
}

}  // namespace vesper::commands
