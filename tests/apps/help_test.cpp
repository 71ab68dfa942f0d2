// What all programs say of themselves: text, whatever is asked. SPDX-License-Identifier: MIT
#include <sstream>

#include "support/program.h"

namespace vesper::test {
namespace {

bool is_text(const std::string& lines) {
    return std::none_of(lines.begin(), lines.end(), [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; });
}

class Help : public ProgramTest, public testing::WithParamInterface<const char*> {
protected:
    Help() : ProgramTest(GetParam()) {}

    size_t commands = 0, choices = 0;

    /// That of a command and of those below it; what is said to a value that is none of a list.
    void look_at(const std::string& command) {
        ASSERT_EQ(run(command + " --help"), 0) << said;
        ++commands;
        EXPECT_TRUE(is_text(printed)) << command << ": " << nlohmann::json(printed).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        std::istringstream help(printed);
        bool below = false;
        for (std::string line; std::getline(help, line);) {
            below = line == "Subcommands:" || (below && line.starts_with("  "));
            if (below && line.size() > 2 && line[2] != ' ' && line != "Subcommands:") look_at(command + " " + line.substr(2, line.find(' ', 2) - 2));
            if (line.starts_with("  --") && line.find(":{") != line.npos) refuse(command, line.substr(2, line.find_first_of(" ,", 2) - 2));
        }
    }

private:
    void refuse(const std::string& command, const std::string& option) {
        ++choices;
        expect_refused(command + " " + option + " 'none\x01\x1bof those'", {option});
        EXPECT_TRUE(is_text(said)) << command << " " << option;
    }
};

TEST_P(Help, IsText) {
    look_at("");
    EXPECT_GE(commands, GetParam() == std::string(VESPER_PROGRAM) ? 12u : 1u);
    EXPECT_GT(choices, GetParam() == std::string(VESPER_PROGRAM) ? 10u : 0u);
}

INSTANTIATE_TEST_SUITE_P(Programs, Help, testing::Values(VESPER_PROGRAM, VESPER_BENCH, VESPER_DRIVE));

}  // namespace
}  // namespace vesper::test
