#include "bench.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "arguments/arguments.h"
#include "arguments/cache_arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/setting_arguments.h"
#include "arguments/thread_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "base/parallel.h"
#include "io/file_gate.h"
#include "machine.h"
#include "measure.h"
#include "print.h"
#include "progress.h"
#include "scene/scene.h"
#include "scenes.h"
#include "start.h"

namespace vesper::bench {
namespace {

struct BenchArguments {
    std::vector<std::string> scenes{"rivoli"}, sizes{"1680x1050"}, luminaires, operators, glares;
    std::vector<uint32_t> lamps{kOwnLamps}, channels{1};
    uint32_t triangles = 10000, threads = 0;
    RunPlan run{.settings = {.frames = 48, .laps = 3, .warm_up = 4}, .render = {}, .camera = {}, .device = {}};
    apps::ToneArguments tone;
    apps::SettingArguments light;
    std::string cache, json, picture, growth, tables;
    std::vector<std::string> compared;
    bool no_start = false;
    apps::Command command;
};

/// One run of those that the arguments ask for.
struct Planned {
    RunPlan plan;
    std::string scene, luminaire;
    uint32_t lamps;
};

void take_defaults_of_matrix(BenchArguments& a) {
    const auto unless_given = [&](const char* option, auto& values, auto defaults) {
        if (!a.command.count(option)) values = std::move(defaults);
    };
    unless_given("--scene", a.scenes, std::vector<std::string>{"street"});
    unless_given("--lamps", a.lamps, std::vector<uint32_t>{64, 256, 1024, 4096});
    unless_given("--size", a.sizes, std::vector<std::string>{"640x400", "1120x700", "1680x1050"});
    unless_given("--operator", a.operators, std::vector<std::string>{"ward", "reinhard"});
}

/// Of a file, its name without folders.
std::string short_name(const std::string& name) {
    return name.find('/') == name.npos ? name : std::filesystem::path(name).filename().string();
}

/// Empty: the scene's own lamps.
std::vector<std::string> luminaires_of(const BenchArguments& a, const std::string& scene) {
    return is_generated(scene) && !a.luminaires.empty() ? a.luminaires : std::vector<std::string>{""};
}

/// Every combination of what was listed.
std::vector<Planned> planned_runs(const BenchArguments& a) {
    std::vector<Planned> runs;
    apps::ToneArguments tone = a.tone;
    const std::vector<std::string> operators =
        a.operators.empty() ? std::vector{apps::text_of("operator", tone.own)} : a.operators;
    const std::vector<std::string> glares = a.glares.empty() ? std::vector{apps::text_of("glare", tone.own)} : a.glares;
    const auto plan = [&](Planned run, const std::string& size, uint32_t channels, const std::string& glare,
                          const std::string& op) {
        tone.instead = {{"operator", op}, {"glare", glare}};
        static_cast<render::ToneChainSettings&>(run.plan.render) = apps::tone_settings(tone);
        RunSettings& s = run.plan.settings;
        s.scene = short_name(run.scene) + (run.luminaire.empty() ? "" : "(" + run.luminaire + ")");
        s.tone_operator = apps::name_of(run.plan.render.tone_operator), s.glare = glare, s.channels = channels;
        s.width = apps::parse_size(size).width, s.height = apps::parse_size(size).height;
        apps::apply_settings(a.light, run.plan.render);
        if (channels > 1 && run.plan.render.scale < 1)
            throw Error("--scale: channels have sizes of their own (--channels)");
        s.light = apps::recorded_settings(a.light.quality, run.plan.render);
        if (!a.cache.empty()) run.plan.map_cache = apps::cache_of(a.cache);
        runs.push_back(std::move(run));
    };
    for (const std::string& scene : a.scenes)
        for (const std::string& luminaire : luminaires_of(a, scene))
            for (const uint32_t lamps : a.lamps)
                for (const std::string& size : a.sizes)
                    for (const uint32_t channels : a.channels)
                        for (const std::string& glare : glares)
                            for (const std::string& op : operators)
                                plan({a.run, scene, luminaire, lamps}, size, channels, glare, op);
    return runs;
}

void check_files(const BenchArguments& a) {
    for (const std::string& scene : a.scenes)
        if (!is_generated(scene)) io::announce_read(scene);
    for (const std::string& luminaire : a.luminaires)
        if (luminaire != "point" && luminaire != "none") io::announce_read(luminaire);
    if (!a.luminaires.empty() && std::ranges::none_of(a.scenes, is_generated))
        throw Error("--luminaire: lamps of --scene street and town alone can be exchanged");
    if (!a.growth.empty() && !std::filesystem::is_directory(a.growth)) {
        io::announce_write("--matrix", a.growth);
        std::error_code failed;
        if (!std::filesystem::create_directory(a.growth, failed))
            throw Error("--matrix " + one_line(a.growth) + ": cannot be made a folder");
    }
    io::announce_write("--json", a.json);
    io::announce_write("--picture", a.picture);
    if (!a.picture.empty() && !a.picture.ends_with(".png"))
        throw Error("--picture " + one_line(a.picture) + ": a .png file is expected");
}

std::string command_line(const BenchArguments& a) {
    std::string text;
    for (const apps::Option& option : a.command.options())
        if (option.count())
            for (const std::string& value : option.results())
                text += (text.empty() ? "" : " ") + option.name() + "=" + value;
    return text;
}

BenchResult machine_of(const BenchArguments& a) {
    const gpu::Device device({.select = a.run.device});
    return {.version = VESPER_VERSION,
            .command = command_line(a),
            .device = device.name(),
            .driver = device.driver(),
            .host = processor_name(),
            .threads = parallel_threads(),
            .cpu = device.is_cpu(),
            .copy_bandwidth = copy_bandwidth(device),
            .runs = {}};
}

void run(BenchArguments& a) {
    if (!a.growth.empty()) {
        take_defaults_of_matrix(a);
        while (a.growth.size() > 1 && a.growth.ends_with('/')) a.growth.pop_back();
    }
    check_files(a);
    const std::vector<Planned> planned = planned_runs(a);
    Scenes scenes;
    for (const std::string& scene : a.scenes) scenes.prepare(scene);
    const auto load = [&](size_t i) {
        return scenes.load(planned[i].scene, planned[i].lamps, a.triangles, planned[i].luminaire, a.run.camera);
    };

    // Starts come before this process opens a device.
    std::vector<Start> starts;
    if (planned.size() == 1 && !a.no_start)
        starts = time_starts(scenes.folder("shaders"), [&](const auto& shown) {
            RunPlan plan = planned[0].plan;
            if (a.cache.empty()) plan.map_cache = apps::cache_of(scenes.folder("shadows"));
            first_frame(plan, load(0), shown);
        });

    BenchResult result = machine_of(a);
    const auto title = [&](const RunResult& measured) {
        return headline(result, measured) + (planned.size() > 1 ? measured.settings.details() : "");
    };
    render::Frame last;
    for (size_t i = 0; i < planned.size(); ++i) {
        const RunSettings& s = planned[i].plan.settings;
        RunResult measured;
        {
            apps::Progress progress(s.title(), s.frames * s.laps);
            measured = measure(
                planned[i].plan, load(i), [&] { progress.step(); }, &last);
        }
        measured.starts = starts;
        result.runs.push_back(std::move(measured));
        if (!a.json.empty()) apps::write_text(a.json, json_of(result));  // kept should a later run fail
        apps::print_text(title(result.runs.back()) + "\n");
        std::fflush(stdout);
    }
    for (const RunResult& measured : result.runs)
        apps::print_text("\n" + (planned.size() > 1 ? title(measured) + "\n" : "") + text_of(result, measured));
    if (!a.picture.empty())
        apps::write_codes(a.picture, last, planned.back().plan.render.display,
                          apps::describe_settings(planned.back().plan.settings.light));
    if (!a.growth.empty())
        for (const std::string& file : save_growth(a.growth, result)) apps::print("%s\n", file.c_str());
}

void work(BenchArguments& a) {
    if (!a.compared.empty())
        apps::print_text(comparison(read_result(a.compared.at(0)), read_result(a.compared.at(1))));
    else if (!a.tables.empty())
        apps::print_text(markdown_of(read_result(a.tables)));
    else
        run(a);
}

}  // namespace

void add_bench(apps::Command program) {
    const auto a = std::make_shared<BenchArguments>();
    RunSettings& s = a->run.settings;
    a->command = program;
    program
        .add_option(
            "--scene", a->scenes,
            "rivoli: the night street; rivoli-measured: with measured lamps and road; street, town: generated; or "
            "a .gltf or .glb")
        .separated_by(',')
        .shows_default();
    program.add_option("--camera,-c", a->run.camera, "Name of a camera of the scene (default: the first)");
    program.add_option("--size,-s", a->sizes, "WIDTHxHEIGHT of a channel, px").separated_by(',').shows_default();
    program
        .add_option("--lamps", a->lamps,
                    "Of generated scenes: how many (default: street 256, town 4096); of others: those nearest the "
                    "camera at the start "
                    "(default: all)")
        .separated_by(',')
        .check(apps::range(0u, scene::kMaxLamps));
    program
        .add_option("--luminaire", a->luminaires,
                    "Of generated scenes, in place of their spots of 1,500 cd: point (1,500 cd), none, or a file of a "
                    "distribution (.ies, .ldt, .csv, .exr), scaled to the flux that the point sends down")
        .separated_by(',');
    program.add_option("--triangles", a->triangles, "Of generated scenes: at least so many")
        .check(apps::range(0u, 100'000'000u))
        .shows_default();
    program.add_option("--channels", a->channels, "Views in every frame, side by side")
        .separated_by(',')
        .check(apps::range(1u, 16u))
        .shows_default();
    program.add_option("--frames", s.frames, "Of a lap: the path of the scene's camera in equal steps")
        .check(apps::range(1u, 100000u))
        .shows_default();
    program.add_option("--laps", s.laps, "How often the path is driven").check(apps::range(1u, 1000u)).shows_default();
    program.add_option("--warm-up", s.warm_up, "Frames from all along the path before the first lap, not counted")
        .check(apps::range(0u, 10000u))
        .shows_default();
    apps::add_cache_option(program, a->cache, "off; one that is empty at first for the timing of starts");
    apps::add_quality_option(program, a->light);
    a->light.own.set("indirect", 0);
    apps::add_setting_options(program, a->light, {"display_average"});
    program.add_option("--device", a->run.device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    apps::add_thread_option(program, a->threads);
    apps::Option json = program.add_option("--json", a->json, "Write everything that was measured to a file");
    apps::Option picture = program.add_option("--picture", a->picture, "Write the last frame to a .png file");
    program.add_flag("--no-start", a->no_start,
                     "Do not time starts with cold and warm caches of shaders and shadow maps");
    apps::Option matrix = program.add_option("--matrix", a->growth,
                                             "Drive the street with 64 to 4096 lamps at several sizes with several "
                                             "operators, and draw how time grows into a folder");
    apps::Option compare =
        program.add_option("--compare", a->compared, "A.json B.json: print what B takes relative to A")
            .values(2)
            .excludes(matrix)
            .excludes(json)
            .excludes(picture);
    program.add_option("--tables", a->tables, "FILE.json: print what was measured as tables of Markdown")
        .excludes(matrix)
        .excludes(compare)
        .excludes(json)
        .excludes(picture);
    apps::add_tone_options(program, a->tone);
    program.option("--operator").takes_list(a->operators);
    program.option("--glare").takes_list(a->glares);
    program.footer(
        "Lists (scenes, sizes, lamps, luminaires, channels, operators, glare) are separated by commas; every "
        "combination is a run.\n"
        "Examples:\n  vesper-bench --json now.json\n"
        "  vesper-bench --compare before.json now.json\n"
        "  vesper-bench --scene street --lamps 1024 --operator ward,reinhard --size 1680x1050,2560x1600\n"
        "  vesper-bench --matrix out/growth --json out/growth/growth.json\n");
    program.callback([a] {
        apps::use_threads(a->threads);
        work(*a);
    });
}

}  // namespace vesper::bench
