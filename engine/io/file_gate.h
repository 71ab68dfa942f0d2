// Which files a task reads and writes, by what they are. SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <compare>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>

#include "base/digest.h"
#include "base/error.h"

namespace vesper::io {

/// A file, whatever names and links lead to it.
struct FileIdentity {
    dev_t device = 0;  ///< of the file; of its folder where there is a name
    ino_t inode = 0;
    std::string name;  ///< in that folder; empty for a file that exists

    auto operator<=>(const FileIdentity&) const = default;
};

/// Writing would replace a file that is read.
struct WouldReplace : Error {
    using Error::Error;
};

/// The one gate of a task for its files, for the thread that makes it and as long as it lives: no output replaces a
/// file that is read, whatever names it, and none is written twice. Readers and writers report to it by the functions
/// below, which do nothing where there is no gate, and throw Error. One that is made while another lives has no effect.
class FileGate {
public:
    FileGate();
    ~FileGate();
    FileGate(const FileGate&) = delete;
    FileGate& operator=(const FileGate&) = delete;

    std::set<FileIdentity> read;  ///< files that exist
    std::map<std::string, std::set<Digest::Value>>
        contents;                 ///< digests of all that was read, by names without folders
    bool keeps_contents = false;  ///< where somebody is to compare them
    std::map<FileIdentity, std::string>
        written;  ///< who writes: by what they are, and by the names that they will have
};

/// Announces a file that will be read. An empty path is no file, here and below.
void announce_read(const std::filesystem::path& file);
/// Announces a file that will be written, as `option` asks for. Throws if its folder does not exist, if it is read, or
/// if it is written already.
void announce_write(const std::string& option, const std::filesystem::path& file);

/// For readers: this open file is read. Throws if it is to be written.
void gate_read(int descriptor, const std::filesystem::path& file);
/// For readers: what is in it.
void gate_contents(const std::filesystem::path& file, std::span<const uint8_t> bytes);
/// FileGate::contents of the gate of this thread; nothing where there is none.
std::map<std::string, std::set<Digest::Value>> contents_read();
/// For writers: this file is about to be replaced. Throws if it was read.
void gate_write(const std::filesystem::path& file);
/// For writers: this file grows until gate_written(), and cannot be read as long.
void gate_grows(const std::filesystem::path& file);
/// For writers: this file takes its name now, and may be read from then on.
void gate_written(const std::filesystem::path& file);

}  // namespace vesper::io
