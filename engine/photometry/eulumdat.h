// EULUMDAT photometric files (.ldt). SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "photometry/distribution.h"

namespace vesper::photometry {

/// Reads a EULUMDAT file with one of its sets of lamps, counted from 0: they are alternatives and are never added up.
/// I = value * flux of the set / 1000 lm * conversion factor; the number of lamps multiplies nothing, a negative one
/// means absolute photometry. The listed C and gamma angles count, not the stated spacing. The luminous
/// area's length lies along C90-C270 (CIE), so it becomes the opening's width. Throws Error naming file, line and
/// reason.
Distribution read_eulumdat(const std::filesystem::path& file, size_t lamp_set = 0);

/// The same from memory; `name` begins messages.
Distribution parse_eulumdat(std::span<const uint8_t> text, const std::string& name, size_t lamp_set = 0);

}  // namespace vesper::photometry
