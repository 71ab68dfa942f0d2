#include "arguments.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void check_folder(const std::string& option, const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw Error(option + " " + file + ": there is no folder " + folder.string());
}

CLI::Validator between(double low, double high) {
    const std::string range = format("%g to %g", low, high);
    return {[=](const std::string& given) {
                char* end = nullptr;
                const double value = std::strtod(given.c_str(), &end);
                return *end == 0 && value >= low && value <= high ? std::string()
                                                                  : given + " is not a number from " + range;
            },
            range};
}

void write_text(const std::string& file, const std::string& text) {
    replace_file(file, std::vector<uint8_t>(text.begin(), text.end()));
}

std::string format(const char* pattern, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

std::string column(const std::string& text, size_t width) {
    size_t at = 0, used = 0;
    while (at < text.size() && used < width) {
        ++at, ++used;
        while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) ++at;
    }
    return text.substr(0, at) + std::string(width - used, ' ');
}

}  // namespace vesper
