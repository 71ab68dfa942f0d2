// What is asked of readers of HDR pictures, whatever the format. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/hdr_image.h"
#include "io/new_file.h"
#include "io/read_file.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {

using Values = std::vector<float>;

inline void expect_values(const io::HdrImage& image, const Values& wanted, double relative = 0) {
    ASSERT_EQ(image.rgb.size(), wanted.size());
    ASSERT_EQ(image.rgb.size(), size_t{3} * image.width * image.height);
    for (size_t i = 0; i < wanted.size(); ++i)
        ASSERT_NEAR(image.rgb[i], wanted[i], relative * (std::abs(static_cast<double>(wanted[i])) + 1)) << i;
}

/// What a file is refused with, on a line that names it; nothing if it is read.
inline std::string refusal(const std::filesystem::path& file, const io::HdrLimits& limits = {},
                           const std::string& layer = {}) {
    try {
        io::read_hdr_image(file, limits, layer);
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), file.filename().string())) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return {};
}

/// Every shorter file, and every file with one byte changed, gives a picture or an Error.
inline void expect_survives(const TempFolder& folder, const std::filesystem::path& good, bool every_cut_is_seen) {
    const std::vector<uint8_t> whole = io::read_file(good, 1 << 24);
    const auto attempt = [&](std::span<const uint8_t> bytes) {
        const auto damaged =
            folder.write("damaged", std::string(bytes.begin(), bytes.end()));  // and no wait for a disk
        try {
            io::read_hdr_image(damaged, {4096, 1 << 20});
        } catch (const Error&) {
            return false;
        }
        return true;
    };
    ASSERT_TRUE(attempt(whole));
    const size_t step = 1 + whole.size() / 200;
    for (size_t size = 0; size < whole.size(); size += step) {
        const bool read = attempt(std::span(whole).first(size));
        EXPECT_FALSE(read && every_cut_is_seen) << good << " cut at " << size;
    }
    for (size_t i = 4; i < whole.size(); i += i < 400 ? 1 : step)
        for (const int change : {0x80, 0xff}) {
            std::vector<uint8_t> changed = whole;
            changed[i] ^= static_cast<uint8_t>(change);
            attempt(changed);
        }
}

}  // namespace vesper::test
