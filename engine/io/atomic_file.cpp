// Whole files, in and out, with POSIX calls so that every failure is seen. SPDX-License-Identifier: MIT
#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "io/files_read.h"

namespace vesper {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& doing, int code) {
    throw Error(one_line(file.string()) + ": " + doing + ": " + std::generic_category().message(code));
}

/// An open file descriptor, closed when it goes.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    int number() const { return number_; }
    /// Closes now and says how that went: some file systems report a full disk only here.
    int close() { return ::close(std::exchange(number_, -1)) == 0 ? 0 : errno; }

private:
    int number_;
};

/// Returns 0 or the error code.
int write_all(int descriptor, std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), std::min<size_t>(bytes.size(), 1u << 30));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
    return 0;
}

void write_directly(const fs::path& file, std::span<const uint8_t> bytes) {
    Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
    if (out.number() < 0) fail(file, "cannot be opened for writing", errno);
    int code = write_all(out.number(), bytes);
    if (code == 0) code = out.close();
    if (code != 0) fail(file, "cannot be written", code);
}

/// The name is short and does not derive from the target's, which may already be as long as a name can be.
fs::path temporary_beside(const fs::path& target) {
    static std::atomic<unsigned> serial{0};
    return target.parent_path() / (".vesper-" + std::to_string(::getpid()) + "-" + std::to_string(serial++) + ".tmp");
}

/// Bytes of the UTF-8 character that a text begins with; 0 for control characters and for what is no UTF-8.
size_t character_length(std::string_view text) {
    const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7f;
    const size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool control = first == 0xc2 && byte(1) < 0xa0;
    const bool overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
    const bool none =
        (first == 0xed && byte(1) >= 0xa0) || (first == 0xf4 && byte(1) >= 0x90);  // surrogates; beyond U+10FFFF
    return control || overlong || none ? 0 : length;
}

}  // namespace

std::vector<uint8_t> read_file(const fs::path& file, uint64_t max_bytes) {
    // O_NONBLOCK: opening a pipe nobody writes to must not hang; it is refused below as not a regular file.
    Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (in.number() < 0) fail(file, "cannot be opened", errno);
    struct stat status {};
    if (::fstat(in.number(), &status) != 0) fail(file, "cannot be read", errno);
    if (S_ISDIR(status.st_mode)) throw Error(one_line(file.string()) + ": is a folder");
    if (!S_ISREG(status.st_mode)) throw Error(one_line(file.string()) + ": is not a regular file");
    const auto size = static_cast<uint64_t>(status.st_size);
    if (size > max_bytes)
        throw Error(one_line(file.string()) + ": has " + std::to_string(size) + " bytes, more than the limit of " +
                    std::to_string(max_bytes));
    std::vector<uint8_t> bytes(size);
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = ::read(in.number(), bytes.data() + done, std::min<size_t>(bytes.size() - done, 1u << 30));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(file, "cannot be read", errno);
        if (got == 0) break;  // shrunk meanwhile: what is missing shows up as a truncated file
        done += static_cast<size_t>(got);
    }
    bytes.resize(done);
    note_read(file);
    return bytes;
}

fs::path target_of(const fs::path& file) {
    constexpr int kMostLinks = 40;  // as of Linux
    fs::path target = file;
    std::error_code ignored;
    for (int links = 0; fs::is_symlink(fs::symlink_status(target, ignored)); ++links) {
        if (links == kMostLinks) throw Error(one_line(file.string()) + ": is a link that leads nowhere");
        target = target.parent_path() / fs::read_symlink(target, ignored);
    }
    const fs::path resolved = fs::weakly_canonical(target, ignored);
    return target == file || resolved.empty() ? target : resolved;
}

void replace_file(const fs::path& file, std::span<const uint8_t> bytes) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_directory(status)) throw Error(one_line(file.string()) + ": is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) return write_directly(file, bytes);

    const fs::path target = target_of(file);
    const fs::path temporary = temporary_beside(target);
    Descriptor out(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (out.number() < 0) fail(file, "cannot be written", errno);
    int code = write_all(out.number(), bytes);
    if (code == 0 && fs::exists(status) && ::fchmod(out.number(), static_cast<mode_t>(status.permissions())) != 0)
        code = errno;
    const int closing = out.close();
    if (code == 0) code = closing;
    if (code == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) code = errno;
    if (code != 0) {
        ::unlink(temporary.c_str());
        fail(file, "cannot be written", code);
    }
}

std::string one_line(const std::string& text, size_t max_bytes) {
    std::string line;
    for (size_t i = 0; i < text.size();) {
        const size_t length = character_length(std::string_view(text).substr(i));
        if (line.size() + std::max<size_t>(length, 1) > max_bytes) return line + "...";
        line += length > 0 ? text.substr(i, length) : "?";
        i += std::max<size_t>(length, 1);
    }
    return line;
}

}  // namespace vesper
