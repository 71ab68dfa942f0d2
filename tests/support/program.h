// Runs the `vesper` program, or another of the project, in a folder of its own. SPDX-License-Identifier: MIT
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "places.h"
#include "support/temp_folder.h"

namespace vesper::test {

class ProgramTest : public testing::Test {
protected:
    explicit ProgramTest(std::string program = VESPER_PROGRAM) : program_(std::move(program)) {}

    TempFolder folder;
    std::string said, printed;  ///< what the last run wrote to standard error and output

    int run(const std::string& arguments, const std::string& environment = "") {
        const std::string command = "cd " + folder.path().string() + " && " + environment + " " + program_ + " " +
                                    arguments + " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        said = read_text(folder / "err.txt");
        printed = read_text(folder / "out.txt");
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    /// One line on standard error with every one of `words` in it, and exit code 2.
    void expect_refused(const std::string& arguments, const std::vector<std::string>& words = {},
                        const std::string& environment = "") {
        EXPECT_EQ(run(arguments, environment), 2) << arguments;
        EXPECT_TRUE(said.starts_with(std::filesystem::path(program_).filename().string() + ": "))
            << arguments << ": " << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << arguments << ": " << said;
        for (const std::string& word : words)
            EXPECT_NE(said.find(word), std::string::npos) << arguments << ": " << said;
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }

private:
    std::string program_;
};

}  // namespace vesper::test
