// A display described by measurements of it. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "vision/display.h"

namespace vesper {

struct DisplayMeasurement {
    uint32_t code = 0;
    double luminance = 0;  ///< cd/m^2, in the dark
    size_t line = 0;       ///< of the file
};

/// Reads lines "code,cd/m^2" (comma, semicolon, tab or blank between them; # begins a comment; a first line of words is a
/// heading) of a display with so many bits. Codes may come in any order and more than once. Throws Error, naming file,
/// line and reason, for what no display does: fewer than three codes, none of the first or of the largest, codes beyond
/// it, luminance that falls by more than 10 % as the code rises (and by more than 0.1 % of the largest) or differs by as much between those of one code, or hardly rises.
std::vector<DisplayMeasurement> read_display_measurements(const std::filesystem::path& file, uint32_t bits);

/// A display and how far it is from its measurements, relative to each luminance, or to 1e-4 of the peak if that is more.
struct DisplayFit {
    Display display;
    std::vector<double> residuals;  ///< (display - measured) / measured, in the order of the measurements
    double rms = 0, largest = 0;    ///< of the residuals
};

/// The display with a transfer function that is nearest to measurements. Gamma: black, peak and gamma by least squares of
/// the relative residuals; sRGB: black and peak; PQ: black and peak as measured; table: means of each code; where those
/// do not rise, a plateau of their mean (isotonic regression, Ayer et al. 1955), as limited and full range mixed up make it at both ends.
DisplayFit fit_display(std::span<const DisplayMeasurement>, uint32_t bits, Eotf);

/// The simplest that is as good as measurements are: gamma, sRGB or PQ if their residuals have a root mean square of at
/// most 1 % and none is more than 3 %; the table otherwise.
DisplayFit fit_display(std::span<const DisplayMeasurement>, uint32_t bits);

}  // namespace vesper
