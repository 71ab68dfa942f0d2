#include "own_data.h"

#include <string_view>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOwn = "vesper:";

/// Whether a path goes on below the folder that it starts from.
bool stays(const fs::path& relative) {
    return relative.is_relative() && !relative.empty() && *relative.begin() != "..";
}

}  // namespace

fs::path own_data() {
    std::error_code failed;
    const fs::path programs = fs::read_symlink("/proc/self/exe", failed).parent_path();
    if (failed)
        throw Error("Vesper's own scenes: /proc/self/exe does not say where this program lies: " + failed.message());
    const fs::path beside = programs / "share/vesper",
                   installed = (programs / VESPER_DATA_FROM_PROGRAMS).lexically_normal();
    for (const fs::path& folder : {beside, installed}) {
        const fs::path found = fs::canonical(folder, failed);
        if (!failed && fs::is_directory(found, failed)) return found;
    }
    throw Error("Vesper's own scenes: neither " + one_line(beside.string()) + " nor " + one_line(installed.string()) +
                " is there: name a scene, or install them");
}

std::string own_data_name(const fs::path& file) {
    std::error_code failed;
    const fs::path name = fs::weakly_canonical(file, failed);
    if (failed) return "";
    try {
        const fs::path below = name.lexically_relative(own_data());
        return stays(below) ? std::string(kOwn) + below.generic_string() : "";
    } catch (const Error&) {
        return "";
    }
}

std::optional<fs::path> own_data_file(const std::string& name) {
    if (!name.starts_with(kOwn)) return {};
    const fs::path below = fs::path(name.substr(kOwn.size())).lexically_normal();
    if (!stays(below)) throw Error(one_line(name) + " names nothing of Vesper's own scenes");
    return own_data() / below;
}

}  // namespace vesper::apps
