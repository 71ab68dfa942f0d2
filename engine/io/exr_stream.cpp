#include "io/exr_stream.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace vesper {

bool ExrStream::read(char to[], int count) {
    if (count < 0 || at_ > bytes_.size() || static_cast<size_t>(count) > bytes_.size() - at_) throw Error("is cut off");
    std::memcpy(to, bytes_.data() + at_, static_cast<size_t>(count));
    at_ += static_cast<uint64_t>(count);
    return at_ < bytes_.size();
}

uint32_t exr_word(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<uint32_t>(bytes[at]) | static_cast<uint32_t>(bytes[at + 1]) << 8 | static_cast<uint32_t>(bytes[at + 2]) << 16 |
           static_cast<uint32_t>(bytes[at + 3]) << 24;
}

// "OpenEXR File Layout": magic number, version and flags, headers. A header is attributes (name, type, size, value) and a zero; after
// the headers of several parts comes another.
void see_exr_attributes(std::span<const uint8_t> bytes, const std::function<void(std::string_view, std::span<const uint8_t>)>& see) {
    constexpr uint32_t kMagic = 20000630;
    constexpr size_t kLongestName = 255;
    if (bytes.size() < 8 || exr_word(bytes, 0) != kMagic) throw Error("is no OpenEXR file");
    const bool parts = exr_word(bytes, 4) & kExrParts;
    std::span<const uint8_t> rest = bytes.subspan(8);
    const auto cut_off = [] { return Error("is cut off in its header"); };
    const auto text = [&] {
        const size_t length = static_cast<size_t>(std::find(rest.begin(), rest.end(), 0) - rest.begin());
        if (length == rest.size() || length > kLongestName) throw cut_off();
        const std::string_view made(reinterpret_cast<const char*>(rest.data()), length);
        rest = rest.subspan(length + 1);
        return made;
    };
    do {
        for (std::string_view name = text(); !name.empty(); name = text()) {
            text();  // its type
            if (rest.size() < 4 || exr_word(rest, 0) > rest.size() - 4) throw cut_off();
            const size_t size = exr_word(rest, 0);
            see(name, rest.subspan(4, size));
            rest = rest.subspan(4 + size);
        }
        if (parts && rest.empty()) throw cut_off();
    } while (parts && rest.front() != 0);
}

}  // namespace vesper
