// Numbers as text without the host's locale. SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string>

namespace vesper {

/// As printf's %g with so many significant digits (1 to 17) writes it where the decimal sign is a point.
inline std::string decimal(double value, int significant = 4) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, significant).ptr};
}

}  // namespace vesper
