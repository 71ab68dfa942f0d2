// Texts of files in messages. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace vesper {

/// Text made fit for one line of a message: control characters, line separators, changes of direction and what is no
/// UTF-8 are replaced by "?"; it is shortened beyond `max_bytes`.
std::string one_line(const std::string& text, size_t max_bytes = 300);

}  // namespace vesper
