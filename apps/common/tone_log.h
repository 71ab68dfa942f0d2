// What the eye remembered and how luminance was shown, frame by frame, as a CSV file. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "render/tone_chain.h"
#include "vision/glare_report.h"

namespace vesper::apps {

/// One line: a frame, what the eye remembers after it, and its tone curve.
struct LoggedFrame {
    double seconds = 0;         ///< of the scene
    float step = 0;             ///< since the frame before, s
    std::string tone_operator;  ///< its name
    shared::EyeState eye{};
};

/// Lines of a log, without their ends. The first names the columns; numbers are written so that they read back to the
/// last bit. Columns of obstacles (obstacle_arguments.h) may follow in both.
std::string log_heading();
std::string log_line(unsigned index, const LoggedFrame& frame, const shared::ToneCurve& curve,
                     render::Operator tone_operator, const vision::Display& display, const vision::GlareReport& glare);

/// A heading and a line that are complete, with a sum of all values but the frame's number as the last column: a line
/// that was changed since is told from one that was written.
std::string summed_heading(const std::string& heading);
std::string summed_line(const std::string& line);

/// Reads a log, with sums or without. Values of an eye that no eye has are refused. Throws Error, naming file, line and
/// column.
std::vector<LoggedFrame> read_log(const std::string& file);

/// Luminances of the display, cd/m^2, for scene luminances of 10^-4 to 10^6 cd/m^2 in tenths of a decade.
std::vector<double> curve_samples(const shared::ToneCurve& curve, render::Operator tone_operator,
                                  const vision::Display& display);
/// The state of the eye in words and numbers, for headers.
std::vector<std::pair<std::string, double>> named_state(const shared::EyeState& eye);

}  // namespace vesper::apps
