// Values one after the other in bytes, for processes of one build on machines of one kind. SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace vesper::apps {

using Bytes = std::vector<std::byte>;

/// Appends values.
class PacketWriter {
public:
    template <class T>
    void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto bytes = std::as_bytes(std::span(&value, 1));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    /// The number of values, and the values.
    template <class Range>
    void list(const Range& values) {
        const std::span all(values);
        value(uint64_t{all.size()});
        const auto bytes = std::as_bytes(all);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    Bytes take() { return std::move(bytes_); }

private:
    Bytes bytes_;
};

/// Takes them in the same order. Throws Error where there are fewer bytes.
class PacketReader {
public:
    explicit PacketReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class T>
    void value(T& to) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(&to, part(sizeof to).data(), sizeof to);
    }
    template <class T>
    T value() {
        T made{};
        value(made);
        return made;
    }
    template <class T>
    std::vector<T> list() {
        const auto number = value<uint64_t>();
        if (number > bytes_.size() / sizeof(T)) fail();
        std::vector<T> values(number);
        const auto from = part(number * sizeof(T));
        if (number > 0) std::memcpy(values.data(), from.data(), from.size());
        return values;
    }
    std::string text() {
        const std::vector<char> letters = list<char>();
        return {letters.begin(), letters.end()};
    }
    bool at_end() const { return bytes_.empty(); }

private:
    [[noreturn]] static void fail() { throw Error("another process sent less than was expected"); }
    std::span<const std::byte> part(size_t bytes) {
        if (bytes > bytes_.size()) fail();
        const auto from = bytes_.first(bytes);
        bytes_ = bytes_.subspan(bytes);
        return from;
    }

    std::span<const std::byte> bytes_;
};

/// Several packets as one, and one taken apart again.
inline Bytes joined(const std::vector<Bytes>& packets) {
    PacketWriter all;
    for (const Bytes& one : packets) all.list(one);
    return all.take();
}
inline std::vector<Bytes> parted(const Bytes& all) {
    std::vector<Bytes> packets;
    for (PacketReader reader(all); !reader.at_end();) packets.push_back(reader.list<std::byte>());
    return packets;
}

}  // namespace vesper::apps
