#include "run/drive.h"

#include <cmath>
#include <cstdlib>
#include <memory>

#include "arguments/arguments.h"
#include "arguments/cache_arguments.h"
#include "arguments/obstacle_arguments.h"
#include "arguments/picture_arguments.h"
#include "arguments/setting_arguments.h"
#include "arguments/thread_arguments.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "osi/receiver.h"
#include "own_data.h"
#include "ranks/ranks.h"

namespace vesper::drive {
namespace {

// X,Y,Z,YAW.
glm::dvec4 origin_of(const std::string& text) {
    glm::dvec4 origin(0);
    const char* at = text.c_str();
    for (int i = 0; i < 4; ++i) {
        char* end = nullptr;
        origin[i] = std::strtod(at, &end);
        if (end == at || *end != (i < 3 ? ',' : '\0') || !(std::abs(origin[i]) < 1e9))
            throw Error("--osi-origin " + one_line(text) + ": X,Y,Z,YAW are expected, m and degrees");
        at = end + 1;
    }
    origin.w *= kRadiansPerDegree;
    return origin;
}

// Options that say nothing where the others are as they are, and why.
void refuse_idle(const apps::Command& program, const DriveArguments& a) {
    const bool logs = !a.log.empty(), films = !a.video.empty(), replays = !a.replay.empty();
    const auto camera = a.settings.find("camera");
    struct Rule {
        bool here;
        std::vector<const char*> options;
        const char* why;
    };
    const Rule rules[]{
        {replays, {"scene"}, "the recording names its scene (--replay)"},
        {replays,
         {"--scenario", "--osi", "--osi-udp", "--osi-delay", "--osi-wait", "--osi-origin", "--models", "--host"},
         "the recording has its messages (--replay)"},
        {replays, {"--autopilot", "--seconds", "--seed"}, "a recording is driven as it was (--replay)"},
        {replays, {"--record"}, "a replay is not recorded"},
        {!a.messages.any(), {"--models", "--host", "--osi-origin"}, "of what? give --osi, --osi-udp or --scenario"},
        {a.trace.empty() && !a.messages.live, {"--osi-z"}, "of what? give --osi or --osi-udp"},
        {!a.messages.live, {"--osi-delay", "--osi-wait"}, "of what? give --osi-udp"},
        {!a.headless,
         {"--osi-wait", "--seconds", "--video", "--fps"},
         "has a meaning only without a window (--headless)"},
        {a.headless,
         {"--window", "--fullscreen", "--vsync", "--limit", "--scaling", "--controllers"},
         "has a meaning only in a window, not with --headless"},
        {a.channels.empty(), {"--latency"}, "of which channels? give --channels"},
        {!a.channels.empty(),
         {"--size", "--scale", "--fov"},
         "channels have sizes and angles of their own (--channels)"},
        {!films && !logs && a.obstacles.empty(), {"--fps"}, "of what? give --video, --log or --obstacle"},
        {!logs, {"--probe"}, "is a column of the log: give --log"},
        {a.obstacles.empty(), {"--visible-from", "--detection-plot", "--hatch-unseen"}, "of what? give --obstacle"},
        {!a.headless, {"--detection-plot"}, "has a meaning only without a window (--headless)"},
        {!a.channels.empty(), {"--obstacle"}, "obstacles are measured in one picture, not in channels (--channels)"},
        {apps::Ranks::several(), {"--obstacle"}, "is not measured by several ranks"},
        {a.headless && !replays && (camera == a.settings.end() || camera->second != "free"),
         {"--free"},
         "only that camera stands there: give --camera free"},
    };
    for (const Rule& rule : rules)
        for (const char* option : rule.options)
            if (rule.here && program.count(option)) throw Error(std::string(option) + ": " + rule.why);
}

void take_messages(const apps::Command& program, DriveArguments& a) {
    for (const char* option : {"--osi", "--scenario", "--models", "--osi-udp", "--osi-out", "--host"})
        if (program.count(option) && program.option(option).results().back().empty())
            throw Error(std::string(option) + ": is empty");
    if (!a.osi_udp.empty() && !(a.trace.empty() && a.table.empty()))
        throw Error("--osi-udp: messages come from one source; there is " + (a.trace.empty() ? a.table : a.trace));
    const std::string file = a.trace.empty() ? a.table : a.trace;
    const char *option = a.trace.empty() ? "--scenario " : "--osi ", *ending = a.trace.empty() ? ".csv" : ".osi";
    if (!file.empty() && !file.ends_with(ending) && !a.trace.ends_with(".mcap"))
        throw Error(option + one_line(file) + ": a file " + ending + " is expected");
    if (!a.osi_udp.empty()) osi::parse_address(a.osi_udp);
    a.messages.file = file, a.messages.models = a.models, a.messages.live = !a.osi_udp.empty();
    try {
        a.messages.host = host_of(a.messages.host);
    } catch (const Error& error) {
        throw Error("--host " + std::string(error.what()));
    }
    if (!a.origin.empty()) a.messages.origin = origin_of(a.origin);
    a.messages.heights = height_reading_of(a.osi_z);
}

void check(const apps::Command& program, DriveArguments& a) {
    refuse_idle(program, a);
    if (a.scene.empty() && a.replay.empty()) a.scene = (apps::own_data() / "rivoli/rivoli.world.json").string();
    for (const std::string& file :
         {a.messages.file.string(), a.messages.models.string(), a.scene, a.replay, a.channels, a.controllers})
        io::announce_read(file);
    if (apps::Ranks::own_number() != 0) return;  // the first rank alone writes
    if (!a.detection_plot.empty() && !a.detection_plot.ends_with(".png"))
        throw Error("--detection-plot " + one_line(a.detection_plot) + ": .png is expected");
    io::announce_write("--detection-plot", a.detection_plot);
    for (const auto& [option, file] : growing_outputs(a)) {
        io::announce_write(option, file);
        std::error_code failed;
        if (std::filesystem::is_directory(file, failed)) throw Error(option + " " + one_line(file) + ": is a folder");
    }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> growing_outputs(const DriveArguments& a) {
    std::vector<std::pair<std::string, std::string>> files{
        {"--record", a.record}, {"--log", a.log}, {"--osi-out", a.osi_out}};
    if (a.messages.live && !a.record.empty()) files.emplace_back("--record", messages_of(a.record).string());
    for (size_t i = 0, whole = files.size(); i < whole; ++i)
        files.emplace_back(files[i].first, io::GrowingFile::part_of(files[i].second));
    return files;
}

DriveStart start_of(const DriveArguments& a, const DriveStart& recorded) {
    const render::Quality quality = a.headless ? render::Quality::Standard : render::Quality::Interactive;
    if (a.replay.empty())
        return {.scene = a.scene, .messages = a.messages, .seed = a.seed, .settings = a.settings, .quality = quality};
    DriveStart start = recorded;
    start.quality = quality;
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
    const apps::Option table =
        program.add_option("--scenario", a->table,
                           "A run that esmini recorded (.csv of its dat2csv or CSV logger), as traffic with its lamps");
    apps::Option trace = program.add_option(
        "--osi", a->trace, "An OSI trace of another simulator (.osi): what moves, lamps, traffic lights, sun");
    program.add_option("--osi-udp", a->osi_udp,
                       "[ADDRESS:]PORT, such as 48198: the same as it is sent, by esmini or others (docs/osi.md)");
    trace.excludes(table);
    program.add_option("--osi-delay", a->osi_delay, "How far what is shown is behind what is sent, s")
        .check(apps::between(0.0, 10.0))
        .shows_default();
    program.add_option("--osi-wait", a->osi_wait, "Headless: how long to wait for the first message, s")
        .check(apps::between(0.1, 86400.0))
        .shows_default();
    program.add_option("--osi-origin", a->origin,
                       "X,Y,Z,YAW: where the origin of the messages is on the roads, m and degrees");
    program
        .add_option("--osi-z", a->osi_z,
                    "Height of objects' places: middle of their boxes, ground below them, or auto: as the ground tells")
        .check(apps::one_of(std::vector<std::string>(kHeightReadings.begin(), kHeightReadings.end())))
        .shows_default();
    program.add_option("--models", a->models, "Which meshes and lamps the objects have (.json; default: boxes)");
    program.add_option("--host", a->messages.host,
                       "id of the object that one drives in, or none (default: as the messages say)");
    program.add_option("--osi-out", a->osi_out, "Write the drive as an OSI trace");
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
    program.help_group("Obstacles");
    apps::add_obstacle_option(program, a->obstacles);
    program.add_option("--visible-from", a->visible_from, "Visibility level from which an obstacle is seen")
        .check(apps::between(0.01, 1000.0))
        .shows_default();
    program.add_option("--detection-plot", a->detection_plot,
                       "Headless: FILE.png, levels of the obstacles over their distance");
    program.add_flag("--hatch-unseen", a->hatches,
                     "Draw stripes over obstacles of a lower level, in windows (key U), films and .png files");
    program.help_group();
    program
        .add_option("--size,-s", a->size,
                    "WIDTHxHEIGHT of pictures, px\nDefault: in a replay as recorded, in a window its size")
        .shows_default();
    program.help_group("Speed");
    apps::add_setting_option(program, "scale", a->scale);
    apps::add_thread_option(program, a->threads);
    program.help_group("Files");
    program.add_allow_outside();
    apps::add_cache_option(program, a->cache);
    program.help_group("Window");
    program.add_option("--channels", a->channels,
                       "A file of views of the driver's eye, on screens side by side (docs/simulator.md)");
    program
        .add_option("--latency", a->latency,
                    "1: the eye adapts to channels as they were a frame ago, so that none waits for others to be drawn")
        .check(apps::range(0u, 1u))
        .shows_default();
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
    program.callback_of_ranks([a, program] {
        apps::use_threads(a->threads);
        a->settings = DriveSettings::given(program);
        a->scale_given = program.count("--scale") > 0;
        take_messages(program, *a);
        check(program, *a);
        a->size_given = program.count("--size") > 0;
        if (a->headless)
            run_headless(*a);
        else
            run_windowed(*a);
    });
}

}  // namespace vesper::drive
