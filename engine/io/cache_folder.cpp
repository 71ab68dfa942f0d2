#include "io/cache_folder.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/one_line.h"
#include "io/descriptor.h"
#include "io/temporary.h"

namespace vesper::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".vesper-map";
constexpr size_t kDigits = 32;

/// What a file begins with.
struct CacheHeader {
    char magic[8] = {'v', 'e', 's', 'p', 'm', 'a', 'p', '\n'};
    uint64_t version = 2;
    Digest::Value key{};
    uint64_t bytes = 0;  // that follow
    Digest::Value digest{};
};
static_assert(sizeof(CacheHeader) == 56);

CacheHeader header_of(std::span<const std::byte> secret, const Digest::Value& key, std::span<const std::byte> bytes) {
    Digest digest;
    digest.add(secret), digest.add_value(key), digest.add(bytes), digest.add(secret);
    return {.key = key, .bytes = bytes.size(), .digest = digest.value()};
}

/// Why a folder or file is not trusted; empty: it is this user's, who alone may write it.
std::string doubt_about(const struct stat& status) {
    if (status.st_uid != ::geteuid()) return "is of another user";
    return (status.st_mode & (S_IWGRP | S_IWOTH)) != 0 ? "may be written by other users" : "";
}
std::string no_trust(const fs::path& path, const std::string& doubt) {
    return one_line(path.string()) + ": " + doubt + ", and counts as none";
}

std::span<const uint8_t> octets(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
}

bool read_all(const Descriptor& in, std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t got = ::read(in.number(), bytes.data(), bytes.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        bytes = bytes.subspan(size_t(got));
    }
    return true;
}

/// Makes a folder and those above it, for this user alone as caches are (XDG Base Directory Specification). Returns 0
/// or the error code.
int make_folders(const fs::path& folder) {
    if (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return 0;
    if (errno != ENOENT || !folder.has_parent_path() || folder.parent_path() == folder) return errno;
    if (const int code = make_folders(folder.parent_path()); code != 0) return code;
    return ::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST ? 0 : errno;
}

/// The size to which files of this process may grow: beyond it a signal would come.
bool may_have(uint64_t bytes) {
    rlimit limit{};
    return ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || bytes <= limit.rlim_cur;
}

int write_parts(Descriptor& to, const CacheHeader& header, std::span<const std::byte> bytes) {
    if (!may_have(sizeof header + bytes.size())) return EFBIG;
    if (const int code = to.write(octets(std::as_bytes(std::span(&header, 1)))); code != 0) return code;
    return to.write(octets(bytes));
}

bool has_no_unnamed_files(int code) { return code == EOPNOTSUPP || code == EISDIR || code == EINVAL; }

/// Gives an unnamed file a name. What has the name already is removed; a folder stays, which is no error: the cache
/// lacks this file. Returns 0 or the error code.
int name_file(const Descriptor& unnamed, const fs::path& file) {
    const std::string content = "/proc/self/fd/" + std::to_string(unnamed.number());
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (::linkat(AT_FDCWD, content.c_str(), AT_FDCWD, file.c_str(), AT_SYMLINK_FOLLOW) == 0) return 0;
        if (errno != EEXIST) return errno;
        if (::unlink(file.c_str()) != 0 && errno != ENOENT) return 0;
    }
    return 0;  // another program has just written it
}

/// The same for file systems where files always have names.
int write_named(const fs::path& file, const CacheHeader& header, std::span<const std::byte> bytes) {
    Temporary named(file.parent_path());
    Descriptor content = named.take();
    if (!content.is_open()) return named.error();
    if (::fchmod(content.number(), 0600) != 0) return errno;
    int code = write_parts(content, header, bytes);
    if (code == 0) code = content.close();
    if (code == 0) code = named.rename_to(file);
    return code == EISDIR ? 0 : code;
}

bool is_own_name(const std::string& name) {
    return name.size() == kDigits + kEnding.size() && name.ends_with(kEnding) &&
           name.find_first_not_of("0123456789abcdef") == kDigits;
}

struct CacheFile {
    fs::path file;
    timespec used;
    uint64_t bytes;
};

/// Files of this cache, those that were used longest ago first; no links.
std::vector<CacheFile> files_of(const fs::path& folder) {
    std::vector<CacheFile> files;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        struct stat status {};
        if (!is_own_name(at->path().filename().string()) || ::lstat(at->path().c_str(), &status) != 0 ||
            !S_ISREG(status.st_mode))
            continue;
        files.push_back({at->path(), status.st_mtim, uint64_t(status.st_size)});
    }
    std::ranges::sort(files, {}, [](const CacheFile& file) { return std::pair(file.used.tv_sec, file.used.tv_nsec); });
    return files;
}

}  // namespace

struct CacheFolder::Opened {
    Descriptor file;
    uint64_t bytes;  // after the header
};

fs::path CacheFolder::file_of(const Digest::Value& key) const {
    return folder_ / (hexadecimal(key) + std::string(kEnding));
}

void CacheFolder::make() const {
    if (const int code = make_folders(folder_); code != 0) fail(folder_, "cannot be made a folder", code);
    struct stat status {};
    if (::stat(folder_.c_str(), &status) == 0 && !S_ISDIR(status.st_mode)) fail(folder_, "cannot be used", ENOTDIR);
    if (const std::string doubt = doubt_about(status); !doubt.empty()) throw Error(no_trust(folder_, doubt));
    if (::access(folder_.c_str(), R_OK | W_OK | X_OK) != 0) fail(folder_, "cannot be written", errno);
}

