// The atlas: shadow maps of all lamps in one buffer of texels. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "gpu/buddy_allocator.h"
#include "graph/frame_graph.h"
#include "render/shadows/shadow_map_layout.h"

namespace vesper::render {

/// Allocates maps, with sides that depend on the view.
class ShadowAtlas {
public:
    /// `scale`: of sides, see choose_sides. `most_texels`: of the buffer; it has no more than the largest maps take.
    ShadowAtlas(std::vector<ShadowMapLayout> layouts, double scale, uint64_t most_texels);

    const ShadowMapLayout& operator[](uint32_t lamp) const { return layouts_[lamp]; }
    uint64_t texels() const { return texels_; }  ///< of the buffer

    struct Change {
        std::vector<uint32_t> lamps;       ///< whose maps have another side, and hold nothing
        std::vector<graph::Region> moves;  ///< of the texels of other maps, bytes, to be made all at once
    };
    /// Fits the sides of the maps of a list to its view. `moving`: of each lamp, whether it does. Returns nothing, and
    /// changes nothing, where maps of the least side do not fit.
    std::optional<Change> fit(const gpu_scene::LampList& list, const std::vector<bool>& moving);

private:
    bool place(std::vector<uint32_t> lamps);
    Change place_all(const gpu_scene::LampList& list, const std::vector<ShadowMapLayout>& wanted,
                     std::vector<uint32_t> changed);

    std::vector<ShadowMapLayout> layouts_;  // of each lamp; side 0: it has no place
    double scale_;
    uint64_t texels_;
    gpu::BuddyAllocator places_;
};

}  // namespace vesper::render
