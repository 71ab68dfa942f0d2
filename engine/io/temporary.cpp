#include "io/temporary.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <random>

namespace vesper::io {
namespace {

/// A name that remove_temporaries() sees. More temporaries than slots at one time are not removed by it.
struct Slot {
    std::atomic<bool> taken = false, shown = false;
    char name[PATH_MAX] = {};
};
Slot slots[16];

}  // namespace

Temporary::Temporary(const std::filesystem::path& folder) {
    name(folder, [this](const char* path) {
        opened_ = Descriptor(::open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
        return opened_.is_open();
    });
}

Temporary::Temporary(const std::filesystem::path& folder, const Descriptor& unnamed) {
    const std::string file = "/proc/self/fd/" + std::to_string(unnamed.number());
    name(folder,
         [&](const char* path) { return ::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0; });
}

void Temporary::name(const std::filesystem::path& folder, const std::function<bool(const char*)>& make) {
    std::random_device random;
    do {
        char name[32];
        std::snprintf(name, sizeof name, ".vesper-%08x%08x.tmp", unsigned(random()), unsigned(random()));
        const std::filesystem::path path = folder / name;
        error_ = make(path.c_str()) ? 0 : errno;
        if (error_ == 0) keep(path);
    } while (error_ == EEXIST);
}

Temporary::~Temporary() {
    if (!name_.empty()) ::unlink(name_.c_str());
    if (slot_ < 0) return;
    slots[slot_].shown = false;
    slots[slot_].taken = false;
}

int Temporary::rename_to(const std::filesystem::path& target) {
    if (::rename(name_.c_str(), target.c_str()) != 0) return errno;
    name_.clear();
    return 0;
}

void Temporary::keep(const std::filesystem::path& name) {
    std::error_code failed;  // a program may change its folder before a signal comes
    name_ = std::filesystem::absolute(name, failed).string();
    if (name_.size() >= PATH_MAX) return;
    for (int i = 0; i < int(std::size(slots)); ++i)
        if (!slots[i].taken.exchange(true)) {
            std::memcpy(slots[i].name, name_.c_str(), name_.size() + 1);
            slots[i].shown = true;
            slot_ = i;
            return;
        }
}

void remove_temporaries() noexcept {
    for (const Slot& slot : slots)
        if (slot.shown) ::unlink(slot.name);
}

}  // namespace vesper::io
