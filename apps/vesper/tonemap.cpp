// `vesper tonemap`: HDR pictures and films to a display. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "arguments/glare_arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/thread_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "commands.h"
#include "io/file_gate.h"
#include "io/hdr_image.h"
#include "numbered_files.h"
#include "print.h"
#include "progress.h"
#include "render/tone_mapper.h"
#include "video.h"

namespace vesper::commands {
namespace {

using apps::format;
namespace fs = std::filesystem;

constexpr size_t kMaxPictures = 1000000;

struct TonemapArguments {
    std::vector<std::string> inputs, outputs;
    std::string device, layer;
    unsigned threads = 0;
    apps::ToneArguments tone;
    apps::GlareArguments glare;
    apps::ScaleArguments scale;
    double fps = 0, fov = 0;
    bool statistics = false;
    std::string options;  // as given
};

/// One picture to do.
struct Job {
    std::string input;
    std::vector<std::string> outputs;  ///< files; none for a film
    double seconds = 0;                ///< since the picture before
};

struct Plan {
    std::vector<Job> jobs;
    bool sequence = false;  ///< the eye remembers from each to the next
    double fps = 0;
    std::string film;  ///< empty: none
};

bool is_folder(const std::string& name) { return name.ends_with('/') || fs::is_directory(name); }

/// Where the pictures go that are told apart by their place in a list.
std::string output_of(const std::string& output, const std::string& input, unsigned number, bool single) {
    if (is_folder(output)) return (fs::path(output) / fs::path(input).stem()).string() + ".png";
    if (const auto name = apps::numbered_name("-o", output)) return name->at(number);
    if (!single)
        throw Error("-o " + one_line(output) + ": several pictures need a folder, a name with %04d in it, or a .mp4");
    return output;
}

void check_outputs(const Plan& plan) {
    for (const Job& job : plan.jobs) io::announce_read(job.input);
    io::announce_write("-o", plan.film);
    for (const Job& job : plan.jobs)
        for (const std::string& output : job.outputs) {
            if (!output.ends_with(".png") && !output.ends_with(".exr"))
                throw Error("-o " + one_line(output) + ": a .png, .exr or .mp4 file or a folder is expected");
            io::announce_write("-o", output);
        }
}

Plan plan_of(const TonemapArguments& arguments) {
    Plan plan;
    std::vector<apps::NumberedFile> files;
    for (const std::string& input : arguments.inputs) {
        if (const auto name = apps::numbered_name("input", input)) {
            if (arguments.inputs.size() > 1)
                throw Error(one_line(input) + ": a sequence stands alone, without other pictures");
            files = apps::numbered_files(*name);
            plan.sequence = true;
        } else {
            files.push_back({unsigned(files.size()), input});
        }
    }
    if (files.size() > kMaxPictures) throw Error("more than a million pictures");
    plan.sequence |= arguments.fps > 0;
    plan.fps = arguments.fps > 0 ? arguments.fps : 30;
    for (size_t i = 0; i < files.size(); ++i) {
        Job job{files[i].file, {}, 0};
        const unsigned missing = plan.sequence && i > 0 ? files[i].number - files[i - 1].number - 1 : 0;
        if (plan.sequence && i > 0) job.seconds = (missing + 1) / plan.fps;  // missing frames take their time
        if (missing > 0)
            apps::print_note(format("%u %s before %s", missing,
                                    missing == 1 ? "picture is missing" : "pictures are missing",
                                    files[i].file.c_str()));
        for (const std::string& output : arguments.outputs) {
            if (!output.ends_with(".mp4"))
                job.outputs.push_back(output_of(output, files[i].file, files[i].number, files.size() == 1));
            else if (i == 0 && !plan.film.empty())
                throw Error("-o " + one_line(output) + ": one film at a time");
            else
                plan.film = output;
        }
        plan.jobs.push_back(std::move(job));
    }
    if (!plan.film.empty() && !plan.sequence)
        throw Error("-o " + one_line(plan.film) + ": a film is made of a sequence: give frame.%04d.exr, or --fps");
    check_outputs(plan);
    return plan;
}

struct TonemappedPicture {
    render::ToneMapped picture;
    apps::PictureMeaning meaning;
    vision::GlareReport glare;
};

/// `held`: see PictureRequest.
TonemappedPicture show(const TonemapArguments& arguments, const render::ToneChainSettings& settings,
                       const std::vector<eye::OffscreenLamp>& lamps, render::ToneMapper& mapper, const Job& job,
                       bool wants_codes, double held) {
    const io::HdrImage image = io::read_hdr_image(job.input, {}, arguments.layer);
    TonemappedPicture shown;
    shown.meaning = apps::meaning_of(
        image, {.scale = arguments.scale,
                .fov = arguments.fov,
                .angle_matters = settings.glare == render::Glare::Scatter || !arguments.glare.target.empty(),
                .to_white = settings.tone_operator == render::Operator::Ldr,
                .held = held});
    render::Outputs outputs{.display = wants_codes, .scene = false, .display_light = false};
    for (const std::string& output : job.outputs)
        (output.ends_with(".png") ? outputs.display : outputs.display_light) = true;
    const double vertical = shown.meaning.fov * std::numbers::pi / 180;
    const bool asks_glare = settings.tone_operator != render::Operator::Ldr &&
                            (outputs.display_light || arguments.statistics || !arguments.glare.target.empty());
    outputs.scene = asks_glare;
    try {
        shown.picture = mapper.map(settings,
                                   {.extent = {image.width, image.height},
                                    .values = image.rgb,
                                    .channels = 3,
                                    .scale = float(shown.meaning.scale),
                                    .vertical_fov = vertical,
                                    .outside = lamps},
                                   float(job.seconds), outputs);
        if (asks_glare)
            shown.glare = apps::glare_of(
                arguments.glare, settings, shown.picture,
                gpu_scene::angles_of(gpu_scene::View::symmetric(shown.picture.extent, float(vertical), glm::mat4(1))),
                lamps);
    } catch (const Error& error) {
        throw Error(one_line(job.input) + ": " + error.what());
    }
    return shown;
}

void write_outputs(const TonemapArguments& arguments, const render::ToneChainSettings& settings,
                   const gpu::Device& device, const Job& job, const TonemappedPicture& shown) {
    const render::ToneMapped& picture = shown.picture;
    const io::Header scale{{"vesper:sourceScale", apps::digits(shown.meaning.scale)},
                           {"vesper:sourceScaleFrom", shown.meaning.scale_source},
                           {"vesper:exposure", apps::digits(arguments.scale.exposure)}};
    const bool own_scale = shown.meaning.scale_source == "header" && arguments.scale.exposure == 0;
    for (const std::string& output : job.outputs) {
        if (output.ends_with(".png")) {
            // PNGs have no other provenance: shown at the file's own scale, a frame has the bytes that `vesper render`
            // writes.
            apps::write_codes(output, picture, settings.display, own_scale ? io::Header() : scale);
            continue;
        }
        io::Header header{{"vesper:version", VESPER_VERSION},
                          {"vesper:source", one_line(job.input)},
                          {"vesper:options", arguments.options},
                          {"vesper:unit", "cd/m^2 on the display, linear Rec. 709 RGB"},
                          {"vesper:device", device.name() + ", " + device.driver()}};
        header.insert(header.end(), scale.begin(), scale.end());
        const io::Header tone = apps::describe_tone(settings, picture);
        header.insert(header.end(), tone.begin(), tone.end());
        const io::Header dazzled = apps::describe_glare(shown.glare);
        header.insert(header.end(), dazzled.begin(), dazzled.end());
        io::write_exr(output, picture.extent.width, picture.extent.height, picture.display_light, header);
    }
}

/// Says once what holds for many pictures, for each what holds for it alone, and in a sequence where its unit changes.
class Notes {
public:
    void tell(const Job& job, const apps::PictureMeaning& meaning, bool sequence) {
        const std::string name = one_line(job.input);
        for (const std::string& note : meaning.notes)
            if (told_.insert(note).second) tell(name, note);
        if (!meaning.scale_note.empty()) tell(name, meaning.scale_note);
        if (!sequence || meaning.unit == 0) return;
        if (unit_ > 0 && meaning.unit != unit_)
            tell(name, format("1.0 is %.6g cd/m^2 from here on, and was %.6g", meaning.unit, unit_));
        else if (source_ == "header" && meaning.scale_source == "sequence")
            tell(name, format("its header names no unit: 1.0 stays %.6g cd/m^2", unit_));
        unit_ = meaning.unit, source_ = meaning.scale_source;
    }

private:
    static void tell(const std::string& name, const std::string& note) { apps::print_note(name + ": " + note); }

