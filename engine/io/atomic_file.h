// Whole files, in and out. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vesper {

/// Reads a regular file of at most `max_bytes`. Throws Error.
std::vector<uint8_t> read_file(const std::filesystem::path& file, uint64_t max_bytes);

/// Writes a file so that nobody ever sees half of it: into a temporary beside it, then renamed over it. On any error
/// (no such folder, disk full, ...) the old file stays as it was and nothing is left behind. Something that exists and
/// is no regular file (a pipe, /dev/stdout) is written to directly. Throws Error.
void replace_file(const std::filesystem::path& file, std::span<const uint8_t> bytes);

/// Where a file that is written really goes: a link stays a link, and what it points at, which need not exist, is
/// replaced. Throws Error.
std::filesystem::path target_of(const std::filesystem::path& file);

/// Text made fit for a one-line message: control characters and what is no UTF-8 replaced, shortened beyond
/// `max_bytes`.
std::string one_line(const std::string& text, size_t max_bytes = 300);

}  // namespace vesper
