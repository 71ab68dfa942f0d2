// What all programs say of themselves: text, whatever is asked; a short first page, and everything on request.
// SPDX-License-Identifier: MIT
#include "arguments/command_line.h"

#include <functional>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "run/drive.h"
#include "support/program.h"

namespace vesper::test {
namespace {

bool is_text(const std::string& lines) {
    return std::none_of(lines.begin(), lines.end(),
                        [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; });
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

class Help : public ProgramTest, public testing::WithParamInterface<const char*> {
protected:
    Help() : ProgramTest(GetParam()) {}

    size_t commands = 0, choices = 0;

    /// That of a command and of those below it; what is said to a value that is none of a list.
    void look_at(const std::string& command) {
        expect_text(command, " --help");
        ++commands;
        bool below = false, alone = true;
        for (const std::string& line : lines_of(printed)) {
            below = line == "Subcommands:" || (below && line.starts_with("  "));
            alone &= !below;
            if (below && line.size() > 2 && line[2] != ' ' && line != "Subcommands:")
                look_at(command + " " + line.substr(2, line.find(' ', 2) - 2));
        }
        expect_text(command, " --help-all");
        if (!alone) return;
        for (const std::string& line : lines_of(printed))
            if (line.starts_with("  --") && line.find(":{") != line.npos)
                refuse(command, line.substr(2, line.find_first_of(" ,", 2) - 2));
    }

private:
    void expect_text(const std::string& command, const std::string& page) {
        ASSERT_EQ(run(command + page), 0) << said;
        EXPECT_TRUE(is_text(printed)) << command << ": "
                                      << nlohmann::json(printed).dump(-1, ' ', false,
                                                                      nlohmann::json::error_handler_t::replace);
    }

    void refuse(const std::string& command, const std::string& option) {
        ++choices;
        expect_refused(command + " " + option + "='none\x01\x1bof those'", {option});
        EXPECT_TRUE(is_text(said)) << command << " " << option;
    }
};

TEST_P(Help, IsText) {
    look_at("");
    EXPECT_GE(commands, GetParam() == std::string(VESPER_PROGRAM) ? 12u : 1u);
    EXPECT_GT(choices, GetParam() == std::string(VESPER_PROGRAM) ? 10u : 0u);
}

INSTANTIATE_TEST_SUITE_P(Programs, Help, testing::Values(VESPER_PROGRAM, VESPER_BENCH, VESPER_DRIVE));

// What nobody knows is named, also where something else is missing because of it.
TEST_P(Help, NamesWhatIsUnknown) {
    const bool has_commands = GetParam() == std::string(VESPER_PROGRAM);
    expect_refused("--nonsense", {"--nonsense", "--help"});
    if (!has_commands) return;
    expect_refused("nonsense", {"there is no nonsense"});
    expect_refused("render --nonsense", {"there is no --nonsense"});
    expect_refused("display nonsense", {"there is no nonsense"});
    expect_refused("", {"subcommand is required"});
    expect_refused("render", {"scene is required"});
}

/// Calls back with the three commands that have most options.
void for_large_commands(const std::function<void(const apps::Command&)>& look) {
    apps::Program vesper("", "vesper"), drive("", "vesper-drive");
    commands::add_render(vesper), commands::add_tonemap(vesper), drive::add_drive(drive);
    for (const apps::Command& command : {vesper.command("render"), vesper.command("tonemap"), apps::Command(drive)})
        look(command);
}

bool lists(const std::string& page, const std::string& option) {
    const std::vector<std::string> lines = lines_of(page);
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        return line == "  " + option || line.starts_with("  " + option + " ");
    });
}

TEST(HelpPages, TheFirstIsShort) {
    for_large_commands([](const apps::Command& command) {
        const std::string page = command.help();
        EXPECT_LE(lines_of(page).size(), 40u) << page;
        for (const std::string& line : lines_of(page)) EXPECT_LE(line.size(), 100u) << line;
        for (const char* needed : {"--help", "--help-all", "--operator", "--glare", "--display", "Examples:"})
            EXPECT_NE(page.find(needed), page.npos) << command.name() << " " << needed;
    });
}

TEST(HelpPages, AllOptionsAreOnTheOther) {
    for_large_commands([](const apps::Command& command) {
        const std::string first = command.help(), all = command.help(true);
        const std::string unbroken = std::regex_replace(first, std::regex("\\s+"), " ");
        size_t beyond = 0;
        for (const apps::Option& option : command.options()) {
            const std::string name = apps::Command::listed_name(option);
            const bool on_first = option.is_positional() || option.group() == apps::kFirstPage;
            EXPECT_TRUE(lists(all, name)) << command.name() << " " << name;
            EXPECT_EQ(lists(first, name), on_first) << command.name() << " " << name;
            beyond += !on_first;
            if (on_first) continue;
            EXPECT_NE(all.find("\n" + option.group() + ":\n"), all.npos) << option.group();
            EXPECT_NE(unbroken.find(option.group()), unbroken.npos)
                << "the first page says that there is " << option.group();
        }
        EXPECT_GT(beyond, 20u) << command.name();
        for (const std::string& line : lines_of(all)) EXPECT_LE(line.size(), 100u) << line;
    });
}

// Where an option is declared says where it is listed, and what its page shows of it.
TEST(HelpPages, AnOptionIsWhereItWasDeclared) {
    apps::Program program("Does things.", "program");
    int number = 0;
    program.add_option("--plain", number, "Said at once\nand at length").check(apps::range(1, 7));
    program.help_group("Rare things");
    program.add_option("--rare", number, "Seldom needed").check(apps::one_of({1, 2}));
    program.help_group();
    bool last = false;
    program.add_flag("--last", last, "A flag");
    const std::string head = "Does things.\nUsage: program [OPTIONS]\n\nOptions:\n",
                      help = "  -h,--help                 Print this page\n",
                      all = "  --help-all                Print all options, with the ranges of numbers\n",
                      flag = "  --last                    A flag\n", indent(28, ' ');
    EXPECT_EQ(program.help(), head + help + all + "  --plain INT               Said at once\n" + flag +
                                  "\nMore options with --help-all: Rare things.\n");
    EXPECT_EQ(program.help(true), head + help + all + "  --plain INT:INT in [1 - 7]\n" + indent + "Said at once\n" +
                                      indent + "and at length\n" + flag +
                                      "\nRare things:\n  --rare INT:{1,2}          Seldom needed\n");
}

}  // namespace
}  // namespace vesper::test
