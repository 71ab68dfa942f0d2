// `vesper inspect`: looking at what a file says of light. SPDX-License-Identifier: MIT
#include "inspect.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "arguments/command_line.h"

#include "arguments/arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/thread_arguments.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "commands.h"
#include "io/file_gate.h"
#include "io/read_file.h"
#include "photometry/grid.h"
#include "photometry/reflection_table.h"
#include "print.h"
#include "roads/convert_roads.h"
#include "scene/read_scene.h"

namespace vesper::commands {
namespace {

enum class Kind : uint8_t { Scene, Roads, Distribution, Table, Picture };

/// A grid may be damaged: its reader will say.
bool is_grid(const std::string& file) {
    const std::vector<uint8_t> start = io::read_start(file, 1u << 20);  // the header is in it
    return photometry::is_grid_exr(start);
}

Kind kind_of(const std::string& file) {
    const std::string extension = lower(std::filesystem::path(file).extension().string());
    if (scene::is_scene_name(file)) return Kind::Scene;
    if (roads::is_opendrive_name(file)) return Kind::Roads;
    if (extension == ".ies" || extension == ".ldt") return Kind::Distribution;
    if (extension == ".rtb") return Kind::Table;
    if (extension == ".csv")
        return photometry::is_reflection_table(io::read_file(file, 64u << 20)) ? Kind::Table : Kind::Distribution;
    if (extension == ".hdr" || extension == ".pic" || extension == ".rgbe") return Kind::Picture;
    if (extension == ".exr") return is_grid(file) ? Kind::Distribution : Kind::Picture;
    throw Error(file + ": expected a scene (" + scene::scene_endings(", ") +
                "), roads (.xodr), a lamp (.ies, .ldt, .csv, .exr), an r-table (.csv, .rtb) or a picture "
                "(.exr, .hdr)");
}

/// The report of a scene that is asked for.
Inspection inspect_scene_by(const InspectArguments& a) {
    if (a.balance) return inspect_balance(a);
    if (!a.points.empty()) return inspect_light(a);
    if (!a.light.empty()) return inspect_light_picture(a);
    if (!a.photometry_template.empty()) return inspect_template(a);
    return a.lamp.empty() ? inspect_scene(a) : inspect_shadow_map(a);
}

void run(const InspectArguments& a) {
    std::optional<Budget> budget;
    if (!a.balance && a.light.empty()) budget.emplace("inspecting " + one_line(a.file));  // these take their time
    io::announce_read(a.file);
    io::announce_write("--json", a.json);
    if (!a.picture.empty() && !a.picture.ends_with(".png"))
        throw Error("-o " + a.picture + ": a .png file is expected");
    io::announce_write("-o", a.picture);
    if (!a.light.empty()) announce_light_picture(a);
    announce_template(a);
    const Kind kind = kind_of(a.file);
    const auto only = [&](bool given, Kind wanted, const char* what) {
        if (given && kind != wanted) throw Error(what);
    };
    only(!a.probes.empty(), Kind::Picture, "--probe is for pictures (.exr, .hdr)");
    only((a.low > 0 || a.high > 0) && a.light.empty(), Kind::Picture,
         "--low and --high are for pictures (.exr, .hdr) and --light");
    only(a.contours, Kind::Picture, "--contours is for pictures (.exr, .hdr)");
    only(!a.lamp.empty(), Kind::Scene, "--lamp is for scenes (.gltf, .glb)");
    only(!a.points.empty(), Kind::Scene, "--at is for scenes (.gltf, .glb)");
    only(!a.light.empty(), Kind::Scene, "--light is for scenes (.gltf, .glb)");
    only(a.balance, Kind::Scene, "--balance is for scenes (.gltf, .glb)");
    only(!a.photometry_template.empty(), Kind::Scene, "--photometry-template is for scenes (.gltf, .glb)");
    if (int(!a.lamp.empty()) + int(!a.points.empty()) + int(!a.light.empty()) + int(a.balance) +
            int(!a.photometry_template.empty()) >
        1)
        throw Error(
            "--at, --light, --lamp, --balance and --photometry-template are reports of their own: ask for one of them");
    if (a.points.empty() && !a.normal.empty()) throw Error("--normal has a meaning only beside --at");
    if (a.points.empty() && a.light.empty() && a.paths > 0)
        throw Error("--paths has a meaning only beside --at and --light");
    if (a.light.empty() && (!a.camera.empty() || !a.size.empty()))
        throw Error("--camera and --size have a meaning only beside --light");
    if (a.lamp.empty() && a.lamp_number > 1) throw Error("--lamp-number has a meaning only beside --lamp");
    if (a.lamp.empty() && a.light.empty() && !a.device.empty())
        throw Error("--device has a meaning only beside --lamp and --light");
    if (!a.picture.empty() && ((kind == Kind::Scene && a.lamp.empty()) || kind == Kind::Roads || kind == Kind::Table))
        throw Error("-o " + a.picture + ": there is a picture of lamps and of pictures only (of a scene: with --lamp)");
    Inspection found;
    switch (kind) {
        case Kind::Scene:
            found = inspect_scene_by(a);
            break;
        case Kind::Roads:
            found = inspect_roads(a);
            break;
        case Kind::Distribution:
            found = inspect_distribution(a);
            break;
        case Kind::Table:
            found = inspect_table(a);
            break;
        case Kind::Picture:
            found = inspect_picture(a);
            break;
    }
    apps::print_report(found.text);
    if (!a.json.empty())
        apps::write_text(a.json,
                         found.json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace

std::string notes_text(const std::vector<std::string>& notes) {
    std::string text = notes.empty() ? "" : "\nread with a change:\n";
    for (const std::string& note : notes) text += "  " + note + "\n";
    return text;
}

void add_inspect(apps::Command program) {
    apps::Command command =
        program.add_command("inspect", "Say what a scene, roads, a lamp or a picture hold (docs/inspect.md)");
    const auto a = std::make_shared<InspectArguments>();
    command
        .add_option("file", a->file,
                    "A scene (.gltf, .glb), roads (.xodr), lamp (.ies, .ldt, .csv, .exr), r-table (.csv, .rtb) or "
                    "picture (.exr, .hdr)")
        .required();
    command.add_option("--json", a->json, "Write the report to a JSON file");
    command.add_option("--output,-o", a->picture,
                       "OUT.png: diagrams of a lamp, false colours of a picture, distances from --lamp");
    command.add_option("--lamp", a->lamp, "Scenes: how far the lamp of this name, or at this node, sees; a pattern");
    command.add_option("--lamp-number", a->lamp_number, "Scenes: which of the lamps of that name, from 1")
        .check(apps::between(1, 1e6));
    command.add_option("--at", a->points,
                       "Scenes: X,Y,Z, m: the light on a surface there, by its origin; may be repeated");
    command.add_option("--normal", a->normal, "With --at: X,Y,Z, where the surface faces (default: 0,1,0, up)");
    command.add_option("--light", a->light,
                       "Scenes: light on the surfaces that --camera sees, by its origin, lx: PREFIX.exr, with a layer "
                       "for each, and PREFIX-lamps.png and so on in false colours; takes some minutes");
    command.add_option("--camera,-c", a->camera, "With --light: name of a camera of the scene (default: the first)");
    command.add_option("--size,-s", a->size, "With --light: WIDTHxHEIGHT, px (default: 640x400)");
    command
        .add_option("--paths", a->paths,
                    "With --at: of rays to a point (default: 16384); with --light: of each pixel (32); the error falls "
                    "with the root")
        .check(apps::between(16, 1e8));
    command.add_flag("--balance", a->balance,
                     "Scenes: luminous flux that lamps and surfaces emit, and where it goes; takes a minute or so");
    command.add_option("--photometry-template", a->photometry_template,
                       "Scenes: OUT.json, a new photometry file with a rule for all that looks like a source of light "
                       "(docs/photometry-template.md)");
    command.add_option("--device", a->device,
                       "With --lamp and --light: part of a name, cpu, or an index of vesper devices");
    apps::add_thread_option(command, a->threads);
    command.add_option("--probe", a->probes, "Pictures: X,Y from the top left, px; may be repeated");
    command.add_option("--layer", a->layer, apps::kLayerHelp);
    command.add_option("--low", a->low, "Pictures: lower end of the colour scale, cd/m^2; with --light, lx")
        .check(apps::between(1e-30, 1e30));
    command.add_option("--high", a->high, "Pictures: upper end of the colour scale, cd/m^2; with --light, lx")
        .check(apps::between(1e-30, 1e30));
    command.add_flag("--contours", a->contours,
                     "Pictures: lines at the luminances of the classes M6 to M1 of EN 13201-2");
    command.add_allow_outside();
    command.footer(
        "Examples:\n  vesper inspect night.gltf\n  vesper inspect data/road/luminaire.ldt -o luminaire.png\n"
        "  vesper inspect night.gltf --lamp \"street lamp\" -o map.png\n"
        "  vesper inspect night.gltf --at 8.5,0.15,-60 --at 10,3,-60 --normal -1,0,0\n"
        "  vesper inspect night.gltf --light light --camera driver --paths 256\n"
        "  vesper inspect night.gltf --balance\n"
        "  vesper inspect street.gltf --photometry-template street.photometry.json\n"
        "  vesper inspect night.exr --probe 840,700 -o luminance.png\n");
    command.callback([a] {
        apps::use_threads(a->threads);
        run(*a);
    });
}

}  // namespace vesper::commands
