// Lower and upper case without the host's locale. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace vesper {

/// The text with A to Z as a to z; other bytes, those of UTF-8 among them, stay.
inline std::string lower(std::string_view text) {
    std::string made(text);
    for (char& c : made)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return made;
}

/// And a to z as A to Z.
inline std::string upper(std::string_view text) {
    std::string made(text);
    for (char& c : made)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return made;
}

}  // namespace vesper
