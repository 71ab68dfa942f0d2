// A device through the C interface, whose validation is silent. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <gtest/gtest.h>
#include <vesper/vesper.h>

namespace vesper::test {

class CDevice : public ::testing::Test {
protected:
    void SetUp() override {
        VesperDeviceOptions options = VESPER_INIT(VesperDeviceOptions);
        options.validation = 1, options.user = &complaints;
        options.on_message = [](const char* message, void* user) { *static_cast<std::string*>(user) += message; };
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

}  // namespace vesper::test
