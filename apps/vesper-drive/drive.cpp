#include "drive.h"

#include <memory>

#include "arguments.h"
#include "base/error.h"
#include "io/file_gate.h"
#include "own_data.h"
#include "picture_arguments.h"
#include "windowed.h"

namespace vesper::drive {
namespace {

// Options that say nothing where the others are as they are, and why.
void refuse_idle(const apps::Command& program, const DriveArguments& a) {
    const bool logs = !a.log.empty(), films = !a.video.empty(), replays = !a.replay.empty();
    const auto camera = a.settings.find("camera"), shadows = a.settings.find("shadows");
    struct Rule {
        bool here;
        std::vector<const char*> options;
        const char* why;
    };
    const Rule rules[]{
        {replays, {"scene"}, "the recording names its scene (--replay)"},
        {replays, {"--scenario", "--storyboard"}, "the recording names its run (--replay)"},
        {replays, {"--autopilot", "--seconds", "--seed"}, "a recording is driven as it was (--replay)"},
        {replays, {"--record"}, "a replay is not recorded"},
        {a.run.empty(), {"--storyboard"}, "of which run? give --scenario"},
        {!a.headless, {"--seconds", "--video", "--fps"}, "has a meaning only without a window (--headless)"},
        {a.headless,
         {"--window", "--fullscreen", "--vsync", "--limit", "--scaling", "--controllers"},
         "has a meaning only in a window, not with --headless"},
        {!a.channels.empty(), {"--size", "--fov"}, "channels have sizes and angles of their own (--channels)"},
        {!films && !logs, {"--fps"}, "of what? give --video or --log"},
        {!logs, {"--probe"}, "is a column of the log: give --log"},
        {a.headless && !replays && (camera == a.settings.end() || camera->second != "free"),
         {"--free"},
         "only that camera stands there: give --camera free"},
        {a.headless && !replays && shadows != a.settings.end() && shadows->second != "on",
         {"--shadow-budget", "--shadow-cache"},
         "of which shadows? --shadows is off"},
    };
    for (const Rule& rule : rules)
        for (const char* option : rule.options)
            if (rule.here && program.count(option)) throw Error(std::string(option) + ": " + rule.why);
}

void check(const apps::Command& program, DriveArguments& a) {
    refuse_idle(program, a);
    if (a.scene.empty() && a.replay.empty()) a.scene = (apps::own_data() / "rivoli/rivoli.world.json").string();
    for (const std::string& file : {a.run, a.scenario, a.scene, a.replay, a.channels, a.controllers})
        io::announce_read(file);
    for (const auto& [option, file] : growing_outputs(a)) io::announce_write(option, file);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> growing_outputs(const DriveArguments& a) {
    return {{"--record", a.record},
            {"--record", io::GrowingFile::part_of(a.record)},
            {"--log", a.log},
            {"--log", io::GrowingFile::part_of(a.log)}};
}

DriveStart start_of(const DriveArguments& a, const DriveStart& recorded) {
    if (a.replay.empty())
        return {.scene = a.scene, .run = a.run, .scenario = a.scenario, .seed = a.seed, .settings = a.settings};
    DriveStart start = recorded;
    for (const auto& [name, value] : a.settings) start.settings[name] = value;
    return start;
}

void add_drive(apps::Command program) {
    const auto a = std::make_shared<DriveArguments>();
    program.add_option(
        "scene", a->scene,
        "A world (.json), roads (.xodr) or a scene (.gltf, .glb)\n"
        "Worlds: docs/simulator.md; scenes as vesper convert writes them; default: the street of data/rivoli");
    program.help_group("Roads and traffic");
    program.add_option("--scenario", a->run,
                       "On roads (.xodr): a run that esmini recorded there (.csv of its dat2csv or CSV logger), as "
                       "traffic with its lamps");
    program.add_option("--storyboard", a->scenario,
                       "The scenario of that run (.xosc): sizes, lamps and traffic lights");
    program.help_group();
    program.add_flag("--headless", a->headless, "Without a window");
    program.add_flag("--autopilot", a->autopilot, "The car keeps to its lane and to the distance by itself");
    program.add_option("--seconds", a->seconds, "Headless: how long to drive, s")
        .check(apps::between(0.0, 86400.0))
        .shows_default();
    program.add_option("--record", a->record, "Write the drive to a file that --replay takes");
    program.add_option("--replay", a->replay,
                       "Drive a recording again\nThe same frames to the last bit on the same device");
    program.add_option("--video", a->video,
                       "Headless: FILM.mp4, NAME.%05d.png or NAME.%05d.exr (cd/m^2)\n"
                       "Films are made by ffmpeg; the others are one file a frame");
    program.help_group("Films and logs");
    program.add_option("--fps", a->fps, "Headless: frames a second (default: those that were recorded, or 30)")
        .check(apps::between(1.0, 1000.0));
    program.add_option("--log", a->log, "Write one row per frame to a CSV file: pose, eye, luminances, glare, times");
    program.add_option(
        "--probe", a->probes,
        "X,Y, parts of the picture from its top left: a column of luminance in the log; may be given several times");
    program.help_group();
    program
        .add_option("--size,-s", a->size,
                    "WIDTHxHEIGHT of pictures, px\nDefault: in a replay as recorded, in a window its size")
        .shows_default();
    program.help_group("Files");
    program.add_allow_outside();
    program.help_group("Window");
    program.add_option("--channels", a->channels,
                       "A file of views of the driver's eye, on screens side by side (docs/simulator.md)");
    program.help_group("Roads and traffic");
    program.add_option("--seed", a->seed, "Seed of random pedestrians and traffic").shows_default();
    program.help_group();
    program.add_option("--device", a->device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    program.help_group("Window");
    program.add_option("--window", a->window, "WIDTHxHEIGHT of the window, px").shows_default();
    program.add_option("--fullscreen", a->full_screen, "Fill a monitor, counted from 0")
        .values(0, 1)
        .shows_default("0")
        .check(apps::not_negative());
    program.add_option("--vsync", a->vsync, "wait for the refresh; latest: the newest picture at each; off: at once")
        .check(apps::one_of({"wait", "latest", "off"}))
        .shows_default();
    program.add_option("--limit", a->limit, "Pictures a second at most (default: as many as there can be)")
        .check(apps::between(1.0, 1000.0));
    program
        .add_option("--scaling", a->scaling, "Pictures of another size than the window: fit it, or repeat whole pixels")
        .check(apps::one_of({"fit", "whole"}))
        .shows_default();
    program.add_option("--controllers", a->controllers,
                       "What axes and buttons of wheels and gamepads mean (docs/simulator.md)");
    program.help_group();
    DriveSettings::add_options(program);
    program.footer(
        "Operator, eye, glare, display, camera, sun and lamps can change during a drive: F1 lists the keys.\n"
        "Examples:\n  vesper-drive                                    the street of data/rivoli, in a window\n"
        "  vesper-drive street.glb --autopilot             a scene of your own\n"
        "  vesper-drive --headless --autopilot --seconds 60 --record mine.json\n"
        "  vesper-drive --headless --replay mine.json --glare cie --age 60 --video mine.mp4\n");
    program.callback([a, program] {
        a->settings = DriveSettings::given(program);
        if (program.count("--shadow-cache")) a->shadow_cache = program.option("--shadow-cache").results().back();
        check(program, *a);
        a->size_given = program.count("--size") > 0;
        if (a->headless)
            run_headless(*a);
        else
            run_windowed(*a);
    });
}

}  // namespace vesper::drive
