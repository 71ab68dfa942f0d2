// Which files a task reads, whatever names them. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <set>

namespace vesper {

/// Remembers what read_file() reads on this thread while it lives, so that no output can replace an input that only
/// another input names. One at a time in a thread.
class FilesRead {
public:
    FilesRead();
    ~FilesRead();
    FilesRead(const FilesRead&) = delete;
    FilesRead& operator=(const FilesRead&) = delete;

    bool contains(const std::filesystem::path& file) const;

private:
    friend void note_read(const std::filesystem::path&);
    std::set<std::filesystem::path> files_;  // canonical
};

/// For what reads files by other means.
void note_read(const std::filesystem::path& file);

}  // namespace vesper
