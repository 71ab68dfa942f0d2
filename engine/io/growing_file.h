// Files that are written while something goes on. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/descriptor.h"

namespace vesper::io {

/// A text file that grows as NAME.part beside the place it is meant for, and takes its name once it is complete.
/// Whatever ends the program, what was appended is in NAME.part, and NAME holds what it held before. Of a link, NAME is
/// what it points at. NAME.part is locked: a second program that writes it is refused. A NAME.part
/// that a program left behind is removed; of a link, the link and not its target. Something that exists and is no
/// regular file (a pipe, /dev/stdout) is written to directly. Functions throw Error.
class GrowingFile {
public:
    /// Throws if the file was read by this task (FileGate), or if it grows already.
    explicit GrowingFile(const std::filesystem::path& file);
    ~GrowingFile();  ///< leaves NAME.part where it was not completed
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    void append(std::string_view text);
    void complete();

    /// Where that file grows; empty for no file.
    static std::string part_of(const std::string& file);

private:
    [[noreturn]] void give_up(int code);

    std::filesystem::path file_, target_, part_;
    Descriptor content_;
    unsigned unsafe_ = 0;  // appended since the disk was told to keep it
};

}  // namespace vesper::io
