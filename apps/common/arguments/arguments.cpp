#include "arguments/arguments.h"

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/one_line.h"
#include "io/new_file.h"

namespace vesper::apps {

std::string in_shell(const std::string& value) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/%@";
    if (!value.empty() && value.find_first_not_of(kPlain) == value.npos) return value;
    std::string quoted = "'";
    for (const char c : value) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

void write_text(const std::string& file, const std::string& text) {
    io::replace_file(file, std::vector<uint8_t>(text.begin(), text.end()));
}

std::string column(const std::string& text, size_t width) {
    size_t at = 0, used = 0;
    while (at < text.size() && used < width) {
        ++at, ++used;
        while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) ++at;
    }
    return text.substr(0, at) + std::string(width - used, ' ');
}

}  // namespace vesper::apps
