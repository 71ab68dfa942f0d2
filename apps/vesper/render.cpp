#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

#include "arguments.h"
#include "commands.h"
#include "io/image_file.h"
#include "progress.h"
#include "renderer.h"
#include "scene/gltf.h"
#include "statistics.h"

namespace vesper {
namespace {

struct RenderArguments {
    std::string scene, camera, size = "1680x1050", device, lambert = "physical", tone_operator = "ward", glare = "none";
    std::vector<std::string> outputs;
    std::string statistics_file;
    RenderSettings settings;
    int foveal_level = 0;
    unsigned frames = 1;
    double dt = 1.0 / 30, start = 0;
    bool statistics = false, plan = false;
};

const std::map<std::string, Operator> kOperators{{"irawan", Operator::Irawan}, {"ward", Operator::Ward}, {"reinhard", Operator::Reinhard}, {"linear", Operator::Linear}, {"ldr", Operator::Ldr}};
const std::map<std::string, Glare> kGlares{{"none", Glare::None}, {"ldr", Glare::Ldr}};

std::string name_of(Operator wanted) {
    for (const auto& [name, value] : kOperators)
        if (value == wanted) return name;
    return {};
}

VkExtent2D parse_size(const std::string& text) {
    unsigned width = 0, height = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) != 2 || width < 1 || height < 1 || width > 16384 || height > 16384)
        throw Error("--size " + text + ": expected WIDTHxHEIGHT, 1x1 to 16384x16384");
    return {width, height};
}

// The file of one frame of several: %04d is replaced by its number, or the number is put before the extension.
std::string file_of_frame(const std::string& pattern, unsigned index, unsigned frames) {
    char number[16];
    const size_t percent = pattern.find('%');
    if (percent != std::string::npos) {
        const size_t d = pattern.find('d', percent);
        const std::string digits = d == std::string::npos ? "x" : pattern.substr(percent + 1, d - percent - 1);
        if (digits.size() > 2 || (digits.size() == 2 && digits > "10") || !std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); }))
            throw Error("-o " + pattern + ": only a number such as %04d may follow a %");
        std::snprintf(number, sizeof number, "%0*u", digits.empty() ? 1 : std::stoi(digits), index);
        return pattern.substr(0, percent) + number + pattern.substr(d + 1);
    }
    if (frames == 1) return pattern;
    std::snprintf(number, sizeof number, ".%04u", index);
    const size_t dot = pattern.rfind('.');
    return pattern.substr(0, dot) + number + pattern.substr(dot);
}

Header describe_frame(const RenderArguments& arguments, const Device& device, const View& view, const Frame& frame, double seconds) {
    const auto number = [](double value) { return format("%.9g", value); };
    std::string pose;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) pose += (pose.empty() ? "" : " ") + number(double(view.world_to_view[c][r]));
    return {{"vesper:version", VESPER_VERSION},
            {"vesper:scene", arguments.scene},
            {"vesper:unit", "cd/m^2, linear Rec. 709 RGB"},
            {"vesper:camera", arguments.camera},
            {"vesper:worldToView", pose},
            {"vesper:tangents", number(double(view.tangent_low.x)) + " " + number(double(view.tangent_low.y)) + " " + number(double(view.tangent_high.x)) + " " + number(double(view.tangent_high.y))},
            {"vesper:seconds", number(seconds)},
            {"vesper:lights", std::to_string(frame.lights)},
            {"vesper:illuminanceThreshold", number(double(arguments.settings.clusters.threshold))},
            {"vesper:lambert", arguments.lambert},
            {"vesper:operator", name_of(arguments.settings.tone_operator)},
            {"vesper:adaptationLuminance", number(double(frame.curve.adaptation))},
            {"vesper:fovealLevel", std::to_string(frame.foveal_level)},
            {"vesper:displayLow", number(double(arguments.settings.display.low()))},
            {"vesper:displayHigh", number(double(arguments.settings.display.high()))},
            {"vesper:device", device.name() + ", " + device.driver()}};
}

