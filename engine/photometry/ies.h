// IES LM-63 photometric files (1986, 1991, 1995, 2002, 2019). SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "photometry/distribution.h"

namespace vesper::photometry {

/// Reads an IES file of type A, B or C. Candela are multiplied by the candela multiplier, the ballast factor, the
/// ballast-lamp photometric factor (up to LM-63-1995; later versions keep other things in that field) and the factor of
/// the TILT table for the measured tilt; the number of lamps multiplies nothing. Throws Error naming file, line and
/// reason.
Distribution read_ies(const std::filesystem::path& file);

/// The same from memory; `name` begins messages. `folder` is where a file of TILT factors lies; without a folder such a
/// file is not looked for, and its factor is 1.
Distribution parse_ies(std::span<const uint8_t> text, const std::string& name,
                       const std::optional<std::filesystem::path>& folder = std::nullopt);

/// A distribution as LM-63-2019; parse_ies() gives angles back as they were and candela as floats.
/// Throws Error where parse_ies() would refuse it for the number of its angles.
std::string write_ies(const Distribution& distribution);

}  // namespace vesper::photometry
