// The command line of vesper-drive. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "arguments/command_line.h"

#include "record/detection.h"
#include "session/drive_file.h"
#include "session/settings.h"

namespace vesper::drive {

/// What the command line says; windows and the headless program take from it what concerns them.
struct DriveArguments {
    std::string scene, device, size = "1680x1050";
    std::string record, replay, video, log, channels;
    std::vector<std::string> probes, obstacles;
    double visible_from = kVisibleFrom;  ///< a visibility level
    std::string detection_plot;
    bool hatches = false;    ///< obstacles that are not seen
    MessageSource messages;  ///< made of the following
    std::string table, trace, models, origin;
    std::string osi_udp, osi_out;  ///< [ADDRESS:]PORT to listen at; a trace to write
    double osi_delay = 0.1;        ///< s
    std::string osi_z = kHeightReadings[0];
    double osi_wait = 30;  ///< s until the first message, without a window
    unsigned latency = 0;  ///< moments, of what the eye sees of channels: 0 or 1
    bool headless = false, autopilot = false;
    double seconds = 20;                           ///< of a drive without a window, s
    double scale = render::LightSettings{}.scale;  ///< of each side of pictures, rendered and then enlarged
    bool scale_given = false;                      ///< otherwise it is that of the quality
    double fps = 0;                                ///< of films, 1/s; 0: the recording's own frames, or 30
    uint64_t seed = 1;
    unsigned threads = 0;  ///< as apps::use_threads() takes it
    DriveSettings::Values settings;
    std::string cache;  ///< as apps::cache_of() takes it

    // Of a window.
    std::string window = "1280x800", vsync = "wait", scaling = "fit", controllers;
    int full_screen = -1;     ///< the monitor to fill; -1: none
    double limit = 0;         ///< pictures a second at most; 0: none
    bool size_given = false;  ///< pictures are of `size`, not of the window's
};

void add_drive(apps::Command program);

/// Start of the drive: that of the recording, if one is named, with the settings of the command line.
DriveStart start_of(const DriveArguments&, const DriveStart& recorded);

/// What is written while a drive goes on, by the option that names it.
std::vector<std::pair<std::string, std::string>> growing_outputs(const DriveArguments&);

/// Drives or replays without a window.
void run_headless(const DriveArguments&);
/// Opens a window and drives or replays in it (window/windowed.cpp).
void run_windowed(const DriveArguments&);

}  // namespace vesper::drive
