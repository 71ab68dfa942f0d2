#include <algorithm>

#include "arguments/arguments.h"
#include "base/one_line.h"
#include "inspect.h"
#include "io/in_file.h"
#include "print.h"
#include "roads/lit_roads.h"
#include "roads/opendrive.h"
#include "scene/colour.h"
#include "scene/read_scene.h"
#include "scene/scene_report.h"

namespace vesper::commands {
namespace {

using apps::format;

constexpr size_t kMostRows = 40;

std::string colour_text(glm::vec3 rgb) {
    const double kelvin = scene::temperature_of(glm::dvec3(rgb));
    if (kelvin > 0) return format("%.0f K", kelvin);
    const glm::dvec2 xy = scene::chromaticity(glm::dvec3(rgb));
    return format("x %.2f y %.2f", xy.x, xy.y);
}

std::string height_text(const scene::LampReport& lamp) {
    if (!lamp.lowest) return "-";
    if (*lamp.highest - *lamp.lowest < 0.05) return format("%.2f", *lamp.lowest);
    return format("%.2f to %.2f", *lamp.lowest, *lamp.highest);
}

std::string fixture_text(const scene::LampReport& lamp) {
    std::string rule = scene::name_of(lamp.fixture);
    if (lamp.fixture == scene::FixtureRule::None) return rule;
    return rule + (lamp.least_meshes == lamp.most_meshes ? format(", %zu", lamp.most_meshes)
                                                         : format(", %zu to %zu", lamp.least_meshes, lamp.most_meshes));
}

std::string lamps_text(const scene::SceneReport& report) {
    if (report.lamps.empty()) return "\nno lamps\n";
    std::string text = "\n" + apps::column("lamp", 26) +
                       "  kind          number         cd         lm  colour         height, m       fixture\n";
    size_t number = 0;
    for (const scene::LampReport& lamp : report.lamps) {
        number += lamp.number;
        if (lamp.kind == scene::Lamp::Kind::Directional) {
            text += apps::column(one_line(lamp.name), 26) +
                    format("  %-12s %7zu   %10.4g lx\n", scene::name_of(lamp.kind), lamp.number, lamp.candela);
            continue;
        }
        text +=
            apps::column(one_line(lamp.name), 26) +
            format("  %-12s %7zu %10.4g %10.4g  ", scene::name_of(lamp.kind), lamp.number, lamp.candela, lamp.lumens);
        text += apps::column(colour_text(lamp.colour), 14) + " " + apps::column(height_text(lamp), 15) + " " +
                fixture_text(lamp) + "\n";
    }
    return text +
           format("%zu lamps, %.4g lm together; heights are above the lowest surface under a lamp\n", number,
                  report.lumens) +
           "fixture: the rule for meshes that never hide a lamp, and the number of these\n";
}

std::string picture_text(const scene::MaterialReport& m) {
    return one_line(m.picture) + format(", mean %.4g", m.mean_emission);
}

std::string materials_text(const scene::SceneReport& report) {
    std::vector<const scene::MaterialReport*> sorted;
    for (const scene::MaterialReport& m : report.materials) sorted.push_back(&m);
    std::stable_sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->area > b->area; });
    std::string text = "\n" + apps::column("material", 30) +
                       "    area, m2  reflectance  rough  metal  emits cd/m2  r-table or picture\n";
    for (size_t i = 0; i < std::min(sorted.size(), kMostRows); ++i) {
        const scene::MaterialReport& m = *sorted[i];
        text += apps::column(one_line(m.name), 30) +
                format("  %10.4g  %6.3f %-4s  %5.2f  %5.2f  %11s  %s\n", m.area, m.reflectance, m.textured ? "(t)" : "",
                       m.roughness, m.metallic, m.emission > 0 ? format("%.4g", m.emission).c_str() : "",
                       m.picture.empty() ? one_line(m.road_table).c_str() : picture_text(m).c_str());
    }
    if (sorted.size() > kMostRows)
        text += format("... and %zu smaller ones (--json has them)\n", sorted.size() - kMostRows);
    return text + format("(t) mean of a texture. Diffuse reflectance by area: %.3f\n", report.mean_reflectance);
}

