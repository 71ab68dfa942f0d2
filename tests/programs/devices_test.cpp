// The list of devices. SPDX-License-Identifier: MIT
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

}  // namespace
}  // namespace vesper::test::devices_test
