// Plain grids of intensity, as laboratories export them: CSV and OpenEXR. SPDX-License-Identifier: MIT
//
// CSV: the first row holds the horizontal angles, the first column the vertical ones, deg, either way up; the rest is
// cd. The corner may name the goniometry: A (also if empty or V\H), B, or C (also gamma\C). Or three columns in any
// order, headed H_deg, V_deg, cd (or C_deg, gamma_deg, cd; longer names will do, others and other units not): every
// pair of angles once. Lines that begin with # are comments; "# goniometry: B" overrules. Cells are separated by
// commas, or by semicolons or tabs with either decimal sign.
//
// OpenEXR: one channel of cd, scan lines, columns left to right in horizontal and rows top to bottom in vertical angle
// at equal steps. Header attributes (float, double or string): horizontalFirst, horizontalLast, verticalTop,
// verticalBottom, deg, at the centres of the outermost pixels; goniometry (string) A, B or C, A where missing.
//
// Types A and B keep their range; C planes may end at 90, 180 or 360 by symmetry.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "photometry/distribution.h"

namespace vesper::photometry {

/// Reads a grid. Throws Error naming file, line and reason.
Distribution read_grid_csv(const std::filesystem::path& file);
Distribution read_grid_exr(const std::filesystem::path& file);

/// The same from memory; `name` begins messages.
Distribution parse_grid_csv(std::span<const uint8_t> text, const std::string& name);
Distribution parse_grid_exr(std::span<const uint8_t> bytes, const std::string& name);
/// True if the start of a file is that of an OpenEXR grid, valid or not: it has its angles, or a channel of cd.
bool is_grid_exr(std::span<const uint8_t> start);

}  // namespace vesper::photometry
