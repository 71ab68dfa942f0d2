// Glare: lamps that no picture shows, and what glare hides, in numbers. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "arguments/command_line.h"

#include "eye/scatter.h"
#include "gpu_scene/luminaires.h"
#include "io/image_file.h"
#include "render/tone_chain.h"
#include "scene/scene.h"
#include "vision/glare_report.h"

namespace vesper::apps {

struct GlareArguments {
    std::string lamps;           ///< file of lamps elsewhere
    std::vector<double> target;  ///< x, y, width, height
};
void add_glare_options(Command, GlareArguments&);

/// Lamps on other screens, one a line: azimuth to the right, elevation, degrees from the middle of the view, lx at the
/// eye, on a plane facing the lamp. Empty lines, lines of # and a heading of words are passed by. Throws Error, naming
/// file and line.
std::vector<eye::OffscreenLamp> read_lamps(const std::string& file);

/// What glare hides in a frame, whose `scene` was brought back: a pixel of more than 100 times the log average is a
/// source.
vision::GlareReport glare_of(const GlareArguments&, const render::ToneChainSettings&, const render::ToneMapped&,
                             const vision::ImageAngles&, const std::vector<eye::OffscreenLamp>& outside);
/// Throws Error where a target is asked of an operator that shows no luminances.
void check_target(const GlareArguments&, const render::ToneChainSettings&);
/// How visible the marked target is, in a line.
std::string target_line(const vision::GlareReport&);
io::Header describe_glare(const vision::GlareReport&);
/// Columns of a log, with a leading comma, and their values.
std::string glare_columns();
std::string glare_values(const vision::GlareReport&);

/// The lamps before the eye, brightest first, as a CSV file for hardware that dazzles.
std::string glare_sources_heading();
std::string glare_sources_lines(unsigned frame, const scene::Scene&, std::vector<gpu_scene::GlareSource>,
                                const vision::ScatteringEye&);

}  // namespace vesper::apps
