#include "drive.h"

#include <memory>

#include "arguments.h"
#include "base/error.h"
#include "picture_arguments.h"
#include "windowed.h"

namespace vesper {
namespace {

void check(DriveArguments& a) {
    if (a.scene.empty() && a.replay.empty()) a.scene = VESPER_DATA_DIR "/rivoli/rivoli.world.json";
    if (!a.scene.empty() && !a.replay.empty()) throw Error("--replay " + a.replay + ": the recording names its scene; none can be given beside it");
    if (!a.replay.empty() && (a.autopilot || !a.record.empty())) throw Error("--replay " + a.replay + ": --autopilot and --record have no meaning beside it");
    if (!a.scenario.empty() && a.run.empty()) throw Error("--storyboard " + a.scenario + ": of which run? give --scenario");
    if (!a.run.empty() && !a.replay.empty()) throw Error("--scenario " + a.run + ": the recording names its run");
    Files files;
    files.reads(a.run);
    files.reads(a.scenario);
    files.reads(a.scene);
    files.reads(a.replay);
    files.reads(a.channels);
    files.reads(a.controllers);
    files.writes("--record", a.record);
    files.writes("--log", a.log);
}

}  // namespace

DriveStart start_of(const DriveArguments& a, const std::optional<Drive>& replayed) {
    if (!replayed) return {.scene = a.scene, .run = a.run, .scenario = a.scenario, .seed = a.seed, .settings = a.settings};
    DriveStart start = replayed->start;
    for (const auto& [name, value] : a.settings) start.settings[name] = value;
    return start;
}

void add_drive(CLI::App& program) {
    const auto a = std::make_shared<DriveArguments>();
    program.add_option("scene", a->scene, "A world (.json, docs/simulator.md), roads (.xodr) or a photometric scene (.gltf, .glb); default: the street of data/rivoli");
    program.add_option("--scenario", a->run, "On roads (.xodr): a run that esmini recorded there (.csv of its dat2csv), as traffic with its lamps");
    program.add_option("--storyboard", a->scenario, "The scenario of that run (.xosc): sizes, lamps and traffic lights");
    program.add_flag("--headless", a->headless, "Without a window");
    program.add_flag("--autopilot", a->autopilot, "The car keeps to its lane and to the distance by itself");
    program.add_option("--seconds", a->seconds, "Headless: how long to drive, s")->check(between(0.0, 86400.0))->capture_default_str();
    program.add_option("--record", a->record, "Write the drive to a file that --replay takes");
    program.add_option("--replay", a->replay, "Drive a recording again: the same frames to the last bit on the same device");
    program.add_option("--video", a->video, "Headless: FILM.mp4 (by ffmpeg), or one file a frame: NAME.%05d.png, NAME.%05d.exr (cd/m^2)");
    program.add_option("--fps", a->fps, "Headless: frames a second (default: those that were recorded, or 30)")->check(between(1.0, 1000.0));
    program.add_option("--log", a->log, "Write one row per frame to a CSV file: pose, eye, luminances, glare, times");
    program.add_option("--probe", a->probes, "Headless: X,Y, parts of the picture from its top left: a column of luminance in the log; may be given several times");
    program.add_option("--size,-s", a->size, "WIDTHxHEIGHT of pictures, px")->capture_default_str();
    program.add_option("--channels", a->channels, "A file of views of the driver's eye, on screens side by side (docs/simulator.md)");
    program.add_option("--seed", a->seed, "Of everything that is drawn by lot")->capture_default_str();
    program.add_option("--device", a->device, "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    program.add_option("--window", a->window, "WIDTHxHEIGHT of the window, px")->capture_default_str();
    program.add_option("--fullscreen", a->full_screen, "Fill a monitor, counted from 0")->expected(0, 1)->default_str("0")->check(CLI::NonNegativeNumber);
    program.add_option("--vsync", a->vsync, "wait for the refresh; latest: the newest picture at each; off: at once")->check(CLI::IsMember({"wait", "latest", "off"}))->capture_default_str();
    program.add_option("--limit", a->limit, "Pictures a second at most (default: as many as there can be)")->check(between(1.0, 1000.0));
    program.add_option("--scaling", a->scaling, "Pictures of another size than the window: fit it, or repeat whole pixels")->check(CLI::IsMember({"fit", "whole"}))->capture_default_str();
    program.add_option("--controllers", a->controllers, "What axes and buttons of wheels and gamepads mean (docs/simulator.md)");
    DriveSettings::add_options(program);
    program.callback([a, &program] {
        a->settings = DriveSettings::given(program);
        check(*a);
        a->size_given = program.count("--size") > 0;
        if (a->headless)
            run_headless(*a);
        else
            run_windowed(*a);
    });
}

}  // namespace vesper