void print_statistics(const RenderArguments& arguments, const Device& device, const Renderer& renderer, const Frame& frame,
                      std::vector<double> milliseconds) {
    std::printf("%s on %s (%s)\n", arguments.scene.c_str(), device.name().c_str(), device.driver().c_str());
    std::printf("%ux%u, %s, %llu triangles, %u lamps, %.0f MiB on the device\n", frame.extent.width, frame.extent.height,
                name_of(arguments.settings.tone_operator).c_str(), static_cast<unsigned long long>(renderer.scene().triangles()),
                frame.lights, double(renderer.device_bytes()) / (1 << 20));
    std::printf("clusters: to %.0f m, at most %u lamps in a froxel, %u froxels overflowed (and looked at every lamp)\n",
                double(frame.far), frame.clusters.longest, frame.clusters.overflowed);
    std::printf("adaptation luminance %.4g cd/m^2, foveal level %u, %u of %u pixels not finite\n", double(frame.curve.adaptation),
                frame.foveal_level, frame.histogram.non_finite, frame.histogram.finite + frame.histogram.non_finite);
    const bool ldr = arguments.settings.tone_operator == Operator::Ldr;
    std::fputs(text_of(luminance_statistics(frame.scene), ldr ? "LDR values, relative to white" : "luminance, cd/m^2").c_str(), stdout);
    double total = 0;
    std::printf("device time, ms\n");
    for (const Timing& timing : frame.timings) {
        std::printf("  %-24s %8.3f\n", timing.pass.c_str(), timing.milliseconds);
        total += timing.milliseconds;
    }
    std::printf("  %-24s %8.3f\n", "sum", total);
    // The first frame makes the driver compile its shaders.
    if (milliseconds.size() > 1) milliseconds.erase(milliseconds.begin());
    std::sort(milliseconds.begin(), milliseconds.end());
    std::printf("frame on the host's clock, ms: median %.1f of %zu, least %.1f\n", milliseconds[milliseconds.size() / 2],
                milliseconds.size(), milliseconds.front());
}

void write_outputs(const RenderArguments& arguments, const Device& device, const View& view, const Frame& frame, unsigned index, double seconds) {
    for (const std::string& output : arguments.outputs) {
        const std::string file = file_of_frame(output, index, arguments.frames);
        if (ends_with(output, ".png"))
            write_png(file, frame.extent.width, frame.extent.height, frame.display);
        else
            write_exr(file, frame.extent.width, frame.extent.height, frame.scene, describe_frame(arguments, device, view, frame, seconds));
    }
}

// Everything that can be wrong with the arguments alone, and what follows from them.
void check_arguments(RenderArguments& arguments) {
    RenderSettings& settings = arguments.settings;
    settings.tone_operator = kOperators.at(arguments.tone_operator);
    settings.glare = kGlares.at(arguments.glare);
    settings.paper_lambert = arguments.lambert == "paper";
    if (arguments.foveal_level > 0) settings.foveal_level = uint32_t(arguments.foveal_level);
    for (const std::string& output : arguments.outputs) {
        const bool exr = ends_with(output, ".exr");
        if (!exr && !ends_with(output, ".png")) throw Error("-o " + output + ": a .png or .exr file is expected");
        if (exr && settings.tone_operator == Operator::Ldr) throw Error("-o " + output + ": the ldr operator has no luminances to write; use .png");
        check_folder("-o", file_of_frame(output, 0, arguments.frames));
    }
    if (!arguments.statistics_file.empty()) check_folder("--stats-json", arguments.statistics_file);
    if (arguments.outputs.empty() && arguments.statistics_file.empty() && !arguments.statistics && !arguments.plan)
        throw Error("nothing to do: give -o, --stats, --stats-json or --plan");
    if (settings.tone.linear_high > 0 && settings.tone.linear_high <= settings.tone.linear_low)
        throw Error("--linear-max must be more than --linear-min");
    if (settings.display.peak <= settings.display.black) throw Error("--display-peak must be more than --display-black");
}

void run(RenderArguments& arguments) {
    const VkExtent2D extent = parse_size(arguments.size);
    check_arguments(arguments);
    const bool wants_statistics = arguments.statistics || !arguments.statistics_file.empty();
    Outputs outputs{.display = wants_statistics, .scene = false};  // what is timed includes the display image
    for (const std::string& output : arguments.outputs) (ends_with(output, ".png") ? outputs.display : outputs.scene) = true;

    LoadedScene loaded = read_gltf(arguments.scene);
    loaded.scene.name = arguments.scene;
    for (const std::string& note : loaded.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
    const Scene& scene = loaded.scene;
    SceneFrame moment{world_transforms(scene, arguments.start)};
    camera_view(scene, moment, arguments.camera, extent);  // a wrong name is known before a device is opened
    const std::vector<std::string> cameras = camera_names(scene);
    if (arguments.camera.empty() && !cameras.empty()) arguments.camera = cameras.front();
    if (arguments.settings.tone_operator == Operator::Irawan)
        std::fprintf(stderr, "note: 'irawan' equals 'ward' until its temporal model is there\n");

    Device device({.select = arguments.device});
    Renderer renderer(device, scene);
    Progress progress("rendering", arguments.frames);
    std::vector<double> milliseconds;
    for (unsigned index = 0; index < arguments.frames; ++index) {
        const double seconds = arguments.start + index * arguments.dt;
        moment.world = world_transforms(scene, seconds);
        const View view = camera_view(scene, moment, arguments.camera, extent);
        const bool last = index + 1 == arguments.frames;
        const Frame frame = renderer.render(arguments.settings, view, moment, index == 0 ? 0.0f : float(arguments.dt),
                                            {.display = outputs.display, .scene = outputs.scene || (last && wants_statistics)});
        milliseconds.push_back(frame.milliseconds);
        write_outputs(arguments, device, view, frame, index, seconds);
        if (index == 0 && arguments.plan) std::fputs(renderer.plan().c_str(), stdout);
        if (last) {
            if (arguments.statistics) print_statistics(arguments, device, renderer, frame, milliseconds);
            if (!arguments.statistics_file.empty())
                write_text(arguments.statistics_file, json_of(luminance_statistics(frame.scene)) + "\n");
        }
        progress.step();
    }
}

}  // namespace

