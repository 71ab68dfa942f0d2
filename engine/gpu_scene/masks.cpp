#include "gpu_scene/masks.h"

#include <algorithm>
#include <cstring>

#include "base/budget.h"

namespace vesper::gpu_scene {
namespace {

constexpr uint64_t kCopies = 4;  // here, in words(), on the way to the device, and there

uint32_t kind_of(scene::Wrap wrap) {
    switch (wrap) {
        case scene::Wrap::Mirror:
            return shared::kMaskMirrors;
        case scene::Wrap::Clamp:
            return shared::kMaskEnds;
        default:
            return shared::kMaskRepeats;
    }
}

uint32_t after(uint32_t i, uint32_t size, scene::Wrap wrap) {
    if (i + 1 < size) return i + 1;
    return wrap == scene::Wrap::Repeat ? 0 : size - 1;
}

}  // namespace

int32_t Masks::add(const scene::TextureUse& use, float cutoff, std::span<const OpacityLevel> all) {
    const auto [known, is_new] = numbers_.try_emplace(Use(use.image, use.wrap_u, use.wrap_v, use.nearest, cutoff), -1);
    if (!is_new) return known->second;
    std::span<const OpacityLevel> levels = all;
    while (levels.size() > 1 && std::max(levels[0].width, levels[0].height) > shared::kMostMaskSide)
        levels = levels.subspan(1);
    const bool smaller = levels.size() < all.size();
    if (std::max(levels[0].width, levels[0].height) > shared::kMostMaskSide) return -1;
    levels = levels.first(std::min<size_t>(levels.size(), shared::kMostMaskLevels));
    uint64_t texels = 0;
    for (const OpacityLevel& level : levels) texels += level.opacities.size();
    const uint64_t words = shared::kWordsPerMask + texels;
    if (shared::kWordsPerMask * masks_.size() + texels_.size() + words > most_) return -1;
    spend(kCopies * words * sizeof(uint32_t));
    shared::Mask mask{levels[0].width | levels[0].height << 16,
                      kind_of(use.wrap_u) | kind_of(use.wrap_v) << 2 |
                          (use.nearest && !smaller ? shared::kMaskNearest : 0) | uint32_t(levels.size()) << 8,
                      cutoff,
                      {}};
    for (size_t l = 0; l < levels.size(); ++l) {
        const OpacityLevel& level = levels[l];
        mask.at[l] = uint32_t(texels_.size());
        for (uint32_t y = 0; y < level.height; ++y)
            for (uint32_t x = 0; x < level.width; ++x) {
                const uint32_t right = after(x, level.width, use.wrap_u), below = after(y, level.height, use.wrap_v);
                const auto at = [&](uint32_t column, uint32_t row) {
                    return uint32_t(level.opacities[size_t(row) * level.width + column]);
                };
                texels_.push_back(at(x, y) | at(right, y) << 8 | at(x, below) << 16 | at(right, below) << 24);
            }
    }
    masks_.push_back(mask);
    return known->second = int32_t(masks_.size());
}

std::vector<uint32_t> Masks::words() const {
    std::vector<uint32_t> words(std::max<size_t>(masks_.size(), 1) * shared::kWordsPerMask);
    for (size_t i = 0; i < masks_.size(); ++i) {
        shared::Mask mask = masks_[i];
        for (uint32_t& at : mask.at) at += uint32_t(words.size());
        std::memcpy(words.data() + i * shared::kWordsPerMask, &mask, sizeof mask);
    }
    words.insert(words.end(), texels_.begin(), texels_.end());
    return words;
}

}  // namespace vesper::gpu_scene
