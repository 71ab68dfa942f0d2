#include "base/one_line.h"

#include <algorithm>
#include <string_view>

namespace vesper {
namespace {

/// Bytes of the UTF-8 character that a text begins with; 0 for control characters and for what is no UTF-8.
size_t character_length(std::string_view text) {
    const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7f;
    const size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool control = first == 0xc2 && byte(1) < 0xa0;
    const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
    const bool none =
        (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90);  // surrogates; beyond U+10FFFF
    // Separators of lines, and characters that turn the direction of what follows.
    const unsigned last = byte(2);
    const bool turns = first == 0xe2 && ((byte(1) == 0x80 && last >= 0xa8 && last <= 0xae) ||
                                         (byte(1) == 0x81 && last >= 0xa6 && last <= 0xa9));
    return control || overlong || none || turns ? 0 : length;
}

}  // namespace

std::string one_line(const std::string& text, size_t max_bytes) {
    std::string line;
    for (size_t i = 0; i < text.size();) {
        const size_t length = character_length(std::string_view(text).substr(i));
        if (line.size() + std::max<size_t>(length, 1) > max_bytes) return line + "...";
        line += length > 0 ? text.substr(i, length) : "?";
        i += std::max<size_t>(length, 1);
    }
    return line;
}

}  // namespace vesper
