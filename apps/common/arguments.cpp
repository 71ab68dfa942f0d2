#include "arguments.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {

// One name for each file, whatever links and dots lead to it.
static std::string true_name(const std::string& file) {
    std::error_code failed;
    const std::filesystem::path name =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file, failed), failed);
    return failed ? file : name.string();
}

void Files::reads(const std::string& file) {
    if (!file.empty()) read_.insert(true_name(file));
}

void Files::writes(const std::string& option, const std::string& file) {
    if (file.empty()) return;
    const std::string place = option + " " + one_line(file) + ": ";
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    std::error_code failed;
    if (!folder.empty() && !std::filesystem::is_directory(folder, failed))
        throw Error(place + "there is no folder " + one_line(folder.string()));
    const std::string name = true_name(file);
    if (read_.contains(name)) throw Error(place + "would replace what is read");
    if (!written_.try_emplace(name, option, file).second) throw Error(place + "would be written twice");
}

void Files::refuse_overwriting(const FilesRead& read) const {
    for (const auto& [name, written] : written_) vesper::refuse_overwriting(read, written.first, written.second);
}

void refuse_overwriting(const FilesRead& read, const std::string& option, const std::string& file) {
    if (!file.empty() && read.contains(file))
        throw Error(option + " " + one_line(file) + ": would replace what is read");
}

std::string in_shell(const std::string& value) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/%@";
    if (!value.empty() && value.find_first_not_of(kPlain) == value.npos) return value;
    std::string quoted = "'";
    for (const char c : value) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

void write_text(const std::string& file, const std::string& text) {
    replace_file(file, std::vector<uint8_t>(text.begin(), text.end()));
}

std::string format(const char* pattern, ...) {
    va_list arguments, again;
    va_start(arguments, pattern);
    va_copy(again, arguments);
    std::string text(static_cast<size_t>(std::vsnprintf(nullptr, 0, pattern, arguments)), '\0');
    std::vsnprintf(text.data(), text.size() + 1, pattern, again);
    va_end(again);
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
