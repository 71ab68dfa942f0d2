// What the commands share: checks of arguments, texts. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace vesper {

bool ends_with(const std::string& text, const std::string& end);
/// Throws Error unless the folder that `file` is to be written to exists.
void check_folder(const std::string& option, const std::string& file);
/// A number in a range; not-a-number is in none.
CLI::Validator between(double low, double high);

/// Writes a text file, which is replaced only when complete.
void write_text(const std::string& file, const std::string& text);
/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);
/// At most so many characters of UTF-8, then spaces up to so many columns.
std::string column(const std::string& text, size_t width);

}  // namespace vesper
