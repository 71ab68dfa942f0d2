// The compute shaders of the frame, made once per device. SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <map>
#include <vector>

#include "gpu/kernel.h"

namespace vesper {

/// Every compute shader, specialized for the device.
struct Kernels {
    Kernel occupancy;
    VkExtent2D shade_group;  ///< invocations per workgroup of the shading kernels: shared::kBlocksPerGroup blocks wide
    uint32_t shade_rows;     ///< pixels of a column that one invocation shades; divides shared::kBlockSize
    /// Bits of a clustering, selecting, gathering or shading kernel: what it has code for. Clustering and selection know kPowers and kMaps,
    /// gathering these, kCones and kRoads.
    enum ShadeVariant : uint32_t {
        kEveryLamp = 1, kCones = 2, kPowers = 4, kMaps = 8, kListed = 16, kGathered = 32, kGlossy = 64, kRoads = 128, kRetro = 256
    };
    /// Made when it is first asked for.
    const Kernel& cluster(uint32_t variant) const;
    const Kernel& select(uint32_t variant) const;
    const Kernel& gather(uint32_t variant) const;
    const Kernel& shade(uint32_t variant) const;
    Kernel picture;
    Kernel sky;
    Kernel daylight;
    Kernel luminaires;
    Kernel pyramid_first, pyramid;
    Kernel colours;
    Kernel acuity;
    uint32_t histogram_rows;        ///< texels of a column that one invocation of the histogram does
    Kernel histogram;
    /// By shared::kModel*. Made when first asked for.
    const Kernel& adapt(uint32_t model) const;
    /// By shared::kTone*. Made when first asked for.
    const Kernel& bright(uint32_t tone) const;
    /// What bands.comp has code for. Made when first asked for.
    struct BandsVariant {
        uint32_t tone = 0;  ///< shared::kTone*
        uint32_t band = 0;  ///< shared::kBand*
        auto operator<=>(const BandsVariant&) const = default;
    };
    const Kernel& bands(const BandsVariant&) const;
    Kernel blur;
    VkExtent2D scatter_up_strip, scatter_down_strip;  ///< texels that one invocation does; down, at most so many rows
    Kernel scatter_up_first, scatter_up, scatter_top, scatter_down, scatter_down_last, scatter_down_wide, scatter_down_wide_last, scatter_edge;
    Kernel corona_tiles, corona_pick, corona;
    uint32_t composite_rows;        ///< pixels of a column that one invocation of the composite does
    /// What the composite and display_light.comp have code for. Made when first asked for.
    struct CompositeVariant {
        uint32_t tone = 0;  ///< shared::kTone*
        bool bloom = false;
        bool primaries = false;  ///< others than Rec. 709
        bool light = false;     ///< display_light.comp
        bool blue_first = false; ///< of the composite
        auto operator<=>(const CompositeVariant&) const = default;
    };
    const Kernel& composite(const CompositeVariant&) const;

    explicit Kernels(const Device& device);

    uint32_t most_groups() const;  ///< workgroups of a dispatch along x

private:
    const Device& device_;
    mutable std::map<uint32_t, Kernel> shade_, cluster_, select_, gather_, adapt_, bright_;
    mutable std::map<BandsVariant, Kernel> bands_;
    mutable std::map<CompositeVariant, Kernel> composite_;
};

}  // namespace vesper
