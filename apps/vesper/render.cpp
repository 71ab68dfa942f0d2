#include <algorithm>
#include <memory>
#include <optional>

#include "arguments/command_line.h"

#include "arguments/arguments.h"
#include "arguments/cache_arguments.h"
#include "arguments/glare_arguments.h"
#include "arguments/obstacle_arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/setting_arguments.h"
#include "arguments/thread_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/one_line.h"
#include "commands.h"
#include "frame_files.h"
#include "gathered_light.h"
#include "gpu_scene/cameras.h"
#include "io/file_gate.h"
#include "io/growing_file.h"
#include "io/image_file.h"
#include "numbered_files.h"
#include "print.h"
#include "progress.h"
#include "ranks/frame_relay.h"
#include "render/renderer.h"
#include "render_records.h"
#include "scaled_picture.h"
#include "scene/apply_photometry.h"
#include "scene/placement.h"
#include "scene_notes.h"
#include "statistics.h"
#include "tone_log.h"
#include "traced_light.h"

namespace vesper::commands {
namespace {

using apps::format;

constexpr unsigned kMostPathsOfPixel = 1u << 20;

// The file of one frame of several: %04d is replaced by its number, or the number is put before the extension.
std::string file_of_frame(const std::string& pattern, unsigned index, unsigned frames) {
    if (const auto name = apps::numbered_name("-o", pattern)) return name->at(index);
    if (frames == 1) return pattern;
    const size_t dot = pattern.rfind('.');
    return pattern.substr(0, dot) + format(".%04u", index) + pattern.substr(dot);
}

void write_outputs(const RenderArguments& arguments, const gpu::Device& device, const gpu_scene::View& view,
                   const render::Frame& frame, const vision::GlareReport& glare, unsigned index, double seconds) {
    for (const std::string& output : arguments.outputs) {
        const std::string file = file_of_frame(output, index, arguments.frames);
        if (output.ends_with(".png"))
            apps::write_codes(file, frame, arguments.settings.display,
                              apps::describe_codes(arguments.light.quality, arguments.settings));
        else
            io::write_exr(file, frame.extent.width, frame.extent.height, frame.scene,
                          describe_frame(arguments, device, view, frame, glare, seconds));
    }
}

bool is_png(const std::string& output) { return output.ends_with(".png"); }

// Of light that is traced. All reflections count there unless a number is given.
void check_paths(RenderArguments& a) {
    const apps::Command& command = a.tone.command;
    a.traces = a.paths > 0;
    if (a.traces && !a.settings.indirect) throw Error("--paths has no meaning with --indirect off");
    if (a.traces && a.settings.tone_operator == render::Operator::Ldr)
        throw Error("--paths has no meaning with the ldr operator, which shows the light of lamps alone");
    if (a.traces && a.settings.moving_reflections)
        throw Error("--moving-reflections has no meaning with --paths, which traces light of all lamps");
    if (a.traces && a.settings.samples > 1)
        throw Error("--samples has no meaning with --paths, which traces light for the middles of pixels");
    if (uint64_t{a.frames} * a.settings.samples > UINT32_MAX / 2)
        throw Error("--frames times --samples is more than 2,147,483,647");
    if (a.settings.display_average && (a.settings.samples == 1 || std::ranges::none_of(a.outputs, is_png)))
        throw Error("--display-average has a meaning only beside --samples of 2 and more, and -o OUT.png");
    a.tracing.paths = a.paths, a.tracing.lamp_rays = kLampRays;
    if (command.count("--reflections") > 0) a.tracing.most_reflections = a.settings.reflections;
    a.tracing.threshold = HUGE_VAL;  // light of lamps directly is the device's
}

// Everything that can be wrong with the arguments alone, and what follows from them.
void check_arguments(RenderArguments& arguments) {
    render::RenderSettings& settings = arguments.settings;
    static_cast<render::ToneChainSettings&>(settings) = apps::tone_settings(arguments.tone);
    apps::check_target(arguments.glare, settings);
    apps::apply_settings(arguments.light, settings);
    check_paths(arguments);
    io::announce_read(arguments.scene);
    io::announce_read(arguments.photometry);
    io::announce_read(arguments.replay_file);
    io::announce_read(arguments.eye_in);
    io::announce_read(arguments.glare.lamps);
    for (const std::string& output : arguments.outputs) {
        const bool exr = output.ends_with(".exr");
        if (!exr && !output.ends_with(".png")) throw Error("-o " + output + ": a .png or .exr file is expected");
        if (exr && settings.tone_operator == render::Operator::Ldr)
            throw Error("-o " + output + ": the ldr operator has no luminances to write; use .png");
    }
    if (apps::Ranks::several()) {
        if (settings.display_average) throw Error("--display-average is not made by several ranks");
        if (!arguments.obstacles.empty()) throw Error("--obstacle: obstacles are not measured by several ranks");
    }
    if (apps::Ranks::own_number() != 0) return;  // the first rank alone writes these
    io::announce_write("--stats-json", arguments.statistics_file);
    io::announce_write("--eye-out", arguments.eye_out);
    for (const auto& [option, file] :
         {std::pair("--log", arguments.log_file), std::pair("--glare-sources", arguments.sources_file)}) {
        io::announce_write(option, file);
        io::announce_write(option, io::GrowingFile::part_of(file));  // where it grows
    }
}

void check_wanted(const RenderArguments& a) {
    const bool files = !a.outputs.empty() || !a.log_file.empty() || !a.sources_file.empty() ||
                       !a.statistics_file.empty() || !a.eye_out.empty();
    if (!files && !a.statistics && !a.plan && a.glare.target.empty() && a.obstacles.empty())
        throw Error(
            "nothing to do: give -o, --stats, --stats-json, --log, --glare-sources, --eye-out, --target, --obstacle or "
            "--plan");
}

// A frame to render: its time, how long after the one before, and, in a replay, what the eye remembers.
struct FrameTime {
    double seconds = 0;
    float step = 0;
    std::optional<shared::EyeState> eye;
};

// What is logged goes on with the operator and the histogram of the log.
void check_log(const RenderArguments& arguments, const std::string& option, const std::string& file,
               std::span<const apps::LoggedFrame> log) {
    const auto fail = [&](const std::string& reason) { throw Error(option + " " + one_line(file) + ": " + reason); };
    const std::string wanted = apps::name_of(arguments.settings.tone_operator);
    const render::HistogramSettings& bins = arguments.settings.histogram;
    for (const apps::LoggedFrame& frame : log) {
        if (frame.tone_operator != wanted)
            fail("is of the operator " + one_line(frame.tone_operator, 40) + " and not of " + wanted);
        const shared::EyeState& eye = frame.eye;
        if (eye.steps == 0) continue;  // an operator without a curve
        const auto steps = float(bins.bins * bins.steps_per_bin()),
                   steps_per_ln = bins.bins_per_ln() * float(bins.steps_per_bin());
        if (eye.steps != steps || eye.ln_low != bins.ln_low() || eye.steps_per_ln != steps_per_ln)
            fail(
                format("has a curve of %.0f steps from %.4g to %.4g cd/m^2, which is not that of --bins, "
                       "--histogram-low and --histogram-high",
                       double(eye.steps), std::exp(double(eye.ln_low)),
                       std::exp(double(eye.ln_low) + double(eye.steps / eye.steps_per_ln))));
    }
}

std::vector<FrameTime> moments_of(const RenderArguments& arguments) {
    std::vector<FrameTime> moments;
    if (arguments.replay_file.empty()) {
        for (unsigned i = 0; i < arguments.frames; ++i)
            moments.push_back({arguments.start + i * arguments.dt, i == 0 ? 0.0f : float(arguments.dt), {}});
        if (arguments.eye_in.empty()) return moments;
        const std::vector<apps::LoggedFrame> log = apps::read_log(arguments.eye_in);
        check_log(arguments, "--eye-in", arguments.eye_in, std::span(log).last(1));
        moments.front().step = float(arguments.dt), moments.front().eye = log.back().eye;
        return moments;
    }
    const auto idle = [&](const char* option, const char* why) {
        if (arguments.tone.command.count(option))
            throw Error("--replay " + one_line(arguments.replay_file) + ": " + why + ": " + option +
                        " has no meaning beside it");
    };
    idle("--dt", "times are those of the log"), idle("--eye-in", "eyes are those of the log");
    const std::vector<apps::LoggedFrame> log = apps::read_log(arguments.replay_file);
    check_log(arguments, "--replay", arguments.replay_file, log);
    const unsigned frames = arguments.tone.command.count("--frames") ? arguments.frames : ~0u;
    for (size_t i = 0; i < log.size() && moments.size() < frames; ++i)
        if (log[i].seconds >= arguments.start)
            moments.push_back({log[i].seconds, log[i].step, i == 0 ? shared::EyeState{} : log[i - 1].eye});
    if (moments.empty()) throw Error(arguments.replay_file + ": no frame from --start on");
    return moments;
}

// Of all frames; where light is traced or pixels have samples also within a frame.
class FrameProgress {
public:
    explicit FrameProgress(const RenderArguments& a)
        : steps_(a.traces ? 100 : a.settings.samples * (a.settings.display_average ? 2 : 1)),
          bar_(a.traces ? "tracing light, " + std::to_string(a.paths) + " paths a pixel" : "rendering",
               a.frames * steps_) {}
    void at(unsigned frame, double share) { reach(frame * steps_ + unsigned(share * steps_)); }
    void sampled(unsigned frame, unsigned samples) { reach(frame * steps_ + samples); }

private:
    void reach(unsigned step) {
        for (; done_ < step; ++done_) bar_.step();
    }

