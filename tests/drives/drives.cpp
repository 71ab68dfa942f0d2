// How steady is the picture of a drive? Greys of constant luminance are put into every frame of three drives, and the
// largest change of their codes from one frame to the next is held against a limit for each operator. Prints the table
// of docs/tone-curve.md.
//     vesper-drives [WIDTHxHEIGHT [FPS [SECONDS [none|cie [OPERATOR]]]]]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "base/error.h"
#include "places.h"
#include "render/renderer.h"
#include "render/tone_mapper.h"
#include "session/scenery.h"
#include "support/scene_geometry.h"

namespace vesper::test {
namespace {

using render::Operator;

constexpr std::array kMarkers{0.01f, 0.03f, 0.1f, 0.3f, 1.0f, 3.0f, 10.0f, 30.0f, 100.0f, 1000.0f};  // cd/m^2
constexpr double kRate = 60;        // steps of the world in a second
constexpr uint32_t kEveryLamp = 6;  // of the road's street lamps so many-th is lit: one in 180 m on each side
constexpr double kStride = 0.25;    // m, of the empty street from picture to picture
constexpr size_t kStrides = 80;

/// Codes that a marker may change by from one frame to the next: in drives with the default smoothing and without, and
/// in stills of an eye that is adapted to each. Published operators that go by single frames, or by the brightest
/// pixel, have what they were measured to have, and half as much again.
struct Limits {
    Operator op;
    int smoothed, plain, stills;
};
constexpr Limits kLimits[]{
    {Operator::Irawan, 3, 5, 4},    {Operator::Grave, 3, 5, 4},       {Operator::Ward, 190, 190, 4},
    {Operator::Pattanaik, 3, 3, 3}, {Operator::Reinhard, 5, 5, 3},    {Operator::Ferwerda, 60, 60, 3},
    {Operator::Durand, 23, 23, 3},  {Operator::Linear, 255, 255, 30},
};

struct Picture {
    VkExtent2D extent;
    std::vector<float> pixels;  // RGBA, cd/m^2
    std::vector<eye::OffscreenLamp> outside;
    double vertical_fov;  // rad
};

uint32_t marker_side(VkExtent2D extent) { return std::max(extent.height / 40, 4u); }
/// The upper left pixel of a marker: a row of them below the upper edge.
glm::uvec2 marker_at(VkExtent2D extent, size_t i) {
    return {uint32_t((double(i) + 0.5) / kMarkers.size() * extent.width) - marker_side(extent) / 2, extent.height / 8};
}

class Pictures {
public:
    Pictures(gpu::Device& device, const scene::Scene& scene) : renderer_(device, scene) {}

