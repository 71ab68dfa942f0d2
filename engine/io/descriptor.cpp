#include "io/descriptor.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::io {

Descriptor::~Descriptor() { close(); }

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

int Descriptor::write(std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(number_, bytes.data(), std::min<size_t>(bytes.size(), 1u << 30));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(size_t(written));
    }
    return 0;
}

int Descriptor::sync() {
    while (::fdatasync(number_) != 0)
        if (errno != EINTR) return errno == EINVAL || errno == EROFS || errno == ENOTSUP ? 0 : errno;
    return 0;
}

int Descriptor::close() {
    if (number_ < 0) return 0;
    return ::close(std::exchange(number_, -1)) == 0 || errno == EINTR ? 0 : errno;
}

Descriptor open_special(const std::filesystem::path& file) {
    Descriptor opened(::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!opened.is_open() && errno == ENXIO)
        throw Error(one_line(file.string()) + ": cannot be written: nobody reads from it");
    if (!opened.is_open()) fail(file, "cannot be opened for writing", errno);
    // Only opening must not wait; writing waits for the reader.
    const int flags = ::fcntl(opened.number(), F_GETFL);
    if (flags < 0 || ::fcntl(opened.number(), F_SETFL, flags & ~O_NONBLOCK) != 0)
        fail(file, "cannot be written", errno);
    return opened;
}

void fail(const std::filesystem::path& file, const std::string& doing, int code) {
    throw Error(one_line(file.string()) + ": " + doing + ": " + std::generic_category().message(code));
}

}  // namespace vesper::io
