// `vesper saliency`: where a picture draws the eye, and what a display keeps of it. SPDX-License-Identifier: MIT
#include "saliency.h"

#include <algorithm>
#include <cmath>

#include "analysis/display_light.h"
#include "arguments/arguments.h"
#include "arguments/thread_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/one_line.h"
#include "commands.h"
#include "io/file_gate.h"
#include "plots/false_colour.h"
#include "print.h"
#include "render/tone_mapper.h"

namespace vesper::commands {
namespace {

struct SaliencyArguments {
    std::string input, picture, json, device;
    unsigned threads = 0, places = 10;
    double radius = 2;  // degrees
    bool statistics = false;
    PictureSource source;
    apps::ToneArguments tone;
};

std::vector<analysis::Fixation> places_of(const analysis::SaliencyMap& map, const SaliencyFindings& found,
                                          const SaliencyArguments& a) {
    return analysis::fixations({map.extent.width, map.extent.height, map.texel, map.values}, found.angles,
                               a.radius * kRadiansPerDegree, a.places);
}

/// Luminances of the texel about a place.
void measure(SalientPlace& place, const StudyPicture& picture, double texel) {
    const auto first = glm::uvec2(place.pixels / texel) * uint32_t(texel);
    double sum = 0, count = 0;
    for (uint32_t y = first.y; y < std::min(first.y + uint32_t(texel), picture.extent.height); ++y)
        for (uint32_t x = first.x; x < std::min(first.x + uint32_t(texel), picture.extent.width); ++x) {
            const double l = picture.luminance(size_t{y} * picture.extent.width + x);
            if (!std::isfinite(l)) continue;
            sum += std::max(l, 0.0), count += 1, place.brightest = std::max(place.brightest, l);
        }
    place.mean_luminance = count > 0 ? sum / count : 0;
}

void compare(SaliencyFindings& found, const SaliencyArguments& a) {
    const std::vector<analysis::Fixation> scene = places_of(found.scene, found, a),
                                          display = places_of(found.display, found, a);
    found.display_places = display.size();
    for (const analysis::Fixation& fixation : scene) {
        SalientPlace place{.pixels = fixation.pixels,
                           .degrees = glm::atan(found.angles.at(fixation.pixels)) / kRadiansPerDegree,
                           .saliency = fixation.value / scene.front().value,
                           .on_display = {}};
        measure(place, *found.picture, found.scene.texel);
        const auto same = std::ranges::find_if(display, [&](const analysis::Fixation& other) {
            return analysis::angle_between(found.angles, fixation.pixels, other.pixels) <=
                   found.radius * kRadiansPerDegree;
        });
        if (same != display.end()) place.on_display = size_t(same - display.begin()) + 1;
        found.places.push_back(place);
    }
    found.rank_correlation = analysis::rank_correlation(found.scene.values, found.display.values);
}

void print_findings(const SaliencyFindings& found) {
    if (found.places.empty()) apps::print("nothing stands out of the picture\n");
    for (size_t i = 0; i < found.places.size(); ++i) {
        const SalientPlace& p = found.places[i];
        apps::print("%3u  (%.0f, %.0f) px  %+.1f, %+.1f degrees  mean %.3g, brightest %.3g cd/m^2  saliency %.3f  %s\n",
                    unsigned(i + 1), p.pixels.x, p.pixels.y, p.degrees.x, p.degrees.y, p.mean_luminance, p.brightest,
                    p.saliency,
                    p.on_display ? apps::format("%u on the display", unsigned(*p.on_display)).c_str() : "lost");
    }
    if (!found.rank_correlation) {
        apps::print("rank correlation: none, as nothing stands out\n");
        return;
    }
    const auto kept =
        std::ranges::count_if(found.places, [](const SalientPlace& p) { return p.on_display.has_value(); });
    apps::print("%s: rank correlation %.3f, keeps %u of %u places\n", found.tone_operator.c_str(),
                *found.rank_correlation, unsigned(kept), unsigned(found.places.size()));
}

void run(const SaliencyArguments& a) {
    const render::ToneChainSettings settings = apps::tone_settings(a.tone);
    if (settings.tone_operator == render::Operator::Ldr) throw Error("--operator ldr: it does not show luminance");
    check_source(a.source, std::span(&a.input, 1));
    io::announce_read(a.input);
    const bool values = a.picture.ends_with(".exr");
    if (!values && !a.picture.ends_with(".png"))
        throw Error("-o " + one_line(a.picture) + ": a .png or .exr file is expected");
    io::announce_write("-o", a.picture);
    io::announce_write("--json", a.json);
    gpu::Device device({.select = a.device});
    const StudyPicture picture = read_study_picture(a.source, device, settings, a.input);

    SaliencyFindings found{
        .file = a.input,
        .tone_operator = apps::name_of(settings.tone_operator),
        .picture = &picture,
        .angles = gpu_scene::angles_of(render::view_of(picture.extent, picture.vertical_fov, picture.host().angles)),
        .radius = a.radius,
        .scene = {},
        .display = {},
        .places = {}};
    analysis::SaliencyMapper mapper(device);
    try {
        found.scene = mapper.map(picture.host());
    } catch (const Error& error) {
        throw Error(one_line(a.input) + ": " + error.what());
    }
    if (found.scene.pairs < 6)
        apps::print_note(apps::format("%s: only %u of 6 pairs of levels can be compared in less than 256 px on a side",
                                      one_line(a.input).c_str(), found.scene.pairs));
    render::ToneMapper tone(device);
    const render::ToneMapped shown = tone.map(settings, picture.host(), 0);
    const std::vector<float> light = analysis::DisplayLight(settings.display).of_words(shown.display);
    found.display = mapper.map(picture.like(light, 3, 1));
    compare(found, a);
    if (values)
        apps::save_values(a.picture, {found.scene.extent.width, found.scene.extent.height, found.scene.values},
                          "saliency of squares of 16 x 16 px");
    else
        save_saliency(a.picture, found);
    if (!a.json.empty()) apps::write_text(a.json, json_of(found).dump(1) + "\n");
    print_findings(found);
    if (!a.statistics) return;
    double milliseconds = 0;  // of the second map: before the first, the device compiles
    for (const graph::Timing& timing : found.display.timings)
        if (timing.pass.starts_with("saliency ")) milliseconds += timing.milliseconds;
    apps::print("saliency: %.1f ms on %s\n", milliseconds, device.name().c_str());
}

}  // namespace

void add_saliency(apps::Command program) {
    apps::Command command = program.add_command(
        "saliency", "Find where a picture draws the eye, and what a display keeps of it (docs/saliency.md)");
    const auto a = std::make_shared<SaliencyArguments>();
    a->source.angle_matters = true;
    command.add_option("picture", a->input, "An OpenEXR or Radiance picture, or a .gltf or .glb to render once")
        .required();
    command
        .add_option("--output,-o", a->picture,
                    "OUT.png: the map over the picture, with numbered places; OUT.exr: its values")
        .required();
    command.add_option("--json", a->json, "Write the places to a JSON file");
    command.add_option("--peaks", a->places, "How many places are looked for")
        .check(apps::range(1u, 100u))
        .shows_default();
    command.add_option("--radius", a->radius, "About a place, in which no other is looked for, degrees")
        .check(apps::between(0.1, 20.0))
        .shows_default();
    command.add_flag("--stats", a->statistics, "Print milliseconds of the passes");
    command.add_option("--device", a->device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    add_source_options(command, a->source);
    apps::add_thread_option(command, a->threads);
    apps::add_tone_options(command, a->tone);
    command.footer("Example:\n  vesper saliency night.gltf --camera driver -o saliency.png --operator irawan\n");
    command.callback([a] {
        apps::use_threads(a->threads);
        run(*a);
    });
}

}  // namespace vesper::commands
