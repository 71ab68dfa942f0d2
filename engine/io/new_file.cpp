#include "io/new_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "base/error.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/temporary.h"

namespace vesper::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDoing = "cannot be written";

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// No signal ends the thread between a name and the next step.
class SignalsHeld {
public:
    SignalsHeld() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    SignalsHeld(const SignalsHeld&) = delete;
    SignalsHeld& operator=(const SignalsHeld&) = delete;

private:
    sigset_t before_;
};

}  // namespace

NewFile::NewFile(const fs::path& file) : file_(file) {
    gate_write(file);
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_directory(status)) throw Error(one_line(file.string()) + ": is a folder");
    replaces_ = !fs::exists(status) || fs::is_regular_file(status);
    if (!replaces_) {
        content_ = open_special(file);
        return;
    }
    target_ = target_of(file);
    const fs::path folder = folder_of(target_);
    content_ = Descriptor(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
    if (!content_.is_open() && (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) {
        named_ = std::make_unique<Temporary>(folder);
        content_ = named_->take();
        errno = named_->error();
    }
    if (!content_.is_open()) fail(file, kDoing, errno);
    if (fs::exists(status) && ::fchmod(content_.number(), mode_t(status.permissions())) != 0) fail(file, kDoing, errno);
}

NewFile::~NewFile() = default;

void NewFile::write(std::span<const uint8_t> bytes) {
    if (const int code = content_.write(bytes); code != 0) fail(file_, kDoing, code);
}

void NewFile::commit() {
    if (replaces_) {
        gate_write(file_);  // read since
        gate_written(file_);
        const SignalsHeld held;
        if (!named_) named_ = std::make_unique<Temporary>(folder_of(target_), content_);
        int code = named_->error();
        if (code == 0) code = content_.close();
        if (code == 0) code = named_->rename_to(target_);
        named_.reset();
        if (code != 0) fail(file_, kDoing, code);
    } else if (const int code = content_.close(); code != 0) {
        fail(file_, kDoing, code);
    }
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
    NewFile made(file);
    made.write(bytes);
    made.commit();
}

}  // namespace vesper::io