void add_render(CLI::App& program) {
    CLI::App* command = program.add_subcommand("render", "Render a photometric scene to a display image or to luminance");
    const auto a = std::make_shared<RenderArguments>();
    command->add_option("scene", a->scene, "A .gltf or .glb, as vesper convert writes it")->required();
    command->add_option("--output,-o", a->outputs, "OUT.png: display image; OUT.exr: absolute cd/m^2; may be given twice");
    command->add_option("--camera,-c", a->camera, "Name of a camera of the scene (default: the first)");
    command->add_option("--size,-s", a->size, "WIDTHxHEIGHT, px")->capture_default_str();
    command->add_option("--operator", a->tone_operator, "How luminance is shown")->check(CLI::IsMember({"irawan", "ward", "reinhard", "linear", "ldr"}))->capture_default_str();
    command->add_option("--glare", a->glare, "ldr: the paper's, on the tone-mapped image")->check(CLI::IsMember({"none", "ldr"}))->capture_default_str();
    command->add_option("--frames", a->frames, "How many frames; files are numbered")->check(CLI::Range(1u, 1000000u))->capture_default_str();
    command->add_option("--dt", a->dt, "Time between frames, s")->check(between(1e-6, 3600.0))->capture_default_str();
    command->add_option("--start", a->start, "Time of the first frame, s")->check(between(0.0, 1e6))->capture_default_str();
    command->add_flag("--stats", a->statistics, "Print luminances and milliseconds of the last frame");
    command->add_option("--stats-json", a->statistics_file, "Write the luminances of the last frame to a JSON file");
    command->add_flag("--plan", a->plan, "Print the plan of the frame: passes, barriers, memory");
    command->add_option("--device", a->device, "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    command->add_option("--lambert", a->lambert, "physical: L = E R / pi; paper: L = E R")->check(CLI::IsMember({"physical", "paper"}))->capture_default_str();
    command->add_option("--threshold", a->settings.clusters.threshold, "Illuminance below which a lamp counts as dark: on matt surfaces, or on a plane facing it, lx")->check(between(1e-9, 1e3))->capture_default_str();
    command->add_option("--bins", a->settings.histogram.bins, "Bins of the histogram")->check(CLI::Range(1u, shared::kMaxBins))->capture_default_str();
    command->add_option("--foveal-level", a->foveal_level, "Pyramid level of the histogram (default: 1 degree per texel; the paper: 5)")->check(CLI::Range(1, 14));
    command->add_option("--key", a->settings.tone.key, "Reinhard: what the log average is shown as, relative to white")->check(between(1e-4, 10.0))->capture_default_str();
    command->add_option("--white", a->settings.tone.white, "Reinhard: luminance shown as white, cd/m^2 (default: the maximum)")->check(between(0.0, 1e9));
    command->add_option("--linear-min", a->settings.tone.linear_low, "linear: luminance shown as black, cd/m^2")->check(between(0.0, 1e9))->capture_default_str();
    command->add_option("--linear-max", a->settings.tone.linear_high, "linear: luminance shown as white, cd/m^2 (default: the maximum)")->check(between(0.0, 1e9));
    command->add_option("--display-peak", a->settings.display.peak, "Display: luminance of white in the dark, cd/m^2")->check(between(0.1, 1e5))->capture_default_str();
    command->add_option("--display-black", a->settings.display.black, "Display: luminance of black in the dark, cd/m^2")->check(between(1e-6, 1e3))->capture_default_str();
    command->add_option("--display-gamma", a->settings.display.gamma, "Display: exponent")->check(between(0.5, 5.0))->capture_default_str();
    command->add_option("--display-ambient", a->settings.display.ambient, "Display: illuminance on the screen, lx")->check(between(0.0, 1e5))->capture_default_str();
    command->add_option("--display-reflection", a->settings.display.reflection, "Display: diffuse reflectance")->check(between(0.0, 1.0))->capture_default_str();
    command->add_flag("--all-lights", a->settings.all_lights, "Shade without clusters: the slow way to the same picture");
    command->footer("Examples:\n  vesper render night.gltf --camera driver --operator ward --stats -o night.png\n"
                    "  vesper render night.gltf --camera driver -o night.exr\n"
                    "  vesper render night.gltf --camera driver --frames 300 --dt 0.0333 -o drive/%04d.png\n");
    command->callback([a] { run(*a); });
}

}  // namespace vesper
