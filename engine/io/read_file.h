// Whole files. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vesper::io {

/// Reads a regular file of at most `max_bytes`, and tells the task's FileGate. Throws Error.
std::vector<uint8_t> read_file(const std::filesystem::path& file, uint64_t max_bytes);

}  // namespace vesper::io
