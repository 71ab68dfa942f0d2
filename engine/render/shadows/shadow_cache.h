// Shadow maps that are kept from run to run. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/cache.h"
#include "graph/executor.h"
#include "render/shadows/draw_shadow_maps.h"

namespace vesper::render {

/// What a whole map depends on beside its lamp: shaders, driver, the scene, the placements that are drawn, which
/// `still` are, and their poses.
Digest::Value shadow_surroundings(const gpu::Device& device, const gpu_scene::GpuScene& scene,
                                  const std::vector<uint32_t>& still, const gpu_scene::SceneFrame& poses);

/// The key of a whole map of what stands still.
Digest::Value shadow_map_key(const Digest::Value& surroundings, const ShadowMapToDraw& map);

/// Maps of lamps that stand still in one frame: those that a cache has, and those that it gets once they are drawn.
struct ShadowCache {
    struct Missing {
        Digest::Value key;
        uint64_t at, bytes;  ///< in drawn_on_host
    };
    std::vector<std::byte> found;       ///< texels
    std::vector<graph::Region> copies;  ///< of these to the texels of all maps, bytes

    std::vector<Missing> missing;
    std::vector<graph::Region> drawn;  ///< of the texels of all maps to `drawn_on_host`
    graph::Resource drawn_on_host;     ///< a readback; none without missing maps

    /// Looks for a map. Returns whether the cache has it.
    bool find(Cache& cache, const Digest::Value& key, const ShadowMapLayout& layout);
    /// Declares copies of those found, before others are drawn.
    void bring(graph::FrameGraph& graph, graph::Resource distances);
    /// Declares copies of the missing ones, once they are drawn and before anything is drawn over them.
    void fetch(graph::FrameGraph& graph, graph::Resource distances);
    /// Gives the missing ones of a finished frame to the cache. Returns a line if the cache failed, once.
    std::string keep(Cache& cache, const graph::Executor& executor) const;
};

}  // namespace vesper::render
