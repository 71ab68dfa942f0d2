// Where masked surfaces have holes. SPDX-License-Identifier: MIT
#include "gpu_scene/masks.h"

#include <cstring>

#include <gtest/gtest.h>

#include "base/budget.h"

namespace vesper::test::masks_test {
namespace {

using gpu_scene::Masks, gpu_scene::OpacityLevel;

constexpr uint64_t kPlenty = 1u << 20u;

const std::vector<OpacityLevel> kLevels{{4, 2, {1, 2, 3, 4, 5, 6, 7, 8}}, {2, 1, {20, 30}}};

shared::Mask mask(const std::vector<uint32_t>& words, int32_t number) {
    shared::Mask mask;
    std::memcpy(&mask, words.data() + size_t(number - 1) * shared::kWordsPerMask, sizeof mask);
    return mask;
}

std::array<uint32_t, 4> bytes(uint32_t word) { return {word & 255, word >> 8 & 255, word >> 16 & 255, word >> 24}; }

TEST(Masks, AWordHasFourNeighbouringOpacities) {
    Masks masks(kPlenty);
    const int32_t repeats = masks.add({0}, 0.5f, kLevels),
                  ends = masks.add({0, scene::Wrap::Clamp, scene::Wrap::Mirror, true}, 0.5f, kLevels);
    const std::vector<uint32_t> words = masks.words();
    const shared::Mask one = mask(words, repeats), other = mask(words, ends);
    EXPECT_EQ(one.size, 4u | 2u << 16);
    EXPECT_EQ(one.kind, 2u << 8);
    EXPECT_EQ(one.cutoff, 0.5f);
    EXPECT_EQ(other.kind, shared::kMaskEnds | shared::kMaskMirrors << 2 | shared::kMaskNearest | 2u << 8);
    using Four = std::array<uint32_t, 4>;
    EXPECT_EQ(bytes(words.at(one.at[0])), (Four{1, 2, 5, 6}));
    EXPECT_EQ(bytes(words.at(one.at[0] + 7)), (Four{8, 5, 4, 1})) << "beyond the last is the first";
    EXPECT_EQ(bytes(words.at(other.at[0] + 7)), (Four{8, 8, 8, 8})) << "beyond the last it is as there";
    EXPECT_EQ(bytes(words.at(one.at[1] + 1)), (Four{30, 20, 30, 20}));
    EXPECT_EQ(other.at[1] + 2, words.size());
}

TEST(Masks, OneUseIsOneMask) {
    Masks masks(kPlenty);
    const int32_t first = masks.add({0}, 0.5f, kLevels);
    const size_t size = masks.words().size();
    EXPECT_EQ(first, 1);
    EXPECT_EQ(masks.add({0}, 0.5f, kLevels), first);
    EXPECT_EQ(masks.words().size(), size);
    EXPECT_EQ(masks.add({0}, 0.4f, kLevels), 2);
    EXPECT_EQ(masks.add({1}, 0.5f, kLevels), 3);
}

TEST(Masks, WhatHasNoRoomIsNotKnown) {
    Masks masks(2 * shared::kWordsPerMask + 20);
    EXPECT_EQ(masks.add({0}, 0.5f, kLevels), 1);
    EXPECT_EQ(masks.add({1}, 0.5f, kLevels), 2);
    EXPECT_EQ(masks.add({2}, 0.5f, kLevels), -1);
    EXPECT_EQ(masks.add({2}, 0.5f, kLevels), -1) << "nor a second time";
    EXPECT_EQ(masks.words().size(), 2 * shared::kWordsPerMask + 20);
}

// 40 of 512 x 512 take some 200 MiB of the 2 GiB that a scene may.
TEST(Masks, ManyFitIntoABudget) {
    const Budget budget("masks");
    Masks masks(1u << 30u);
    const std::vector<OpacityLevel> levels{{512, 512, std::vector<uint8_t>(512 * 512, 9)}};
    for (uint32_t i = 0; i < 40; ++i) EXPECT_EQ(masks.add({i}, 0.5f, levels), int32_t(i + 1));
    const std::vector<OpacityLevel> wide{
        {shared::kMostMaskSide + 1, 1, std::vector<uint8_t>(shared::kMostMaskSide + 1)}};
    EXPECT_EQ(masks.add({40}, 0.5f, wide), -1) << "no level is small enough";
}

TEST(Masks, NoneAreABufferAllTheSame) { EXPECT_FALSE(Masks(kPlenty).words().empty()); }

// Of a large texture only its smaller levels.
TEST(Masks, LargeTexturesBeginWithASmallerLevel) {
    std::vector<OpacityLevel> levels;
    for (uint32_t side = 2 * shared::kMostMaskSide; side >= shared::kMostMaskSide / 2; side /= 2)
        levels.push_back({side, 1, std::vector<uint8_t>(side, 7)});
    Masks masks(kPlenty);
    const shared::Mask large = mask((masks.add({0}, 0.5f, levels), masks.words()), 1);
    EXPECT_EQ(large.size, shared::kMostMaskSide | 1u << 16);
    EXPECT_EQ(large.kind >> 8, 2u);
}

}  // namespace
}  // namespace vesper::test::masks_test
