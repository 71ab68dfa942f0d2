#include "render/shadows/shadow_atlas.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace vesper::render {
namespace {

// Pieces of the buffer are powers of two of the least map, which has one tile.
constexpr uint32_t kPiece = shared::kTileTexels;
constexpr uint64_t kBytesOfTexel = sizeof(uint16_t);
static_assert(kLeastMapSide == shared::kRegion);

uint32_t size_of(const ShadowMapLayout& layout) { return uint32_t(std::countr_zero(layout.texels() / kPiece)); }

uint64_t largest_texels(const std::vector<ShadowMapLayout>& layouts) {
    uint64_t texels = 0;
    for (ShadowMapLayout layout : layouts) {
        layout.side = layout.range > 0 ? kMostMapSide : 0;
        texels += layout.texels();
    }
    return texels;
}

}  // namespace

ShadowAtlas::ShadowAtlas(std::vector<ShadowMapLayout> layouts, double scale, uint64_t most_texels)
    : layouts_(std::move(layouts)),
      scale_(scale),
      texels_(std::clamp<uint64_t>(largest_texels(layouts_), kPiece, most_texels / kPiece * kPiece)),
      places_(uint32_t(texels_ / kPiece)) {}

std::optional<ShadowAtlas::Change> ShadowAtlas::fit(const gpu_scene::LampList& list, const std::vector<bool>& moving) {
    std::vector<ShadowMapLayout> wanted;
    std::vector<double> distances;
    for (uint32_t i = 0; i < list.placed(); ++i) {
        wanted.push_back(layouts_[list.indices[i]]);
        wanted.back().moves = moving[list.indices[i]];
        distances.push_back(double(glm::length(list.lamps[i].position)));
    }
    if (least_texels(wanted) > texels_) return std::nullopt;
    choose_sides(wanted, distances, scale_, texels_);
    std::vector<uint32_t> changed;
    for (uint32_t i = 0; i < list.placed(); ++i) {
        ShadowMapLayout& layout = layouts_[list.indices[i]];
        if (layout.side == wanted[i].side) continue;
        if (layout.side != 0) places_.give(layout.first / kPiece, size_of(layout));
        layout.side = wanted[i].side;
        changed.push_back(list.indices[i]);
    }
    if (place(changed)) return Change{std::move(changed), {}};
    return place_all(list, wanted, std::move(changed));
}

// Where there is no place, lamps that do not shine lose theirs and the others find new ones, the largest first: with
// the sides that the view wants these always fit.
ShadowAtlas::Change ShadowAtlas::place_all(const gpu_scene::LampList& list, const std::vector<ShadowMapLayout>& wanted,
                                           std::vector<uint32_t> changed) {
    const std::vector<ShadowMapLayout> before = layouts_;
    std::vector<bool> holds(layouts_.size(), true);
    for (const uint32_t lamp : changed) holds[lamp] = false;
    places_.clear();
    for (ShadowMapLayout& layout : layouts_) layout.side = 0;
    Change change;
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < list.placed(); ++i) {
        const uint32_t lamp = list.indices[i];
        layouts_[lamp].side = wanted[i].side;
        all.push_back(lamp);
        if (!holds[lamp] || before[lamp].side != wanted[i].side) change.lamps.push_back(lamp);
    }
    place(all);
    for (const uint32_t lamp : all) {
        const ShadowMapLayout &from = before[lamp], &to = layouts_[lamp];
        if (holds[lamp] && to.side != 0 && from.side == to.side && from.first != to.first)
            change.moves.push_back({kBytesOfTexel * from.first, kBytesOfTexel * to.first, kBytesOfTexel * to.texels()});
    }
    return change;
}

bool ShadowAtlas::place(std::vector<uint32_t> lamps) {
    std::ranges::stable_sort(lamps, std::greater(), [&](uint32_t lamp) { return layouts_[lamp].texels(); });
    for (const uint32_t lamp : lamps) {
        if (layouts_[lamp].side == 0) continue;
        const std::optional<uint32_t> at = places_.take(size_of(layouts_[lamp]));
        if (!at) return false;
        layouts_[lamp].first = *at * kPiece;
    }
    return true;
}

}  // namespace vesper::render