bool CacheFolder::is_trusted() {
    struct stat status {};
    if (!problem_.empty() || ::stat(folder_.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) return problem_.empty();
    if (const std::string doubt = doubt_about(status); !doubt.empty()) problem_ = no_trust(folder_, doubt);
    return problem_.empty();
}

std::optional<CacheFolder::Opened> CacheFolder::open(const Digest::Value& key) {
    if (!is_trusted()) return {};
    // A link leads nowhere; opening a pipe that nobody writes to must not hang.
    Descriptor in(::open(file_of(key).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat status {};
    if (!in.is_open() || ::fstat(in.number(), &status) != 0 || !S_ISREG(status.st_mode) ||
        uint64_t(status.st_size) < sizeof(CacheHeader))
        return {};
    if (const std::string doubt = doubt_about(status); !doubt.empty()) {
        if (note_.empty()) note_ = no_trust(file_of(key), doubt);
        return {};
    }
    return Opened{std::move(in), uint64_t(status.st_size) - sizeof(CacheHeader)};
}

uint64_t CacheFolder::bytes(const Digest::Value& key) {
    const auto opened = open(key);
    return opened ? opened->bytes : 0;
}

bool CacheFolder::read(const Digest::Value& key, std::span<std::byte> bytes) {
    const auto opened = open(key);
    if (!opened || opened->bytes != bytes.size()) return false;
    const Descriptor& in = opened->file;
    CacheHeader header;
    const std::optional<Secret> sealed = secret();
    if (!sealed || !read_all(in, std::as_writable_bytes(std::span(&header, 1))) || !read_all(in, bytes)) return false;
    const CacheHeader expected = header_of(*sealed, key, bytes);
    if (std::memcmp(&header, &expected, sizeof header) != 0) return false;
    ::futimens(in.number(), nullptr);  // it was used now; no matter where it cannot be said
    return true;
}

std::optional<CacheFolder::Secret> CacheFolder::secret() const {
    const Descriptor in(::open((folder_ / kSecretName).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat status {};
    Secret found;
    if (!in.is_open() || ::fstat(in.number(), &status) != 0 || !S_ISREG(status.st_mode) ||
        !doubt_about(status).empty() || uint64_t(status.st_size) != found.size() || !read_all(in, found))
        return {};
    return found;
}

// Several programs may make one at the same time: that of the last stays, and files of the others count as none.
int CacheFolder::make_secret(Secret& made) const {
    if (::getrandom(made.data(), made.size(), 0) != ssize_t(made.size())) return EIO;
    if (!may_have(made.size())) return EFBIG;
    Temporary named(folder_);
    Descriptor content = named.take();
    if (!content.is_open()) return named.error();
    if (::fchmod(content.number(), 0600) != 0) return errno;
    int code = content.write(octets(made));
    if (code == 0) code = content.close();
    return code == 0 ? named.rename_to(folder_ / kSecretName) : code;
}

int CacheFolder::write_file(const Digest::Value& key, std::span<const std::byte> bytes) const {
    if (const int code = make_folders(folder_); code != 0) return code;
    std::optional<Secret> sealing = secret();
    if (!sealing) {
        sealing.emplace();
        if (const int code = make_secret(*sealing); code != 0) return code;
    }
    const CacheHeader header = header_of(*sealing, key, bytes);
    const fs::path file = file_of(key);
    Descriptor content(::open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    if (!content.is_open()) return has_no_unnamed_files(errno) ? write_named(file, header, bytes) : errno;
    if (const int code = write_parts(content, header, bytes); code != 0) return code;
    return name_file(content, file);
}

void CacheFolder::write(const Digest::Value& key, std::span<const std::byte> bytes) {
    if (!writes() || !is_trusted()) return;
    if (const int code = write_file(key, bytes); code != 0)
        problem_ = one_line(folder_.string()) + ": cannot be written: " + std::generic_category().message(code);
    else
        written_bytes_ += sizeof(CacheHeader) + bytes.size();
}

std::string CacheFolder::settle() {
    constexpr uint64_t kCountEvery = 16;  // part of the size, after which others may have written as much
    if (written_bytes_ > 0 &&
        (!found_bytes_ || *found_bytes_ + written_bytes_ > most_bytes_ || written_bytes_ > most_bytes_ / kCountEvery))
        remove_oldest();
    if (!problem_.empty() && !std::exchange(told_, true)) return problem_;
    return note_.empty() || std::exchange(noted_, true) ? "" : note_;
}

// Somewhat more than has to go, so that not every later file removes another.
void CacheFolder::remove_oldest() {
    const std::vector<CacheFile> files = files_of(folder_);
    uint64_t bytes = 0;
    for (const CacheFile& file : files) bytes += file.bytes;
    if (bytes > most_bytes_)
        for (const CacheFile& file : files) {
            if (bytes <= most_bytes_ - most_bytes_ / 8) break;
            if (::unlink(file.file.c_str()) == 0) bytes -= file.bytes;
        }
    found_bytes_ = bytes, written_bytes_ = 0;
}

}  // namespace vesper::io