    Picture operator()(const gpu_scene::View& view, const gpu_scene::SceneFrame& moment) {
        render::RenderSettings settings;
        settings.tone_operator = Operator::Linear;
        render::Frame frame = renderer_.render(settings, view, moment, 0, {.scene = true});
        Picture picture{view.extent, std::move(frame.scene), std::move(frame.outside),
                        std::atan(view.tangent_high.y) - std::atan(view.tangent_low.y)};
        const uint32_t side = marker_side(view.extent);
        for (size_t k = 0; k < kMarkers.size(); ++k)
            for (uint32_t y = 0; y < side; ++y)
                for (uint32_t x = 0; x < side; ++x) {
                    const glm::uvec2 at = marker_at(view.extent, k) + glm::uvec2(x, y);
                    std::fill_n(&picture.pixels[4 * (size_t(at.y) * view.extent.width + at.x)], 3, kMarkers[k]);
                }
        return picture;
    }

private:
    render::Renderer renderer_;
};

/// The world of a file, driven by its autopilot. Of lamps named "street lamp" every `every`-th shines.
std::vector<Picture> drive(gpu::Device& device, const std::filesystem::path& file, VkExtent2D extent, double fps,
                           double seconds, uint32_t every) {
    const drive::Scenery scenery(file);
    traffic::World world(scenery.world(), 1);
    Pictures pictures(device, scenery.scene());
    const drive::DriveSettings settings;
    std::vector<Picture> made;
    for (uint64_t steps = 0; double(steps) <= seconds * kRate; ++steps) {
        if (double(steps) * fps >= double(made.size()) * kRate) {
            gpu_scene::SceneFrame moment = scenery.frame(world.actors(), settings);
            uint32_t lamp = 0;
            for (size_t node = 0; node < scenery.scene().nodes.size() && every > 1; ++node) {
                const uint32_t light = scenery.scene().nodes[node].lamp;
                if (light == scene::kNone || scenery.scene().lamps[light].name != "street lamp") continue;
                if (moment.dimming.empty()) moment.dimming.assign(scenery.scene().nodes.size(), 1);
                if (lamp++ % every != 0) moment.dimming[node] = 0;
            }
            made.push_back(pictures(scenery.view(moment, world.actors(), settings, extent), moment));
        }
        world.step({.autopilot = true}, 1 / kRate);
    }
    return made;
}

/// A street with nobody in it: walls, and lamps that begin 60 m ahead; the camera moves on by kStride.
std::vector<Picture> empty_street(gpu::Device& device, VkExtent2D extent) {
    scene::Scene scene;
    scene::Material asphalt, wall;
    asphalt.base_colour = {0.08f, 0.08f, 0.08f, 1}, wall.base_colour = {0.35f, 0.3f, 0.25f, 1};
    scene.materials = {asphalt, wall};
    scene.sky_luminance = 0.02f, scene.ambient_illuminance = 0.1f;
    add_mesh(scene, rectangle({-200, 0, 20}, {400, 0, 0}, {0, 0, -600}), kRectangle, 0);
    for (int i = 0; i < 12; ++i) {  // houses with gaps between them
        const float z = -25.0f * float(i);
        add_mesh(scene, rectangle({-11, 0, z + 20}, {0, 0, -20}, {0, 9.0f + float(i % 3) * 3, 0}), kRectangle, 1);
        add_mesh(scene, rectangle({11, 0, z}, {0, 0, 20}, {0, 12.0f - float(i % 4) * 2, 0}), kRectangle, 1);
    }
    for (int i = 0; i < 10; ++i) {
        scene::Lamp light{.name = "lamp", .kind = scene::Lamp::Kind::CosinePower, .intensity = 3000, .exponent = 0.5f};
        light.opening = {.length = 0.6, .width = 0.3, .height = 0, .round = false};
        scene::Node node;
        node.lamp = uint32_t(scene.lamps.size());
        node.translation = {i % 2 ? 6.0 : -6.0, 8.0, -60.0 - 28 * i};
        node.rotation = glm::angleAxis(-glm::half_pi<float>(), glm::vec3(1, 0, 0));  // -Z down
        scene.lamps.push_back(light);
        scene.nodes.push_back(node);
    }
    Pictures pictures(device, scene);
    std::vector<Picture> made;
    for (size_t i = 0; i < kStrides; ++i)
        made.push_back(
            pictures(gpu_scene::View::symmetric(
                         extent, 0.7f, glm::translate(glm::dmat4(1), -glm::dvec3(1.5, 1.3, -kStride * double(i)))),
                     {scene::world_transforms(scene, 0)}));
    return made;
}

struct Change {
    double codes = 0;
    size_t frame = 0, marker = 0;
};

using Codes = std::array<double, kMarkers.size()>;

/// Codes of the markers as a viewer has them on the screen.
Codes codes_of_pixels(const render::ToneMapped& shown, VkExtent2D extent) {
    Codes codes;
    for (size_t k = 0; k < codes.size(); ++k) {
        const glm::uvec2 at = marker_at(extent, k) + marker_side(extent) / 2;
        const uint8_t* code = &shown.display[4 * (size_t(at.y) * extent.width + at.x)];
        codes[k] = std::max({code[0], code[1], code[2]});
    }
    return codes;
}

/// And those of greys by the curve: where glare adds to the markers, and where what passes close by counts (bands).
Codes codes_of_curve(const shared::ToneCurve& curve, const vision::Display& display) {
    Codes codes;
    for (size_t k = 0; k < codes.size(); ++k) {
        const float at = std::clamp((std::log(kMarkers[k]) - curve.ln_low) * curve.bins_per_ln, 0.0f, curve.bins),
                    bin = std::min(std::floor(at), curve.bins - 1);
        const double shown = std::exp(std::lerp(curve.node[size_t(bin)].x, curve.node[size_t(bin) + 1].x, at - bin)),
                     low = display.low(), high = display.high();
        codes[k] = 255 * std::pow(std::clamp((shown - low) / (high - low), 0.0, 1.0), 1 / double(display.gamma));
    }
    return codes;
}

/// The largest change of a marker. `seconds` from picture to picture; 0: stills, of an eye that is adapted to each.
Change largest_change(gpu::Device& device, const std::vector<Picture>& pictures,
                      const render::ToneChainSettings& settings, double seconds) {
    render::ToneMapper mapper(device);
    Change most;
    Codes before{};
    for (size_t i = 0; i < pictures.size(); ++i) {
        const Picture& p = pictures[i];
        if (seconds == 0) mapper.reset_adaptation();
        const render::ToneMapped shown = mapper.map(settings,
                                                    {.extent = p.extent,
                                                     .values = p.pixels,
                                                     .channels = 4,
                                                     .vertical_fov = p.vertical_fov,
                                                     .outside = p.outside},
                                                    i == 0 ? 0 : float(seconds), {});
        const Codes now = settings.glare == render::Glare::None && !render::operator_info(settings.tone_operator).bands
                              ? codes_of_pixels(shown, p.extent)
                              : codes_of_curve(shown.curve, settings.display);
        for (size_t k = 0; k < now.size(); ++k)
            if (i > 0 && std::abs(now[k] - before[k]) > most.codes) most = {std::abs(now[k] - before[k]), i, k};
        before = now;
    }
    return most;
}

int run(VkExtent2D extent, double fps, double seconds, const std::string& glare, const std::string& only) {
    gpu::Device device({.select = ""});
    const std::string data = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/";
    const std::vector<Picture> street = drive(device, data + "rivoli.world.json", extent, fps, seconds, 1),
                               road = drive(device, data + "rivoli.xodr", extent, fps, seconds, kEveryLamp),
                               empty = empty_street(device, extent);
    render::ToneChainSettings settings;
    if (glare == "cie") settings.glare = render::Glare::Scatter;
    std::printf("%u x %u, %g frames a second, glare %s: largest change of a grey, codes\n\n", extent.width,
                extent.height, fps, glare.c_str());
    std::printf(
        "| operator | smoothing, s | street | road with few lamps | empty street | its stills |\n| --- | ---: | ---: | "
        "---: | ---: | ---: |\n");
    bool steady = true;
    for (const Limits& limits : kLimits) {
        const render::OperatorInfo& op = render::operator_info(limits.op);
        const std::string name(op.name);
        if (!only.empty() && only != name) continue;
        const bool has_curve = op.histogram;
        if (settings.glare != render::Glare::None && !has_curve) continue;
        settings.tone_operator = limits.op;
        for (const float smoothing : {0.15f, 0.0f}) {
            if (smoothing == 0 && !has_curve) continue;
            settings.tone.smoothing_seconds = smoothing;
            std::printf("| `%s` | %s |", name.c_str(), has_curve ? (smoothing > 0 ? "0.15" : "0") : "");
            const int limit = smoothing > 0 ? limits.smoothed : limits.plain;
            // The camera of the empty street moves by 4 to 15 m/s.
            const std::pair<const std::vector<Picture>*, double> columns[]{
                {&street, 1 / fps}, {&road, 1 / fps}, {&empty, 1 / fps}, {&empty, 0}};
            for (const auto& [pictures, step] : columns) {
                const Change most = largest_change(device, *pictures, settings, step);
                const bool within = std::ceil(most.codes) <= (step > 0 ? limit : limits.stills);
                steady &= within;
                std::printf(" %.0f%s |", std::ceil(most.codes), within ? "" : "!");
                if (!within)
                    std::fprintf(stderr, "%s, smoothing %g: %g cd/m^2 changes by %.1f codes at picture %zu of %zu\n",
                                 name.c_str(), double(smoothing), double(kMarkers[most.marker]), most.codes, most.frame,
                                 pictures->size());
            }
            std::printf("\n");
            std::fflush(stdout);
        }
    }
    return steady ? 0 : 1;
}

}  // namespace
}  // namespace vesper::test

int main(int argc, char** argv) {
    try {
        VkExtent2D extent{280, 175};
        if (argc > 1 && std::sscanf(argv[1], "%ux%u", &extent.width, &extent.height) != 2)
            throw vesper::Error(std::string(argv[1]) + ": WIDTHxHEIGHT is expected");
        return vesper::test::run(extent, argc > 2 ? std::atof(argv[2]) : 30, argc > 3 ? std::atof(argv[3]) : 2,
                                 argc > 4 ? argv[4] : "none", argc > 5 ? argv[5] : "");
    } catch (const vesper::Error& error) {
        std::fprintf(stderr, "vesper-drives: %s\n", error.what());
        return 2;
    }
}
