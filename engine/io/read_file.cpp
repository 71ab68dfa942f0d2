#include "io/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/descriptor.h"
#include "io/file_gate.h"

namespace vesper::io {

namespace fs = std::filesystem;

namespace {

/// Opens a regular file and says how large it is.
std::pair<Descriptor, uint64_t> open_file(const fs::path& file) {
    // O_NONBLOCK: opening a pipe nobody writes to must not hang; it is refused below as not a regular file.
    Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!in.is_open()) fail(file, "cannot be opened", errno);
    struct stat status {};
    if (::fstat(in.number(), &status) != 0) fail(file, "cannot be read", errno);
    if (S_ISDIR(status.st_mode)) throw Error(one_line(file.string()) + ": is a folder");
    if (!S_ISREG(status.st_mode)) throw Error(one_line(file.string()) + ": is not a regular file");
    gate_read(in.number(), file);
    return {std::move(in), static_cast<uint64_t>(status.st_size)};
}

std::vector<uint8_t> read_bytes(const Descriptor& in, const fs::path& file, uint64_t size) {
    spend(size);
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
    gate_contents(file, bytes);
    return bytes;
}

}  // namespace

std::vector<uint8_t> read_file(const fs::path& file, uint64_t max_bytes) {
    const auto [in, size] = open_file(file);
    if (size > max_bytes)
        throw OverLimit(one_line(file.string()) + ": has " + std::to_string(size) + " bytes, more than the limit of " +
                        std::to_string(max_bytes));
    return read_bytes(in, file, size);
}

std::vector<uint8_t> read_start(const fs::path& file, uint64_t bytes) {
    const auto [in, size] = open_file(file);
    return read_bytes(in, file, std::min(size, bytes));
}

}  // namespace vesper::io
