#include "numbered_files.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "base/error.h"
#include "base/one_line.h"
#include "print.h"

namespace vesper::apps {

namespace fs = std::filesystem;

std::string NumberedName::at(unsigned number) const { return before + format("%0*u", int(digits), number) + after; }

std::optional<NumberedName> numbered_name(const std::string& option, const std::string& name) {
    const size_t percent = name.find('%');
    if (percent == name.npos) return std::nullopt;
    const size_t d = name.find('d', percent);
    const std::string count = d == name.npos ? "x" : name.substr(percent + 1, d - percent - 1);
    const bool sound = count.size() <= 2 && (count.size() < 2 || count <= "10") &&
                       name.find('%', percent + 1) == name.npos &&
                       std::all_of(count.begin(), count.end(), [](unsigned char c) { return c >= '0' && c <= '9'; });
    if (!sound) throw Error(option + " " + one_line(name) + ": only one number such as %04d may follow a %");
    return NumberedName{name.substr(0, percent), name.substr(d + 1),
                        count.empty() ? 1u : std::max(1u, unsigned(std::stoi(count)))};
}

std::optional<unsigned> number_in(const NumberedName& name, const std::string& path) {
    const std::string start = fs::path(name.before + "0").filename().string(),
                      before = start.substr(0, start.size() - 1), file = fs::path(path).filename().string();
    if (file.size() <= before.size() + name.after.size() || !file.starts_with(before) || !file.ends_with(name.after))
        return std::nullopt;
    const char *first = file.data() + before.size(), *last = file.data() + file.size() - name.after.size();
    unsigned number = 0;
    const auto [rest, error] = std::from_chars(first, last, number);
    // What printf would have written for that number, so that each file is found once.
    if (error != std::errc() || rest != last || file != before + format("%0*u", int(name.digits), number) + name.after)
        return std::nullopt;
    return number;
}

std::vector<NumberedFile> existing_files(const NumberedName& name) {
    const fs::path folder = fs::path(name.before + "0" + name.after).parent_path();
    std::vector<NumberedFile> found;
    std::error_code code;
    for (fs::directory_iterator it(folder.empty() ? "." : folder, code), end; !code && it != end; it.increment(code))
        if (const auto number = number_in(name, it->path().string())) found.push_back({*number, name.at(*number)});
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
    return found;
}

std::vector<NumberedFile> numbered_files(const NumberedName& name) {
    std::vector<NumberedFile> found = existing_files(name);
    if (found.empty())
        throw Error(one_line(name.before + "%0" + std::to_string(name.digits) + "d" + name.after) +
                    ": there are no such files");
    return found;
}

}  // namespace vesper::apps
