// What fuzzers have found stays answered. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <gtest/gtest.h>

#include "fuzz/targets.h"
#include "io/read_file.h"
#include "places.h"

namespace vesper::test {

inline void expect_answers(const std::map<std::string, FuzzTarget>& targets) {
    const std::filesystem::path found = std::filesystem::path(VESPER_SOURCE_DIR) / "tests/fuzz/found";
    for (const auto& [name, target] : targets) {
        EXPECT_NO_THROW(target({})) << name << ": nothing at all";
        if (!std::filesystem::is_directory(found / name)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(found / name)) {
            SCOPED_TRACE(entry.path().string());
            EXPECT_NO_THROW(target(io::read_file(entry.path(), 1 << 24)));
        }
    }
}

}  // namespace vesper::test
