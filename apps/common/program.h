// What the programs share: how they start and how they end. SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

namespace vesper {

constexpr int kBadInput = 2;  ///< exit code for a file, device or argument that cannot be used

/// Parses the arguments, which runs the callbacks of the program. Complaints are one line on standard error that begins with
/// the program's name. Gives the exit code.
int run_program(CLI::App& program, int argc, char** argv);

}  // namespace vesper
