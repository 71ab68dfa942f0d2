// What the commands share: checks of arguments, texts. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace vesper::apps {

/// A value as a shell takes it for one word.
std::string in_shell(const std::string& value);

/// Writes a text file, which is replaced only when complete.
void write_text(const std::string& file, const std::string& text);
/// At most so many characters of UTF-8, then spaces up to so many columns.
std::string column(const std::string& text, size_t width);

}  // namespace vesper::apps
