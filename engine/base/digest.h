// Digests of bytes. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

namespace vesper {

/// 128 bits of all bytes that were added, in order: MurmurHash3, x64, 128 bits, seed 0 (A. Appleby, 2011). Different
/// bytes have different digests, but for chance (2^-128 a pair). Whoever looks for two inputs of one digest finds them.
class Digest {
public:
    using Value = std::array<uint64_t, 2>;

    void add(std::span<const std::byte> bytes);
    /// The bytes of a number or of a structure without padding.
    template <class T>
    void add_value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(std::as_bytes(std::span(&value, 1)));
    }
    /// The number of values, and their bytes.
    template <class Range>
    void add_list(const Range& values) {
        const std::span all(values);
        add_value(uint64_t{all.size()});
        add(std::as_bytes(all));
    }
    /// Of what was added so far; more may follow.
    Value value() const;

private:
    static constexpr size_t kBlock = 16;
    void add_block(const std::byte* block);

    Value state_{};
    std::array<std::byte, kBlock> rest_{};  // of bytes that fill no block as yet
    uint64_t bytes_ = 0;
};

/// 32 digits, small letters.
std::string hexadecimal(const Digest::Value& digest);

}  // namespace vesper