    std::set<std::string> told_;
    double unit_ = 0;     // of the last picture that had one
    std::string source_;  // of that unit
};

void report(const TonemapArguments& arguments, const Job& job, const TonemappedPicture& shown) {
    const render::ToneMapped& p = shown.picture;
    if (p.histogram.non_finite > 0)
        apps::print_note(format("%s: %u of %u pixels are not finite and shown black", job.input.c_str(),
                                p.histogram.non_finite, p.histogram.finite + p.histogram.non_finite));
    if (!arguments.glare.target.empty()) apps::print_text(one_line(job.input) + ": " + apps::target_line(shown.glare));
    if (!arguments.statistics) return;
    double device = 0;
    for (const graph::Timing& timing : p.timings) device += timing.milliseconds;
    apps::print(
        "%s: %u x %u px, %.4g cd/m^2 per unit, adaptation %.4g cd/m^2, maximum %.4g cd/m^2, foveal level %u (%.3g "
        "degrees), %.1f ms (device %.1f)\n",
        one_line(job.input).c_str(), p.extent.width, p.extent.height, shown.meaning.scale, double(p.curve.adaptation),
        double(p.curve.maximum), p.foveal_level, shown.meaning.fov, p.milliseconds, device);
    apps::print("  veil %.4g cd/m^2, threshold increment %.3g %%, background %.4g cd/m^2\n", shown.glare.veil,
                shown.glare.increment, shown.glare.background);
    if (p.pupil > 0)
        apps::print("  pupil %.2f mm, its needles and halo made on the host in %.1f ms\n", p.pupil,
                    p.pattern_milliseconds);
    for (const graph::Timing& timing : p.timings)
        apps::print("  %-24s %8.3f\n", timing.pass.c_str(), timing.milliseconds);
}

void run(const TonemapArguments& arguments) {
    const render::ToneChainSettings settings = apps::tone_settings(arguments.tone);
    apps::check_target(arguments.glare, settings);
    const Plan plan = plan_of(arguments);
    const std::vector<eye::OffscreenLamp> lamps = apps::read_lamps(arguments.glare.lamps);
    for (const std::string& output : arguments.outputs)
        if (output.ends_with('/') && !fs::is_directory(output))
            throw Error("-o " + one_line(output) + ": there is no such folder");

    gpu::Device device({.select = arguments.device});
    render::ToneMapper mapper(device);
    std::unique_ptr<apps::Video> film;
    apps::Progress progress("tone mapping", unsigned(plan.jobs.size()));
    size_t failed = 0;
    Notes notes;
    double held = 0;  // cd/m^2 of 1.0, of the first picture of a sequence that has a unit or light
    for (const Job& job : plan.jobs) {
        if (!plan.sequence) mapper.reset_adaptation();
        try {
            const TonemappedPicture shown = show(arguments, settings, lamps, mapper, job, !plan.film.empty(), held);
            const auto [width, height] = shown.picture.extent;
            if (!plan.film.empty() && !film)
                film = std::make_unique<apps::Video>(plan.film, width, height, plan.fps, settings.display);
            write_outputs(arguments, settings, device, job, shown);
            if (film) film->add(shown.picture.display);
            notes.tell(job, shown.meaning, plan.sequence);
            if (plan.sequence && held == 0) held = shown.meaning.unit;
            report(arguments, job, shown);
        } catch (const Error& error) {
            // Pictures that have nothing to do with each other do not wait for one that is damaged.
            if (plan.sequence || plan.jobs.size() == 1) throw;
            apps::print_error("vesper", error.what());
            ++failed;
        }
        progress.step();
    }
    if (film) film->finish();
    if (failed > 0)
        throw Error(std::to_string(failed) + " of " + std::to_string(plan.jobs.size()) +
                    " pictures could not be shown");
}

}  // namespace

void add_tonemap(apps::Command program) {
    apps::Command command =
        program.add_command("tonemap", "Show HDR pictures and films on a display (docs/tonemap.md)");
    const auto a = std::make_shared<TonemapArguments>();
    command.add_option("pictures", a->inputs, "OpenEXR or Radiance pictures, or frame.%04d.exr for a sequence")
        .required();
    command
        .add_option("--output,-o", a->outputs,
                    "OUT.png: codes; OUT.exr: cd/m^2 on the display; OUT.mp4; or a folder\n"
                    "A folder or %04d for several; may be given more than once")
        .required();
    command.add_option("--layer", a->layer, apps::kLayerHelp);
    apps::add_scale_options(command, a->scale);
    command
        .add_option("--fps", a->fps,
                    "Pictures are a sequence of so many per second: the eye adapts from each to the next (default for "
                    "frame.%04d.exr: 30)")
        .check(apps::between(0.001, 10000.0));
    command
        .add_option("--fov", a->fov,
                    "Angle the picture covers in height, degrees\n"
                    "Default: what the picture says, if Vesper or Radiance made it, or 40")
        .check(apps::between(0.1, 170.0));
    command.add_flag("--stats", a->statistics, "Print adaptation, glare and milliseconds of each picture");
    command.add_option("--device", a->device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    apps::add_thread_option(command, a->threads);
    apps::add_tone_options(command, a->tone);
    apps::add_glare_options(command, a->glare);
    command.footer(
        "Examples:\n  vesper tonemap night.exr --display projector -o night.png\n"
        "  vesper tonemap *.hdr --exposure 1 --operator reinhard -o shown/\n"
        "  vesper tonemap drive.%04d.exr --fps 60 --fov 35 -o drive.mp4\n"
        "  vesper tonemap night.exr --display hdr10 -o night-pq.png -o night-on-display.exr\n");
    command.callback([a, command] {
        apps::use_threads(a->threads);
        a->options = apps::options_of(command, {"--output", "--stats", "--threads"});
        run(*a);
    });
}

}  // namespace vesper::commands
