// Pieces of powers of two. SPDX-License-Identifier: MIT
#include "gpu/buddy_allocator.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace vesper::test::buddy_allocator_test {
namespace {

struct Piece {
    uint32_t at, k;
};

TEST(BuddyAllocator, PiecesNeverMeetAndJoinAgain) {
    constexpr uint32_t kUnits = 4096 + 1024 + 8;
    gpu::BuddyAllocator whole(kUnits);
    std::mt19937 random(1);
    std::vector<bool> used(kUnits);
    std::vector<Piece> taken;
    uint32_t refused = 0;
    for (int turn = 0; turn < 20'000; ++turn) {
        if (random() % 5 < 3) {
            const uint32_t k = uint32_t(random() % 8);
            const std::optional<uint32_t> at = whole.take(k);
            refused += at ? 0 : 1;
            if (!at) continue;
            ASSERT_EQ(*at % (1u << k), 0u);
            ASSERT_LE(*at + (1u << k), kUnits);
            for (uint32_t i = *at; i < *at + (1u << k); ++i) {
                ASSERT_FALSE(used[i]);
                used[i] = true;
            }
            taken.push_back({*at, k});
        } else if (!taken.empty()) {
            std::swap(taken[random() % taken.size()], taken.back());
            const auto [at, k] = taken.back();
            taken.pop_back();
            whole.give(at, k);
            std::fill(used.begin() + at, used.begin() + at + (1u << k), false);
        }
    }
    EXPECT_GT(refused, 0u);
    for (const auto& [at, k] : taken) whole.give(at, k);
    EXPECT_EQ(whole.take(12), std::optional<uint32_t>(0));
    EXPECT_EQ(whole.take(10), std::optional<uint32_t>(4096));
    EXPECT_EQ(whole.take(3), std::optional<uint32_t>(5120));
    EXPECT_EQ(whole.take(0), std::nullopt);
}

// Pieces that fit together always find a place, the largest first.
TEST(BuddyAllocator, FallingSizesFillTheWhole) {
    std::mt19937 random(2);
    for (int turn = 0; turn < 200; ++turn) {
        const uint32_t units = uint32_t(1 + random() % 5000);
        gpu::BuddyAllocator whole(units);
        std::vector<uint32_t> sizes;
        for (uint32_t left = units; left > 0;) {
            const uint32_t k = uint32_t(random() % 7);
            if (1u << k <= left) sizes.push_back(k), left -= 1u << k;
        }
        std::ranges::sort(sizes, std::greater());
        for (const uint32_t k : sizes) ASSERT_TRUE(whole.take(k)) << units;
        EXPECT_FALSE(whole.take(0));
    }
}

}  // namespace
}  // namespace vesper::test::buddy_allocator_test
