#include "io/growing_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kSafeEvery = 60;  // appends: one or two seconds of a drive

std::string part_beside(const fs::path& target) { return target.string() + ".part"; }

}  // namespace

std::string GrowingFile::part_of(const std::string& file) { return file.empty() ? "" : part_beside(target_of(file)); }

GrowingFile::GrowingFile(const fs::path& file) : file_(file), target_(target_of(file)) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_directory(status)) throw Error(one_line(file.string()) + ": is a folder");
    const bool directly = fs::exists(status) && !fs::is_regular_file(status);
    if (directly) {
        descriptor_ = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    } else {
        // A file of its own: what the name, or a link of that name, led to before is not written to.
        part_ = part_beside(target_);
        ::unlink(part_.c_str());
        descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (descriptor_ < 0) fail(part_.empty() ? file_ : part_, errno);
    if (!directly && fs::exists(status)) ::fchmod(descriptor_, static_cast<mode_t>(status.permissions()));
}

GrowingFile::~GrowingFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void GrowingFile::fail(const fs::path& file, int code) {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    throw Error(one_line(file.string()) + ": cannot be written: " + std::generic_category().message(code));
}

void GrowingFile::append(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor_, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(file_, errno);
        text.remove_prefix(static_cast<size_t>(written));
    }
    if (++unsafe_ < kSafeEvery) return;
    ::fdatasync(descriptor_);
    unsafe_ = 0;
}

void GrowingFile::complete() {
    ::fdatasync(descriptor_);
    // Some file systems report a full disk only here.
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(file_, errno);
    if (!part_.empty() && ::rename(part_.c_str(), target_.c_str()) != 0) fail(file_, errno);
}

}  // namespace vesper
