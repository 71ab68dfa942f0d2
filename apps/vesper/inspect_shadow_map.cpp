// The shadow map of a lamp of a scene. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "arguments/arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "gpu/device.h"
#include "inspect.h"
#include "plots/false_colour.h"
#include "print.h"
#include "render/shadows/host_shadow_map.h"
#include "scene/photometry.h"
#include "scene/read_scene.h"

namespace vesper::commands {
namespace {

using apps::format;
using render::HostShadowMap;

constexpr uint32_t kSide = 512;  // texels, and px

std::vector<uint32_t> lamps_named(const scene::Scene& scene, const std::string& name) {
    std::vector<uint32_t> nodes;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (const uint32_t lamp = scene.nodes[i].lamp;
            lamp != scene::kNone &&
            (scene::matches_name(name, scene.lamps[lamp].name) || scene::matches_node(name, scene, i)))
            nodes.push_back(i);
    return nodes;
}

// A place of the map that the report names.
struct Place {
    const char* name;
    glm::dvec2 uv;
    bool second;  // hemisphere
};

// The picture is upside down, so that the first hemisphere is not mirrored.
constexpr Place kCorners[] = {{"upper left, +Y of the lamp", {-1, 1}, false},
                              {"upper right, +X", {1, 1}, false},
                              {"lower right, -Y", {1, -1}, false},
                              {"lower left, -X", {-1, -1}, false}};

// The least of the texels around a place, m; 0 if none of them sees anything.
double distance_at(const HostShadowMap& map, const Place& place) {
    const double side = map.layout.side;
    const glm::dvec2 at = glm::clamp((place.uv * 0.5 + 0.5) * side - 0.5, 0.0, side - 1);
    const glm::uvec2 low(glm::floor(at)), high(glm::ceil(at));
    double least = 0;
    for (const uint32_t y : {low.y, high.y})
        for (const uint32_t x : {low.x, high.x}) {
            const size_t row = (place.second ? map.layout.side : 0) + y;
            const auto distance = static_cast<double>(map.distances[row * map.layout.side + x]);
            if (distance > 0 && (least == 0 || distance < least)) least = distance;
        }
    return least;
}

// The share of the map's solid angle along which there is no surface.
double empty_share(const HostShadowMap& map) {
    const uint32_t side = map.layout.side;
    double all = 0, empty = 0;
    for (size_t i = 0; i < map.distances.size(); ++i) {
        const glm::dvec2 texel(i % side, i / side % side);
        const double length = glm::length(map.direction((texel + 0.5) * (2.0 / side) - 1.0, false));
        const double solid_angle = 1 / (length * length * length);
        all += solid_angle;
        if (!(map.distances[i] > 0)) empty += solid_angle;
    }
    return empty / all;
}

void report_places(const HostShadowMap& map, Inspection& made) {
    std::vector<Place> places = {{"axis", {0, 0}, false}};
    if (map.layout.hemispheres == 2) places.push_back({"against the axis", {0, 0}, true});
    places.insert(places.end(), std::begin(kCorners), std::end(kCorners));
    made.text += "\n  " + apps::column("direction", 28) + "  world x, up, z        distance, m\n";
    for (const Place& place : places) {
        const glm::dvec3 d = glm::normalize(map.direction(place.uv, place.second));
        const double distance = distance_at(map, place);
        made.text += "  " + apps::column(place.name, 28) + format("  %6.3f %6.3f %6.3f  ", d.x, d.y, d.z) +
                     (distance > 0 ? format("%11.4g\n", distance) : "    nothing\n");
        made.json["directions"].push_back({{"name", place.name}, {"world", {d.x, d.y, d.z}}, {"distance_m", nullptr}});
        if (distance > 0) made.json["directions"].back()["distance_m"] = distance;
    }
}

Inspection report(const HostShadowMap& map) {
    const render::ShadowMapLayout& layout = map.layout;
    std::vector<float> seen;
    for (const float distance : map.distances)
        if (distance > 0) seen.push_back(distance);
    const double empty = empty_share(map);
    const glm::dvec3 at = map.frame.position;
    Inspection made;
    made.text += format("  at           %.6g, %.6g, %.6g m (x, up, z)\n", at.x, at.y, at.z);
    made.text += format("  fixture      meshes that never hide the lamp: %zu\n", map.fixture);
    made.text += format("  map          %u x %u texels, %s, zoom %.3g, range %.4g m\n", layout.side, layout.side,
                        layout.hemispheres == 2 ? "two hemispheres" : "one hemisphere", double(layout.zoom),
                        double(layout.range));
    made.json = {{"kind", "shadow map"},
                 {"position_m", {at.x, at.y, at.z}},
                 {"fixture_meshes", map.fixture},
                 {"side", layout.side},
                 {"hemispheres", layout.hemispheres},
                 {"zoom", layout.zoom},
                 {"range_m", layout.range},
                 {"nothing", empty}};
    if (!seen.empty()) {
        const auto [least, greatest] = std::ranges::minmax(seen);
        made.text += format("  surfaces     from %.4g to %.4g m\n", double(least), double(greatest));
        made.json["surfaces_m"] = {least, greatest};
    }
    made.text += format("  nothing      along %.1f %% of the solid angle of the map\n", 100 * empty);
    report_places(map, made);
    return made;
}

void draw(const HostShadowMap& map, const std::string& title, const std::string& file) {
    constexpr double kLeft = 16, kTop = 40, kStep = kSide + 16;
    const auto width = static_cast<uint32_t>(kLeft + kStep * map.layout.hemispheres + apps::kBarWidth + 10);
    const apps::ColourScale scale = apps::scale_of(map.distances);
    apps::Canvas canvas(width, static_cast<uint32_t>(kTop) + kSide + 56);
    canvas.text({kLeft, 20}, title, 14);
    for (uint32_t h = 0; h < map.layout.hemispheres; ++h) {
        apps::ValuePicture square{kSide, kSide, {}};
        for (uint32_t y = kSide; y-- > 0;) {
            const auto row = map.distances.begin() + ptrdiff_t{kSide} * (ptrdiff_t{kSide} * h + y);
            square.values.insert(square.values.end(), row, row + kSide);
        }
        const glm::dvec2 corner(kLeft + kStep * h, kTop);
        canvas.pixels(static_cast<int>(corner.x), static_cast<int>(corner.y), kSide, kSide,
                      apps::false_colours(square, scale));
        const char* labels[] = {"+Y", "+X", "-Y", "-X"};
        for (size_t i = 0; i < 4; ++i) {
            const glm::dvec2 uv = kCorners[i].uv, inward(uv.x > 0 ? -8 : 8, uv.y > 0 ? 12 : -12);
            canvas.text(corner + double{kSide} * (glm::dvec2(uv.x, -uv.y) * 0.5 + 0.5) + inward, labels[i], 13,
                        uv.x > 0 ? apps::Canvas::Align::Right : apps::Canvas::Align::Left, apps::CanvasColour(1), true);
        }
        canvas.text(corner + glm::dvec2(0, kSide + 14.0), h == 0 ? "about the axis" : "about the opposite direction",
                    13);
    }
    canvas.text({kLeft, kTop + kSide + 36},
                format("%u x %u texels, zoom %.3g, range %.4g m; black: nothing", map.layout.side, map.layout.side,
                       double(map.layout.zoom), double(map.layout.range)),
                13);
    apps::draw_colour_bar(canvas, {kLeft + kStep * map.layout.hemispheres, kTop + 24}, kSide - 24.0, scale, "m");
    canvas.save(file);
}

}  // namespace

Inspection inspect_shadow_map(const InspectArguments& arguments) {
    const scene::Scene scene = scene::read_scene(arguments.file).scene;
    const std::vector<uint32_t> nodes = lamps_named(scene, arguments.lamp);
    if (nodes.empty())
        throw Error(arguments.file + ": no lamp, and no node with a lamp, is named '" + one_line(arguments.lamp) + "'");
    if (arguments.lamp_number > nodes.size())
        throw Error("--lamp-number " + std::to_string(arguments.lamp_number) + ": " + std::to_string(nodes.size()) +
                    (nodes.size() == 1 ? " lamp is" : " lamps are") + " named '" + one_line(arguments.lamp) + "'");
    const uint32_t node = nodes[arguments.lamp_number - 1];
    const std::string lamp = one_line(scene.lamps[scene.nodes[node].lamp].name);
    gpu::Device device({.select = arguments.device});
    const HostShadowMap map = render::host_shadow_map(device, scene, node, kSide);
    Inspection made = report(map);
    const std::string which = format("%zu of %zu of this name", size_t{arguments.lamp_number}, nodes.size());
    made.text = one_line(arguments.file) + ": lamp '" + lamp + "' at node '" + one_line(scene.nodes[node].name) +
                "' (" + which + ")\n" + made.text;
    made.json["lamp"] = lamp, made.json["node"] = scene.nodes[node].name;
    if (!arguments.picture.empty())
        draw(map, "lamp '" + lamp + "' (" + which + "), " + arguments.file, arguments.picture);
    return made;
}

}  // namespace vesper::commands