nlohmann::ordered_json json_of(const scene::SceneReport& report) {
    nlohmann::ordered_json json = {{"kind", "scene"},
                                   {"extent_m", {report.extent.x, report.extent.y, report.extent.z}},
                                   {"triangles", report.triangles},
                                   {"area_m2", report.area},
                                   {"mean_diffuse_reflectance", report.mean_reflectance},
                                   {"luminous_flux_lm", report.lumens},
                                   {"cameras", report.cameras},
                                   {"lamps", nlohmann::ordered_json::array()},
                                   {"materials", nlohmann::ordered_json::array()}};
    for (const scene::LampReport& l : report.lamps) {
        const bool sun = l.kind == scene::Lamp::Kind::Directional;
        nlohmann::ordered_json lamp = {{"name", l.name}, {"kind", scene::name_of(l.kind)}, {"number", l.number}};
        lamp[sun ? "illuminance_lx" : "intensity_cd"] = l.candela;
        if (!sun) lamp["luminous_flux_lm"] = l.lumens;
        lamp["colour"] = {l.colour.r, l.colour.g, l.colour.b};
        if (const double kelvin = scene::temperature_of(glm::dvec3(l.colour)); kelvin > 0)
            lamp["colour_temperature_K"] = kelvin;
        if (l.lowest) lamp["height_m"] = {*l.lowest, *l.highest};
        if (!sun) lamp["fixture"] = {{"rule", scene::name_of(l.fixture)}, {"meshes", {l.least_meshes, l.most_meshes}}};
        lamp["without_surface_below"] = l.over_nothing;
        lamp["below_ground"] = l.under_ground;
        json["lamps"].push_back(lamp);
    }
    for (const scene::MaterialReport& m : report.materials) {
        json["materials"].push_back({{"name", m.name},
                                     {"area_m2", m.area},
                                     {"mean_reflectance", m.reflectance},
                                     {"textured", m.textured},
                                     {"roughness", m.roughness},
                                     {"metallic", m.metallic},
                                     {"emission_cd_m2", m.emission}});
        if (!m.picture.empty())
            json["materials"].back()["emission_picture"] = {{"name", m.picture}, {"mean_cd_m2", m.mean_emission}};
        if (!m.road_table.empty()) json["materials"].back()["reflection_table"] = m.road_table;
    }
    json["implausible"] = report.warnings;
    return json;
}

/// `parts`: what the scene was built of, a line each.
Inspection inspection_of(const std::string& file, const scene::Scene& scene, const std::vector<std::string>& parts,
                         const std::vector<std::string>& notes) {
    const scene::SceneReport report = scene::report_scene(scene);
    std::string text = one_line(file) + "\n";
    for (const std::string& part : parts) text += "  " + part + "\n";
    text += format("%.4g x %.4g x %.4g m (x, up, z), %llu triangles, %zu materials\n", report.extent.x, report.extent.y,
                   report.extent.z, static_cast<unsigned long long>(report.triangles), report.materials.size());
    text += format("ambient %.4g lx, sky %.4g cd/m2, textures by ", static_cast<double>(scene.ambient_illuminance),
                   static_cast<double>(scene.sky_luminance));
    text += scene.transfer.kind == scene::Transfer::Kind::Gamma
                ? format("T^%.3g\n", static_cast<double>(scene.transfer.gamma))
                : "sRGB\n";
    text += "cameras: ";
    for (size_t i = 0; i < report.cameras.size(); ++i) text += (i ? ", " : "") + one_line(report.cameras[i]);
    text += report.cameras.empty() ? "none\n" : "\n";
    const Inspection names = inspect_names(scene);
    text += lamps_text(report) + materials_text(report) + names.text;
    text += notes_text(notes);
    text += report.warnings.empty() ? "\nnothing implausible\n" : "\nimplausible:\n";
    for (const std::string& warning : report.warnings) text += "  " + warning + "\n";
    nlohmann::ordered_json json = json_of(report);
    json["ambient_illuminance_lx"] = scene.ambient_illuminance;
    json["sky_luminance_cd_m2"] = scene.sky_luminance;
    json["notes"] = notes;
    if (!parts.empty()) json["parts"] = parts;
    json["names"] = names.json;
    return {text, json};
}

}  // namespace

Inspection inspect_scene(const InspectArguments& arguments) {
    const scene::LoadedScene loaded = scene::read_scene(arguments.file);
    return inspection_of(arguments.file, loaded.scene, {}, loaded.notes);
}

Inspection inspect_roads(const InspectArguments& arguments) {
    const roads::RoadNetwork network = roads::read_opendrive(arguments.file);
    const roads::LitRoads lit = io::in_file(arguments.file, [&] { return roads::lit_roads(network); });
    Inspection made = inspection_of(arguments.file, lit.scene, lit.notes, network.notes);
    made.json["unread"] = network.unread;
    return made;
}

}  // namespace vesper::commands
