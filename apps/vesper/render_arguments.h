// What `vesper render` is asked for. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "arguments/glare_arguments.h"
#include "arguments/setting_arguments.h"
#include "arguments/tone_arguments.h"
#include "render/renderer.h"
#include "traced_light.h"

namespace vesper::commands {

struct RenderArguments {
    std::string scene, photometry, camera, size = "1680x1050", device, cache;
    apps::ToneArguments tone;
    apps::SettingArguments light;
    unsigned paths = 0;   // 0: no light is traced
    bool traces = false;  // light for each pixel
    transport::TraceSettings tracing;
    apps::GlareArguments glare;
    std::vector<std::string> outputs, obstacles;
    std::string statistics_file, log_file, replay_file, sources_file, eye_in, eye_out;
    render::RenderSettings settings;
    unsigned frames = 1, threads = 0;
    double dt = 1.0 / 30, start = 0;
    bool statistics = false, plan = false;
    std::string options;  // as given
};

}  // namespace vesper::commands
