// Reflection tables as DIALux imports them (.rtb). Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "photometry/reflection_table.h"

namespace vesper::photometry {

/// Whether a file's first line is that of such a table.
bool is_rtb(std::span<const uint8_t> text);
/// Parses "RTable.v1", a name, the number of tan gamma and these, the number of beta and these (degrees), Q0, and r x
/// 1e4 with tan gamma fastest: a value per line, or several, with points or commas (DIAL, "R-tables in DIALux"). Throws
/// Error naming file, line and reason.
ReflectionTable parse_rtb(std::span<const uint8_t> text, const std::string& name);

}  // namespace vesper::photometry
