// A display described by measurements of it. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "vision/display.h"

namespace vesper::analysis {

struct DisplayMeasurement {
    uint32_t code = 0;
    double luminance = 0;  ///< cd/m^2, in the dark
    size_t line = 0;       ///< of the file
};

/// Reads lines "code,cd/m^2" (comma, semicolon, tab or blank between them; # begins a comment; a first line of words is
/// a heading) of a display with so many bits. Codes may come in any order and more than once. Throws Error, naming
/// file, line and reason, for implausible measurements: fewer than three codes, no measurement of the first or the
/// largest code, codes beyond it, luminance that falls by more than 10 % (and 0.1 % of the largest) as the code rises,
/// that differs by as much between measurements of one code, or that hardly rises.
std::vector<DisplayMeasurement> read_display_measurements(const std::filesystem::path& file, uint32_t bits);

/// A display and its difference from measurements, relative to each luminance or to 1e-4 of the peak, the larger.
struct DisplayFit {
    vision::Display display;
    std::vector<double> residuals;  ///< (display - measured) / measured, in the order of the measurements
    double rms = 0, largest = 0;    ///< of the residuals
};

/// The display with a transfer function that is nearest to measurements. Gamma: black, peak and gamma by least squares
/// of the relative residuals; sRGB: black and peak; PQ: black and peak as measured; table: means of each code; falling
/// means become a plateau (isotonic regression, Ayer et al. 1955), as at both ends if limited and full range are
/// confused.
DisplayFit fit_display(std::span<const DisplayMeasurement>, uint32_t bits, vision::Eotf);

/// The simplest description: gamma, sRGB or PQ if its residuals are at most 1 % rms and 3 % each; else the table.
DisplayFit fit_display(std::span<const DisplayMeasurement>, uint32_t bits);

}  // namespace vesper::analysis
