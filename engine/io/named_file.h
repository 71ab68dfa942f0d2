// Files that other files name. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace vesper::io {

/// The file that a file in `folder` names, by its path from there. Past all links it lies in that folder or below, or
/// in an AllowedFolder. It need not exist. Throws Error (reason only) if it lies elsewhere.
std::filesystem::path named_file(const std::filesystem::path& folder, const std::string& name);

/// A folder whose files may be named by files of every folder, on this thread and while this object lives. Objects end
/// in the reverse order of their beginning.
class AllowedFolder {
public:
    explicit AllowedFolder(const std::filesystem::path& folder);
    ~AllowedFolder();
    AllowedFolder(const AllowedFolder&) = delete;
    AllowedFolder& operator=(const AllowedFolder&) = delete;

    const std::filesystem::path& canonical() const { return canonical_; }
    const AllowedFolder* before() const { return before_; }  ///< the one that began before; null for the first

private:
    std::filesystem::path canonical_;
    const AllowedFolder* before_;
};

}  // namespace vesper::io
