#include "io/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/descriptor.h"
#include "io/file_gate.h"

namespace vesper::io {

namespace fs = std::filesystem;

std::vector<uint8_t> read_file(const fs::path& file, uint64_t max_bytes) {
    // O_NONBLOCK: opening a pipe nobody writes to must not hang; it is refused below as not a regular file.
    Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!in.is_open()) fail(file, "cannot be opened", errno);
    struct stat status {};
    if (::fstat(in.number(), &status) != 0) fail(file, "cannot be read", errno);
    if (S_ISDIR(status.st_mode)) throw Error(one_line(file.string()) + ": is a folder");
    if (!S_ISREG(status.st_mode)) throw Error(one_line(file.string()) + ": is not a regular file");
    gate_read(in.number(), file);
    const auto size = static_cast<uint64_t>(status.st_size);
    if (size > max_bytes)
        throw Error(one_line(file.string()) + ": has " + std::to_string(size) + " bytes, more than the limit of " +
                    std::to_string(max_bytes));
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
    return bytes;
}

}  // namespace vesper::io
