#include "io/growing_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "base/error.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/new_file.h"

namespace vesper::io {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kSafeEvery = 60;  // appends: one or two seconds of a drive
constexpr const char* kDoing = "cannot be written";

std::string part_beside(const fs::path& target) { return target.string() + ".part"; }

/// Whether a name leads, past no link, to an open file.
bool leads_to(const fs::path& name, const Descriptor& opened) {
    struct stat named {
    }, there{};
    return ::lstat(name.c_str(), &named) == 0 && ::fstat(opened.number(), &there) == 0 &&
           named.st_dev == there.st_dev && named.st_ino == there.st_ino;
}

/// Makes a file of this name that this program alone writes. What a program that ended left there is removed.
Descriptor open_part(const fs::path& part) {
    for (int tries = 0; tries < 100; ++tries) {
        Descriptor made(::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
        if (!made.is_open() && errno != EEXIST) fail(part, kDoing, errno);
        if (made.is_open() && ::flock(made.number(), LOCK_EX | LOCK_NB) == 0 && leads_to(part, made)) return made;
        if (made.is_open()) continue;  // another program took it for a remnant
        // A link is no file that grows: it is opened by nobody.
        const Descriptor old(::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
        if (!old.is_open() && errno == EACCES) fail(part, kDoing, errno);  // nobody can tell whether it grows
        if (old.is_open() && ::flock(old.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            throw Error(one_line(part.string()) + ": is being written by another program");
        if (old.is_open() && !leads_to(part, old)) continue;
        if (::unlink(part.c_str()) != 0 && errno != ENOENT) fail(part, kDoing, errno);
    }
    throw Error(one_line(part.string()) + ": is being written by other programs");
}

}  // namespace

std::string GrowingFile::part_of(const std::string& file) { return file.empty() ? "" : part_beside(target_of(file)); }

GrowingFile::GrowingFile(const fs::path& file) : file_(file), target_(target_of(file)) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_directory(status)) throw Error(one_line(file.string()) + ": is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        content_ = open_special(file);
        return;
    }
    part_ = part_beside(target_);
    gate_write(file);
    gate_write(part_);
    content_ = open_part(part_);
    gate_grows(target_);
    gate_grows(part_);
    if (fs::exists(status)) ::fchmod(content_.number(), mode_t(status.permissions()));
}

GrowingFile::~GrowingFile() {
    if (part_.empty()) return;
    gate_written(target_);
    gate_written(part_);
}

void GrowingFile::give_up(int code) {
    content_.close();
    fail(file_, kDoing, code);
}

void GrowingFile::append(std::string_view text) {
    if (const int code = content_.write({reinterpret_cast<const uint8_t*>(text.data()), text.size()})) give_up(code);
    if (++unsafe_ < kSafeEvery) return;
    if (const int code = content_.sync()) give_up(code);
    unsafe_ = 0;
}

void GrowingFile::complete() {
    if (const int code = content_.sync()) give_up(code);
    if (!part_.empty()) {
        gate_write(file_);  // read since
        gate_written(target_);
        gate_written(part_);
        if (!leads_to(part_, content_)) {
            content_.close();
            throw Error(one_line(part_.string()) + ": another file has taken its place");
        }
        // Before it is closed: nobody may take it for a remnant.
        if (::rename(part_.c_str(), target_.c_str()) != 0) give_up(errno);
    }
    if (const int code = content_.close()) give_up(code);
}

}  // namespace vesper::io
