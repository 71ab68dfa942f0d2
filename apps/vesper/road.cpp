#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "arguments/command_line.h"

#include "arguments/arguments.h"
#include "arguments/thread_arguments.h"
#include "base/error.h"
#include "commands.h"
#include "io/file_gate.h"
#include "io/in_file.h"
#include "print.h"
#include "road_render.h"
#include "road_report.h"
#include "road_targets.h"
#include "roads/layout_file.h"
#include "roads/layout_scene.h"
#include "scene/gltf_save.h"

namespace vesper::commands {
namespace {

struct RoadArguments {
    std::string layout, csv, json, wanted, device, scene, occlusion, target_map;
    unsigned threads = 0;
    std::vector<std::string> pictures;
    roads::LayoutOverrides overrides;
    bool grid = false, stv = false;
    std::optional<double> reflectance;  ///< of small targets
};

/// The road as a scene whose luminaires are seen, too, where their file states an opening.
scene::Scene lit_road(const roads::LoadedLayout& layout) {
    scene::Scene scene = roads::layout_scene(layout);
    for (scene::Lamp& lamp : scene.lamps) lamp.opening = layout.distribution.opening;
    return scene;
}

bool wants_targets(const RoadArguments& arguments) { return arguments.stv || !arguments.target_map.empty(); }

/// Names the files that are read and written, and refuses options that do not go together.
void check_arguments(const RoadArguments& arguments) {
    io::announce_read(arguments.layout);
    io::announce_read(arguments.overrides.occluders);
    for (const std::string& file : arguments.pictures) {
        if (!file.ends_with(".png") && !file.ends_with(".exr"))
            throw Error("--render " + file + ": a .png or .exr file is expected");
        io::announce_write("--render", file);
    }
    if (!arguments.target_map.empty() && !arguments.target_map.ends_with(".png"))
        throw Error("--stv-map " + arguments.target_map + ": a .png file is expected");
    io::announce_write("--stv-map", arguments.target_map);
    if (arguments.reflectance && !wants_targets(arguments))
        throw Error("--target-reflectance has a meaning only beside --stv or --stv-map");
    io::announce_write("--csv", arguments.csv);
    io::announce_write("--json", arguments.json);
    if (!arguments.scene.empty() && !scene::is_gltf_name(arguments.scene))
        throw Error("--scene " + arguments.scene + ": a .gltf or .glb file is expected");
    io::announce_write("--scene", arguments.scene);
    if (!arguments.device.empty() && arguments.pictures.empty())
        throw Error("--device has a meaning only beside --render");
}

roads::LoadedLayout read_layout(const RoadArguments& arguments) {
    roads::LayoutOverrides overrides = arguments.overrides;
    overrides.occlusion = arguments.occlusion != "off";
    roads::LoadedLayout layout = roads::read_layout(arguments.layout, overrides);
    if (arguments.occlusion == "on" && !layout.hiding)
        throw Error("--occlusion on: neither the layout nor --occluders names a scene");
    if (layout.hiding && !arguments.pictures.empty())
        throw Error("--render has no occluders: --occlusion off leaves them out of the calculation, too");
    return layout;
}

/// The figures without occluders, if there are any.
std::optional<roads::RoadLighting> standard_of(roads::LoadedLayout layout) {
    if (!layout.hiding) return {};
    layout.hiding = nullptr;
    return roads::calculate_lighting(layout);
}

void run(const RoadArguments& arguments) {
    check_arguments(arguments);
    const roads::LoadedLayout layout = read_layout(arguments);
    const roads::RoadLighting result = io::in_file(arguments.layout, [&] { return roads::calculate_lighting(layout); });
    const std::optional<roads::RoadLighting> counted = standard_of(layout);
    const roads::RoadLighting* standard = counted ? &*counted : nullptr;
    const roads::LightingClass* wanted =
        roads::find_lighting_class(arguments.wanted.empty() ? layout.wanted_class : arguments.wanted);
    apps::print_text(text_of(layout, result, wanted ? wanted : roads::reached_class(result), standard));
    if (arguments.grid) apps::print_text(grid_text_of(result));
    std::optional<RoadTargets> found;
    if (wants_targets(arguments)) {
        found = road_targets(layout, arguments.reflectance.value_or(0.5));
        apps::print_text(text_of(*found));
        if (arguments.grid) apps::print_text(grid_text_of(result.field, *found));
    }
    const RoadTargets* targets = found ? &*found : nullptr;
    if (!arguments.target_map.empty()) write_target_map(arguments.target_map, layout, result.field, targets->counted);
    RenderedRoad rendered;
    if (!arguments.pictures.empty()) {
        rendered = render_road(layout, result, arguments.device);
        apps::print_text(text_of(result, rendered));
        for (const std::string& picture : arguments.pictures) write_picture(picture, layout, result, rendered);
    }
    const RenderedRoad* beside = arguments.pictures.empty() ? nullptr : &rendered;
    if (!arguments.scene.empty())
        scene::save_gltf(lit_road(layout), std::filesystem::path(arguments.layout).filename().string(),
                         arguments.scene);
    if (!arguments.csv.empty()) apps::write_text(arguments.csv, csv_of(layout, result, beside, targets));
    if (!arguments.json.empty())
        apps::write_text(arguments.json, json_of(layout, result, wanted, standard, beside, targets));
}

}  // namespace

void add_road(apps::Command program) {
    apps::Command command = program.add_command("road", "Calculate road lighting: Lav, Uo, Ul, TI, EIR (EN 13201-3)");
    const auto a = std::make_shared<RoadArguments>();
    roads::LayoutOverrides& o = a->overrides;
    std::vector<std::string> classes;
    for (const roads::LightingClass& c : roads::lighting_classes()) classes.emplace_back(c.name);
    command.add_option("layout", a->layout, "The road: a .json file (docs/road.md)").required();
    command.add_flag("--grid", a->grid, "Print illuminance and luminance of every point");
    command.add_flag("--stv", a->stv, "Calculate the visibility of small targets, too (IES RP-8-00)");
    command.add_option("--stv-map", a->target_map,
                       "Likewise, and draw the road with the level of each target: OUT.png");
    command.add_option("--target-reflectance", a->reflectance, "Of small targets (default: 0.5)")
        .check(apps::range(0.01, 1.0));
    command.add_option("--csv", a->csv, "Write the points to a CSV file");
    command.add_option("--json", a->json, "Write figures and points to a JSON file");
    command.add_option(
        "--render", a->pictures,
        "Render the road too and compare: OUT.png in false colours, OUT.exr in cd/m^2; may be given twice");
    command.add_option(
        "--scene", a->scene,
        "Write the road as a scene for vesper render: OUT.gltf or OUT.glb, with a camera for each observer");
    command.add_option("--device", a->device, "Where to render: part of a name, cpu, or an index of vesper devices");
    apps::add_thread_option(command, a->threads);
    command.add_option("--occluders", o.occluders,
                       "Trees and buildings that hide luminaires: .gltf or .glb, placed as in OUT of --scene");
    command
        .add_option("--occlusion", a->occlusion,
                    "Whether occluders count: off: figures of EN 13201-3 alone (default: on if there are any)")
        .check(apps::one_of({"on", "off"}));
    command.add_option("--class", a->wanted, "Lighting class to compare with (default: that of the file)")
        .check(apps::one_of(classes));
    command.add_option("--luminaire", o.luminaire, "Another luminaire: .ies or .ldt");
    command.add_option("--r-table", o.reflection_table, "Another surface: R1 to R4, C1, C2, W3, W4 or a .csv file");
    command.add_option("--q0", o.q0, "Scale the surface to this mean luminance coefficient, 1/sr")
        .check(apps::range(0.001, 10.0));
    command.add_option("--spacing", o.spacing, "m");
    command.add_option("--height", o.height, "m");
    command.add_option("--overhang", o.overhang, "m");
    command.add_option("--tilt", o.tilt, "degrees; raises the street side");
    command.add_option("--maintenance", o.maintenance_factor, "Maintenance factor");
    command.add_allow_outside();
    command.footer(
        "Examples:\n  vesper road data/road/worked-example.json\n"
        "  vesper road data/road/worked-example.json --r-table R2 --spacing 36 --grid --csv points.csv\n"
        "  vesper road data/road/worked-example.json --stv --stv-map targets.png\n"
        "  vesper road data/road/worked-example.json --render road.png\n"
        "  vesper road data/road/worked-example.json --scene road.gltf && vesper render road.gltf --camera \"observer "
        "lane 1\" --glare cie -o seen.png\n");
    command.callback([a] {
        apps::use_threads(a->threads);
        run(*a);
    });
}

}  // namespace vesper::commands
