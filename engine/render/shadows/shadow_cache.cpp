#include "render/shadows/shadow_cache.h"

#include <string_view>

namespace vesper::render {
namespace {

// To be raised whenever code on the host draws other texels: layouts, frames, levels of masks, what is left out.
constexpr uint64_t kMapVersion = 4;

constexpr uint64_t kTexelBytes = sizeof(uint16_t);

void add_device(Digest& digest, const gpu::Device& device) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.physical(), &properties);
    digest.add_value(properties.vendorID), digest.add_value(properties.deviceID);
    digest.add_value(properties.driverVersion);
    digest.add_value(properties.pipelineCacheUUID);
    digest.add_list(std::string_view(properties.deviceName));
    digest.add_value(device.has_anisotropy());  // of masks
}

}  // namespace

Digest::Value shadow_map_key(const Digest::Value& surroundings, const ShadowMapToDraw& map) {
    const ShadowMapLayout& layout = map.layout;
    Digest digest;
    digest.add_value(surroundings);
    digest.add_value(layout.side), digest.add_value(layout.hemispheres);
    digest.add_value(layout.zoom), digest.add_value(layout.range), digest.add_value(layout.flat);
    digest.add_value(map.frame.position), digest.add_value(map.frame.rotation);
    digest.add_list(map.fixture);
    return digest.value();
}

Digest::Value shadow_surroundings(const gpu::Device& device, const gpu_scene::GpuScene& scene,
                                  const std::vector<uint32_t>& still, const gpu_scene::SceneFrame& poses) {
    Digest digest;
    digest.add_value(kMapVersion);
    digest.add_list(std::string_view(VESPER_VERSION));
    add_shadow_map_shaders(digest);
    add_device(digest, device);
    digest.add_value(scene.occluders());
    digest.add_list(still);
    for (const uint32_t placement : still) digest.add_value(poses.world[scene.placements()[placement].node]);
    return digest.value();
}

bool ShadowCache::find(Cache& cache, const Digest::Value& key, const ShadowMapLayout& layout) {
    const uint64_t bytes = kTexelBytes * layout.texels(), at = found.size();
    found.resize(at + bytes);
    if (cache.read(key, {found.data() + at, bytes})) {
        copies.push_back({at, kTexelBytes * layout.first, bytes});
        return true;
    }
    found.resize(at);
    if (cache.writes()) {
        const uint64_t to = missing.empty() ? 0 : missing.back().at + missing.back().bytes;
        missing.push_back({key, to, bytes});
        drawn.push_back({kTexelBytes * layout.first, to, bytes});
    }
    return false;
}

void ShadowCache::upload(graph::FrameGraph& graph, graph::Resource distances) {
    if (copies.empty()) return;
    graph.copy("copy cached shadow maps", graph.upload("cached shadow maps", std::move(found)), distances,
               std::move(copies));
}

void ShadowCache::read_back(graph::FrameGraph& graph, graph::Resource distances) {
    if (missing.empty()) return;
    drawn_on_host = graph.readback("shadow maps for the cache", missing.back().at + missing.back().bytes);
    graph.copy("read back shadow maps", distances, drawn_on_host, drawn);
}

std::string ShadowCache::store(Cache& cache, const graph::Executor& executor) const {
    if (missing.empty()) return cache.settle();
    const std::span<const std::byte> texels = executor.read(drawn_on_host);
    for (const Missing& map : missing)
        if (cache.writes()) cache.write(map.key, texels.subspan(map.at, map.bytes));
    return cache.settle();
}

}  // namespace vesper::render