    unsigned steps_, done_ = 0;
    apps::Progress bar_;
};

void run(RenderArguments& arguments) {
    const VkExtent2D extent = apps::parse_size(arguments.size);
    check_arguments(arguments);
    const apps::ScaledPicture scaled(extent, arguments.settings.scale);
    const bool wants_statistics = arguments.statistics || !arguments.statistics_file.empty();
    render::Outputs outputs{.display = wants_statistics, .scene = false};  // what is timed includes the display image
    for (const std::string& output : arguments.outputs)
        (output.ends_with(".png") ? outputs.display : outputs.scene) = true;

    arguments.settings.offscreen_lamps = apps::read_lamps(arguments.glare.lamps);
    // Glare is read off luminances.
    const bool ldr = arguments.settings.tone_operator == render::Operator::Ldr;
    const bool logs_glare = !arguments.log_file.empty() && !ldr;
    const bool wants_target = !arguments.glare.target.empty();
    outputs.scene |= logs_glare || wants_target;

    const std::vector<FrameTime> moments = moments_of(arguments);
    arguments.frames = unsigned(moments.size());
    for (const std::string& output : arguments.outputs)
        for (unsigned index = 0; index < arguments.frames; ++index)
            io::announce_write("-o", file_of_frame(output, index, arguments.frames));
    scene::PhotometryReport rules;
    scene::LoadedScene loaded = scene::read_lit_scene(arguments.scene, arguments.photometry, &rules);
    loaded.scene.name = arguments.scene;
    check_wanted(arguments);  // a scene that cannot be read is said first
    apps::print_notes(loaded.notes);
    apps::print_notes(rules.warnings, "warning: ");
    scaled.print_note();
    const scene::Scene& scene = loaded.scene;
    gpu_scene::SceneFrame moment{scene::world_transforms(scene, moments.front().seconds)};
    gpu_scene::camera_view(scene, moment, arguments.camera, extent);  // a wrong name is known before a device is opened
    std::vector<scene::Obstacle>& obstacles = arguments.settings.obstacles;
    obstacles = apps::obstacles_of(scene, arguments.obstacles, arguments.settings);
    const std::vector<std::string> cameras = gpu_scene::camera_names(scene);
    if (arguments.camera.empty() && !cameras.empty()) arguments.camera = cameras.front();

    apps::Ranks& ranks = apps::Ranks::all();
    gpu::Device device({.select = arguments.device});
    const std::shared_ptr<Cache> cache = apps::cache_of(arguments.cache);
    render::Renderer renderer(device, scene, cache);
    ranks.agree_on_start();
    if (arguments.settings.indirect && !arguments.traces && !ldr)  // which shows lamps alone
        ranks.in_turns([&] {
            renderer.set_radiosity(apps::gathered(scene, moment.world, scene::animated_nodes(scene), cache.get()));
        });
    if (arguments.settings.moving_reflections)
        renderer.set_lamp_reflections(
            std::make_shared<const transport::LampReflections>(scene, moment.world, scene::animated_nodes(scene)));
    FrameProgress progress(arguments);
    unsigned number = 0;  // of the frame
    if (!arguments.traces) renderer.watch_samples([&](uint32_t done) { progress.sampled(number, done); });
    std::vector<double> milliseconds;
    FrameFiles files;
    if (ranks.is_first())
        files.open(arguments.log_file, arguments.sources_file, arguments.eye_out, apps::obstacle_columns(obstacles));
    const auto take = [&](unsigned index, const apps::Bytes& rows) {
        files.add(rows);
        progress.at(index, 1);
    };
    apps::FrameRelay relay(device, ranks, arguments.frames);
    for (unsigned index = 0; index < arguments.frames; ++index) {
        if (!relay.has(index)) continue;
        const auto& [seconds, step, eye] = moments[index];
        number = index;
        moment.world = scene::world_transforms(scene, seconds);
        const gpu_scene::View view = scaled.rendered(gpu_scene::camera_view(scene, moment, arguments.camera, extent));
        const bool last = index + 1 == arguments.frames;
        if (arguments.traces)
            renderer.set_illuminance(
                other_light(traced_light(device, scene, renderer.scene(), moment, view, arguments.tracing,
                                         [&](double share) { progress.at(index, share); })));
        const render::Frame frame = relay.render(renderer, arguments.settings, view, moment, step,
                                                 {.display = outputs.display,
                                                  .scene = outputs.scene || (last && wants_statistics),
                                                  .projection = scaled.enlargement()},
                                                 index, {.eye = eye, .all_known = !arguments.replay_file.empty()});
        milliseconds.push_back(frame.milliseconds);
        apps::print_cache_note(frame.maps.note);
        if (const std::string note = apps::photometry_note(loaded, arguments.scene); index == 0 && !note.empty())
            apps::print_note(note);
        vision::GlareReport glare;
        if (outputs.scene && !ldr)
            glare =
                apps::glare_of(arguments.glare, arguments.settings, frame, gpu_scene::angles_of(view), frame.outside);
        write_outputs(arguments, device, view, frame, glare, index, seconds);
        FrameRows rows;
        if (!arguments.log_file.empty() || (last && !arguments.eye_out.empty()))
            rows.log =
                apps::summed_line(
                    apps::log_line(index, {seconds, step, apps::name_of(arguments.settings.tone_operator), frame.eye},
                                   frame.curve, arguments.settings.tone_operator, arguments.settings.display, glare) +
                    apps::obstacle_values(obstacles, frame.obstacles, arguments.settings)) +
                "\n";
        if (!arguments.sources_file.empty())
            rows.sources = apps::glare_sources_lines(index, scene, frame.glare_sources, arguments.settings.scatter.eye);
        if (last) rows.eye = rows.log;
        if (index == 0 && arguments.plan)
            apps::print_text(apps::settings_lines(recorded_of(arguments)) + renderer.plan());
        if (last) {
            if (wants_target) apps::print_text(apps::target_line(glare));
            apps::print_text(apps::obstacle_lines(obstacles, frame.obstacles, arguments.settings));
            if (arguments.statistics) print_statistics(arguments, device, renderer, frame, milliseconds);
            if (!arguments.statistics_file.empty())
                apps::write_text(arguments.statistics_file, statistics_json(arguments, frame) + "\n");
        }
        relay.deliver(index, rows.packed(), take);
    }
    relay.finish(take);
    files.complete();
}

}  // namespace

void add_render(apps::Command program) {
    apps::Command command =
        program.add_command("render", "Render a photometric scene to a display image or to luminance");
    const auto a = std::make_shared<RenderArguments>();
    command.add_option("scene", a->scene, "A .gltf or .glb, as vesper convert writes it").required();
    command.add_option("--photometry,-p", a->photometry,
                       "Makes an unconverted scene photometric in memory, as vesper convert does in a file");
    command.add_option("--output,-o", a->outputs,
                       "OUT.png: display image; OUT.exr: absolute cd/m^2; may be given twice");
    command.add_option("--camera,-c", a->camera, "Name of a camera of the scene (default: the first)");
    command.add_option("--size,-s", a->size, "WIDTHxHEIGHT, px").shows_default();
    command.add_option("--frames", a->frames, "How many frames; files are numbered")
        .check(apps::range(1u, 1000000u))
        .shows_default();
    command.add_option("--dt", a->dt, "Time between frames, s").check(apps::between(1e-6, 3600.0)).shows_default();
    command.help_group("Logs and replay");
    command.add_option("--log", a->log_file,
                       "Write the state of the eye, the tone curve and what glare hides of every frame to a CSV file");
    command.add_option("--glare-sources", a->sources_file,
                       "Write the lamps before the eye to a CSV file: direction in degrees, cd, lx at the eye and "
                       "veil, as if nothing stood between");
    command.add_option("--replay", a->replay_file,
                       "Take times and the state of the eye from such a log: the same frames to the last bit; --start "
                       "and --frames choose from them");
    command.add_option("--eye-in", a->eye_in,
                       "Go on with the eye that another run has left: a file of --eye-out, or the last row of a --log");
    command.add_option("--eye-out", a->eye_out, "Write the state of the eye after the last frame to a CSV file");
    command.add_option("--start", a->start, "Time of the first frame, s")
        .check(apps::between(0.0, 1e6))
        .shows_default();
    command.help_group();
    command.add_flag("--stats", a->statistics, "Print luminances and milliseconds of the last frame");
    command.help_group("Logs and replay");
    command.add_option("--stats-json", a->statistics_file, "Write the luminances of the last frame to a JSON file");
    command.add_flag("--plan", a->plan, "Print the plan of the frame: passes, barriers, memory");
    command.help_group();
    command.add_option("--device", a->device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    apps::add_thread_option(command, a->threads);
    command.help_group("Files");
    command.add_allow_outside();
    apps::add_cache_option(command, a->cache);
    command.help_group();
    apps::add_quality_option(command, a->light);
    apps::add_tone_options(command, a->tone);
    apps::add_glare_options(command, a->glare);
    command.help_group("Glare");
    apps::add_obstacle_option(command, a->obstacles);
    apps::add_setting_options(command, a->light, {});
    command.help_group("Light");
    command
        .add_option("--paths", a->paths,
                    "Traces indirect light for each pixel of each frame (slow), along so many paths of rays; noise, "
                    "with 16 some 45 % of that light, falls with their root")
        .check(apps::range(1u, kMostPathsOfPixel));
    command.help_group();
    command.footer(
        "Examples:\n  vesper render night.gltf --camera driver --stats -o night.png\n"
        "  vesper render night.gltf --camera driver --samples 64 -o night.exr\n"
        "  vesper render night.gltf --camera driver --size 640x400 --paths 64 -o exact.png\n"
        "  mkdir drive && vesper render night.gltf --camera driver --frames 300 --dt 0.0333 -o drive/%04d.png\n");
    command.callback_of_ranks([a, command] {
        apps::use_threads(a->threads);
        a->options = apps::options_of(command, {"--output", "--log", "--glare-sources", "--eye-out", "--stats",
                                                "--stats-json", "--plan", "--cache", "--threads"});
        run(*a);
    });
}

}  // namespace vesper::commands
