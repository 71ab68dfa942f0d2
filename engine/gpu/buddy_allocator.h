// Pieces of powers of two of one whole. SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace vesper::gpu {

/// Hands out pieces of 2^k units of a whole of any number of units, each at a multiple of its size; halves that are
/// both free become one again (Knowlton 1965).
class BuddyAllocator {
public:
    explicit BuddyAllocator(uint32_t units) : units_(units) { clear(); }

    /// Frees everything.
    void clear() {
        free_.assign(32, {});
        uint32_t at = 0;
        for (uint32_t k = 32; k-- > 0;)
            if (units_ >> k & 1u) free_[k].insert(at), at += 1u << k;
    }
    /// A piece of 2^k units; nothing if there is none.
    std::optional<uint32_t> take(uint32_t k) {
        uint32_t from = k;
        while (from < free_.size() && free_[from].empty()) ++from;
        if (from == free_.size()) return std::nullopt;
        const uint32_t at = *free_[from].begin();
        free_[from].erase(free_[from].begin());
        for (; from > k; --from) free_[from - 1].insert(at + (1u << (from - 1)));
        return at;
    }
    /// A piece that was taken.
    void give(uint32_t at, uint32_t k) {
        for (; free_[k].erase(at ^ (1u << k)) != 0; ++k) at &= ~(1u << k);
        free_[k].insert(at);
    }

private:
    uint32_t units_;
    std::vector<std::set<uint32_t>> free_;  // first units of pieces of 2^k
};

}  // namespace vesper::gpu
