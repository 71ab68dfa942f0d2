// The command line of vesper-drive. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "settings.h"

namespace vesper {

/// What the command line says; windows and the headless program take from it what concerns them.
struct DriveArguments {
    std::string scene, run, scenario, device, size = "1680x1050";
    std::string record, replay, video, log, channels;
    std::vector<std::string> probes;
    bool headless = false, autopilot = false;
    double seconds = 20;  ///< of a drive without a window, s
    double fps = 0;       ///< of films, 1/s; 0: the recording's own frames, or 30
    uint64_t seed = 1;
    DriveSettings::Values settings;
};

void add_drive(CLI::App& program);

/// Drives or replays without a window.
void run_headless(const DriveArguments&);

}  // namespace vesper
