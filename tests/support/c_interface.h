// A device through the C interface, whose validation is silent, and pictures for it. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <vesper/vesper.h>

namespace vesper::test {

// The messages of the validation layer, together.
inline void collect(const char* message, void* user) { *static_cast<std::string*>(user) += message; }

class CInterface : public ::testing::Test {
protected:
    void SetUp() override {
        VesperDeviceOptions options = VESPER_INIT(VesperDeviceOptions);
        options.validation = 1, options.on_message = collect, options.user = &complaints;
        ASSERT_EQ(vesper_device_open(&options, &device, &error), VESPER_OK) << error.message;
    }
    void TearDown() override {
        vesper_device_close(device);
        EXPECT_EQ(complaints, "");
    }
    std::string complaints;
    VesperDevice* device = nullptr;
    VesperError error;
};

inline std::vector<float> night_values(uint32_t width, uint32_t height) {
    std::vector<float> rgb;
    for (uint32_t i = 0; i < width * height; ++i) {
        const float l = std::pow(10.0f, -2 + 5 * float(i % 101) / 101);
        rgb.insert(rgb.end(), {l, 0.7f * l, 0.4f * l});
    }
    return rgb;
}

inline VesperPicture picture_of(const std::vector<float>& rgb, uint32_t width, uint32_t height) {
    VesperPicture picture = VESPER_INIT(VesperPicture);
    picture.width = width, picture.height = height, picture.channels = 3, picture.values = rgb.data(),
    picture.scale = 1, picture.vertical_fov = 0.7f;
    return picture;
}

}  // namespace vesper::test
