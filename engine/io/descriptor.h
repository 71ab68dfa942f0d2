// An open file and its errors, with POSIX calls so that every failure is seen. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vesper::io {

/// An open file descriptor, closed when it goes.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor();
    Descriptor(Descriptor&& other) noexcept;
    Descriptor& operator=(Descriptor&& other) noexcept;

    int number() const { return number_; }
    bool is_open() const { return number_ >= 0; }

    // The following return 0 or the error code.

    /// Writes all bytes, after short writes and interruptions too.
    int write(std::span<const uint8_t> bytes);
    /// Asks for the bytes to be on the disk; no error where a file cannot be asked (a pipe, a terminal).
    int sync();
    /// Some file systems report a full disk only here.
    int close();

private:
    int number_ = -1;
};

/// Opens what exists and is no regular file (a pipe, a terminal, /dev/null) for writing. A pipe that nobody reads is
/// refused rather than waited for. Throws Error.
Descriptor open_special(const std::filesystem::path& file);

/// "FILE: DOING: the reason of an error code" as an Error.
[[noreturn]] void fail(const std::filesystem::path& file, const std::string& doing, int code);

}  // namespace vesper::io
