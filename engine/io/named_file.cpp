#include "io/named_file.h"

#include <algorithm>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::io {
namespace {

namespace fs = std::filesystem;

thread_local const AllowedFolder* allowed = nullptr;

/// Past all links; empty where that cannot be told.
fs::path real_path(const fs::path& path) {
    std::error_code failed;
    const fs::path found = fs::weakly_canonical(fs::absolute(path, failed), failed);
    return failed ? fs::path() : found;
}

bool lies_in(const fs::path& folder, const fs::path& file) {
    const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    // "/a/b/" has an empty name at its end.
    return !folder.empty() && (end == folder.end() || (end->empty() && std::next(end) == folder.end()));
}

}  // namespace

fs::path named_file(const fs::path& folder, const std::string& name) {
    fs::path file = folder / name;
    const fs::path real = real_path(file);
    bool inside = lies_in(real_path(folder.empty() ? "." : folder), real);
    for (const AllowedFolder* other = allowed; other && !inside; other = other->before())
        inside = lies_in(other->canonical(), real);
    if (!inside)
        throw Error(one_line(file.string()) +
                    ": lies outside the folder of the file that names it: not read unless allowed (--allow-outside)");
    return file;
}

AllowedFolder::AllowedFolder(const fs::path& folder) : canonical_(real_path(folder)), before_(allowed) {
    allowed = this;
}

AllowedFolder::~AllowedFolder() { allowed = before_; }

}  // namespace vesper::io
