// A file that is made or replaced as a whole. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "io/descriptor.h"

namespace vesper::io {

class Temporary;

/// The new content of a file. Until commit() the old file stays as it was; without it nothing is left behind, even if
/// the program is killed: the content has no name (or a temporary one, on file systems without unnamed files). A link
/// stays a link, and the file that it leads to, which need not exist, is replaced; its mode is kept. What exists and is
/// no regular file (a pipe, /dev/stdout) is written to directly. Functions throw Error.
class NewFile {
public:
    /// Throws if the file was read by this task (FileGate).
    explicit NewFile(const std::filesystem::path& file);
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    /// To be written to, by another program, too.
    const Descriptor& descriptor() const { return content_; }
    void write(std::span<const uint8_t> bytes);
    /// Puts the new content in place.
    void commit();

private:
    std::filesystem::path file_, target_;
    bool replaces_ = true;  // false: written to directly
    Descriptor content_;
    std::unique_ptr<Temporary> named_;  // where the file system has no unnamed files
};

/// Where a file that is written really goes: past all links. Throws Error.
std::filesystem::path target_of(const std::filesystem::path& file);

/// Makes or replaces a file, see NewFile. Throws Error.
void replace_file(const std::filesystem::path& file, std::span<const uint8_t> bytes);

}  // namespace vesper::io
