// What --help and --help-all print: a first page of what most people need, and everything, in groups.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace vesper {

/// Gives a program, and every command that is added to it from here on, both options. --help lists the options of the
/// first page, each with the first line of its description; --help-all lists all options, by groups, with all lines.
void add_help(CLI::App& program);

constexpr const char* kFirstPage = "Options";
/// Options that are declared from here on belong to that group, which lies beyond the first page; without a name, to
/// the first page. Whoever opens a group closes it so.
void help_group(CLI::App& command, const std::string& heading = kFirstPage);

}  // namespace vesper
