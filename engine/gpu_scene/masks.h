// Where masked surfaces have holes, for any shader. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "scene/material.h"
#include "shared/masks.h"

namespace vesper::gpu_scene {

/// Opacities of one mip level of a texture, row by row: 255 is 1.
struct OpacityLevel {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> opacities;
};

/// Collects the masks of a scene (shared/masks.h).
class Masks {
public:
    /// Of no more words than `most`.
    explicit Masks(uint64_t most) : most_(most) {}

    /// The number of the mask that a use of a texture with all these levels makes, in which opacity below `cutoff`,
    /// above 0, is a hole; -1 where there is no room for it, or no level is small enough.
    int32_t add(const scene::TextureUse& use, float cutoff, std::span<const OpacityLevel> all);
    /// The buffer; never empty.
    std::vector<uint32_t> words() const;

private:
    using Use = std::tuple<uint32_t, scene::Wrap, scene::Wrap, bool, float>;
    uint64_t most_;
    std::map<Use, int32_t> numbers_;
    std::vector<shared::Mask> masks_;  // their levels from the first word of the first
    std::vector<uint32_t> texels_;
};

}  // namespace vesper::gpu_scene
