// Whole files. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vesper::io {

/// Reads a regular file of at most `max_bytes`, and tells the task's FileGate. Throws Error.
std::vector<uint8_t> read_file(const std::filesystem::path& file, uint64_t max_bytes);

/// The first bytes of a regular file, at most so many. Throws Error.
std::vector<uint8_t> read_start(const std::filesystem::path& file, uint64_t bytes);

}  // namespace vesper::io
