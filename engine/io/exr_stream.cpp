#include "io/exr_stream.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::io {
namespace {

/// Bytes of a value of a type. OpenEXR reads so many whatever the file states, and what follows then as something else.
struct ValueSize {
    std::string_view type;
    size_t bytes;
};
constexpr ValueSize kValueSizes[]{{"box2f", 16},
                                  {"box2i", 16},
                                  {"chromaticities", 32},
                                  {"compression", 1},
                                  {"deepImageState", 1},
                                  {"double", 8},
                                  {"envmap", 1},
                                  {"float", 4},
                                  {"int", 4},
                                  {"keycode", 28},
                                  {"lineOrder", 1},
                                  {"m33d", 72},
                                  {"m33f", 36},
                                  {"m44d", 128},
                                  {"m44f", 64},
                                  {"rational", 8},
                                  {"tiledesc", 9},
                                  {"timecode", 8},
                                  {"v2d", 16},
                                  {"v2f", 8},
                                  {"v2i", 8},
                                  {"v3d", 24},
                                  {"v3f", 12},
                                  {"v3i", 12}};

/// Whether a list of channels (name, zero, 16 bytes each, and a zero) is as long as stated.
bool is_channel_list(std::span<const uint8_t> value) {
    constexpr size_t kChannel = 16;
    while (!value.empty() && value.front() != 0) {
        const auto end = size_t(std::find(value.begin(), value.end(), 0) - value.begin());
        if (value.size() - end < 1 + kChannel) return false;
        value = value.subspan(end + 1 + kChannel);
    }
    return value.size() == 1;
}

/// Whether texts, each behind its length, are as long as stated.
bool is_text_list(std::span<const uint8_t> value) {
    while (value.size() >= 4 && exr_word(value, 0) <= value.size() - 4) value = value.subspan(4 + exr_word(value, 0));
    return value.empty();
}

/// Whether OpenEXR reads as many bytes of a value as are stated, and takes memory for no more.
bool is_whole(std::string_view type, std::span<const uint8_t> value) {
    if (const auto fixed = std::ranges::find(kValueSizes, type, &ValueSize::type); fixed != std::end(kValueSizes))
        return value.size() == fixed->bytes;
    if (type == "chlist") return is_channel_list(value);
    if (type == "stringvector") return is_text_list(value);
    if (type == "floatvector") return value.size() % 4 == 0;
    if (type == "idmanifest") return value.size() >= 4;
    if (type == "preview")
        return value.size() >= 8 && value.size() % 4 == 0 &&
               value.size() / 4 - 2 == uint64_t{exr_word(value, 0)} * exr_word(value, 4);
    return true;  // texts, and what OpenEXR does not know: as long as stated
}

}  // namespace

bool ExrStream::read(char to[], int count) {
    if (count < 0 || at_ > bytes_.size() || static_cast<size_t>(count) > bytes_.size() - at_) throw Error("is cut off");
    std::memcpy(to, bytes_.data() + at_, static_cast<size_t>(count));
    at_ += static_cast<uint64_t>(count);
    return at_ < bytes_.size();
}

uint32_t exr_word(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<uint32_t>(bytes[at]) | static_cast<uint32_t>(bytes[at + 1]) << 8 |
           static_cast<uint32_t>(bytes[at + 2]) << 16 | static_cast<uint32_t>(bytes[at + 3]) << 24;
}

// "OpenEXR File Layout": magic number, version and flags, headers. A header is attributes (name, type, size, value) and
// a zero; after the headers of several parts comes another.
void see_exr_attributes(std::span<const uint8_t> bytes,
                        const std::function<void(std::string_view, std::span<const uint8_t>)>& see) {
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
    // Where one of these is missing OpenEXR 3.1 takes what a new picture would have, 64 x 64 pixels.
    constexpr std::string_view kRequired[] = {"channels", "compression", "dataWindow", "displayWindow"};
    do {
        bool has[std::size(kRequired)]{};
        for (std::string_view name = text(); !name.empty(); name = text()) {
            if (const auto required = std::ranges::find(kRequired, name); required != std::end(kRequired))
                has[required - kRequired] = true;
            const std::string_view type = text();
            if (rest.size() < 4 || exr_word(rest, 0) > rest.size() - 4) throw cut_off();
            const size_t size = exr_word(rest, 0);
            if (!is_whole(type, rest.subspan(4, size)))
                throw Error("its header attribute '" + one_line(std::string(name)) + "' has not the size of a " +
                            one_line(std::string(type)));
            see(name, rest.subspan(4, size));
            rest = rest.subspan(4 + size);
        }
        for (size_t i = 0; i < std::size(has); ++i)
            if (!has[i]) throw Error("its header has no '" + std::string(kRequired[i]) + "'");
        if (parts && rest.empty()) throw cut_off();
    } while (parts && rest.front() != 0);
}

}  // namespace vesper::io
