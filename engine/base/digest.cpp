#include "base/digest.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace vesper {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr uint64_t kFirst = 0x87c37b91114253d5u, kSecond = 0x4cf5ad432745937fu;  // factors of the publication

uint64_t scrambled_first(uint64_t word) { return std::rotl(word * kFirst, 31) * kSecond; }
uint64_t scrambled_second(uint64_t word) { return std::rotl(word * kSecond, 33) * kFirst; }

uint64_t mixed(uint64_t k) {
    k = (k ^ k >> 33) * 0xff51afd7ed558ccdu;
    k = (k ^ k >> 33) * 0xc4ceb9fe1a85ec53u;
    return k ^ k >> 33;
}

}  // namespace

void Digest::add_block(const std::byte* block) {
    uint64_t words[2];
    std::memcpy(words, block, sizeof words);
    state_[0] ^= scrambled_first(words[0]);
    state_[0] = (std::rotl(state_[0], 27) + state_[1]) * 5 + 0x52dce729u;
    state_[1] ^= scrambled_second(words[1]);
    state_[1] = (std::rotl(state_[1], 31) + state_[0]) * 5 + 0x38495ab5u;
}

void Digest::add(std::span<const std::byte> bytes) {
    const size_t begun = bytes_ % kBlock;
    bytes_ += bytes.size();
    if (begun > 0) {
        const size_t taken = std::min(kBlock - begun, bytes.size());
        std::copy_n(bytes.data(), taken, rest_.data() + begun);
        if (begun + taken < kBlock) return;
        add_block(rest_.data());
        bytes = bytes.subspan(taken);
    }
    for (; bytes.size() >= kBlock; bytes = bytes.subspan(kBlock)) add_block(bytes.data());
    std::ranges::copy(bytes, rest_.data());
}

Digest::Value Digest::value() const {
    uint64_t words[2]{};
    std::memcpy(words, rest_.data(), bytes_ % kBlock);
    uint64_t a = state_[0] ^ scrambled_first(words[0]) ^ bytes_, b = state_[1] ^ scrambled_second(words[1]) ^ bytes_;
    a += b, b += a;
    a = mixed(a), b = mixed(b);
    a += b, b += a;
    return {a, b};
}

std::string hexadecimal(const Digest::Value& digest) {
    std::string text;
    for (const uint64_t word : digest)
        for (int shift = 60; shift >= 0; shift -= 4) text += "0123456789abcdef"[word >> shift & 15];
    return text;
}

}  // namespace vesper
