// Shadow maps that outlast a run. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/cache.h"
#include "graph/executor.h"
#include "render/shadows/draw_shadow_maps.h"

namespace vesper::render {

/// A digest of all that a whole map depends on beside its lamp: shaders, driver, the scene, the placements that are
/// drawn, which are `still`, and their poses.
Digest::Value shadow_surroundings(const gpu::Device& device, const gpu_scene::GpuScene& scene,
                                  const std::vector<uint32_t>& still, const gpu_scene::SceneFrame& poses);

/// The key of a whole map of what stands still.
Digest::Value shadow_map_key(const Digest::Value& surroundings, const ShadowMapToDraw& map);

/// The exchange of one frame with a cache of maps of lamps that stand still: maps that the cache has, and maps that it
/// gets once they are drawn.
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
    /// Declares copies of the maps found, before others are drawn.
    void upload(graph::FrameGraph& graph, graph::Resource distances);
    /// Declares copies of the missing maps, once they are drawn and before anything is drawn over them.
    void read_back(graph::FrameGraph& graph, graph::Resource distances);
    /// Gives the missing maps of a finished frame to the cache. Returns a line if the cache failed, once.
    std::string store(Cache& cache, const graph::Executor& executor) const;
};

}  // namespace vesper::render
