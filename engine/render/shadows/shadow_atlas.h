// The atlas: shadow maps of all lamps in one buffer of texels. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "gpu/buddy_allocator.h"
#include "graph/frame_graph.h"
#include "render/shadows/shadow_map_layout.h"

namespace vesper::render {

/// Allocates maps, with sides that depend on the view; and, beside them, single tiles of shared::kRegion texels square.
class ShadowAtlas {
public:
    static constexpr uint32_t kTiles = 2048;  ///< 16 MiB
    static constexpr uint32_t kTileTexels = shared::kRegion * shared::kRegion;

    /// `scale`: of sides, see choose_sides.
    ShadowAtlas(std::vector<ShadowMapLayout> layouts, double scale);

    const ShadowMapLayout& operator[](uint32_t lamp) const { return layouts_[lamp]; }
    uint64_t texels() const { return texels_ + uint64_t(kTiles) * kTileTexels; }  ///< of the buffer

    struct Change {
        std::vector<uint32_t> lamps;       ///< whose maps have another side, and hold nothing
        std::vector<graph::Region> moves;  ///< of the texels of other maps, bytes, to be made all at once
    };
    /// Fits the sides of the maps of a list to its view; those of lamps that move, which are drawn in each frame, have
    /// half the side. `moving`: of each lamp, whether it does. `most_texels`: of maps that may change their side,
    /// beside those that have none yet; then maps within a factor of two keep theirs. Throws Error where the maps of
    /// all lamps do not fit kMostMapTexels.
    Change fit(const gpu_scene::LampList& list, uint64_t most_texels, const std::vector<bool>& moving);

    /// First texel of a free tile; nothing if there is none.
    std::optional<uint32_t> allocate();
    void release(uint32_t first) { free_tiles_.push_back(first); }

private:
    bool place(std::vector<uint32_t> lamps);
    Change place_all(const gpu_scene::LampList& list, const std::vector<ShadowMapLayout>& wanted,
                     std::vector<uint32_t> changed);

    std::vector<ShadowMapLayout> layouts_;  // of each lamp; side 0: it has no place
    double scale_;
    uint64_t texels_;  // of maps; tiles follow
    gpu::BuddyAllocator places_;
    std::vector<uint32_t> free_tiles_;  // first texels, the next one last
};

}  // namespace vesper::render
