// Distance maps that are kept from run to run. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/cache.h"
#include "gpu/memory.h"
#include "render/passes/distance_map.h"

namespace vesper::render {

/// What a whole map depends on beside its lamp: shaders, driver, the scene, the placements that are drawn, which
/// `still` are, and their poses.
Digest::Value map_surroundings(const gpu::Device& device, const gpu_scene::GpuScene& scene,
                               const std::vector<uint32_t>& still, const gpu_scene::SceneFrame& poses);

/// Maps of lamps that stand still, when they are drawn: taken from a cache, or given to it. For one time that maps are
/// drawn. Throws Error.
class KeptMaps {
public:
    /// `distances`: texels of all maps.
    KeptMaps(const gpu::Device& device, Cache& cache, const Digest::Value& surroundings, VkBuffer distances)
        : device_(device), cache_(cache), surroundings_(surroundings), distances_(distances) {}

    /// Looks for a whole map of what stands still. Returns whether there is one: after upload() it is in its place.
    bool find(const MapToDraw& map);
    void upload();
    /// Keeps the maps that find() did not find, once they are drawn. Returns a line if the cache failed, once.
    std::string keep();

private:
    struct Missing {
        Digest::Value key;
        uint32_t first, texels;  // of all maps
    };
    void download(std::span<const Missing> maps, const gpu::HostBuffer& to) const;

    const gpu::Device& device_;
    Cache& cache_;
    Digest::Value surroundings_;
    VkBuffer distances_;
    gpu::HostBuffer found_;             // on their way to the device
    std::vector<VkBufferCopy> copies_;  // of them
    uint64_t filled_ = 0;               // bytes
    std::vector<Missing> missing_;
};

}  // namespace vesper::render
