// The shared set of files, which need not be there. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "places.h"

namespace vesper::test {

/// A file or folder of the set; VESPER_SHARED_DATA comes from the build.
inline std::filesystem::path shared_data(const std::string& below) {
    return std::filesystem::path(VESPER_SHARED_DATA) / below;
}

inline bool is_here(const std::filesystem::path& path) {
    std::error_code missing;
    return std::filesystem::exists(path, missing);
}

}  // namespace vesper::test
