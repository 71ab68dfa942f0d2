// The list of devices, and wrong use of the script that checks one. SPDX-License-Identifier: MIT
#include <regex>

#include "support/program.h"

namespace vesper::test::devices_test {
namespace {

class Devices : public ProgramTest {};

TEST_F(Devices, HaveKindVersionAndDriver) {
    ASSERT_EQ(run("devices"), 0) << said;
    const std::string all = printed;
    ASSERT_EQ(run("devices --default"), 0) << said;
    EXPECT_TRUE(std::regex_match(
        printed, std::regex(R"(.+ \(((discrete|integrated|virtual) GPU|CPU), Vulkan 1\.\d+\.\d+, .+ .+\)\n)")))
        << printed;
    EXPECT_NE(all.find(": " + printed), all.npos) << all << printed;
    expect_refused("devices --default", {"no such device"}, "VESPER_DEVICE='no such device'");
}

class GpuCheck : public ProgramTest {
protected:
    GpuCheck() : ProgramTest(VESPER_SOURCE_DIR "/scripts/gpu-check") {}
};

TEST_F(GpuCheck, RefusesWrongUseBeforeItWritesAnything) {
    expect_refused("--fast", {"--fast"});
    expect_refused("--size 100", {"100"});
    expect_refused("--device", {"--device"});
    expect_refused("a b", {"b"});
    EXPECT_FALSE(exists("a"));
    EXPECT_EQ(run("--help"), 0);
}

}  // namespace
}  // namespace vesper::test::devices_test
