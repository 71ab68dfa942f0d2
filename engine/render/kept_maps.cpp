#include "render/kept_maps.h"

#include <string_view>

#include "gpu/commands.h"

namespace vesper::render {
namespace {

// To be raised whenever code on the host draws other texels: layouts, frames, levels of masks, what is left out.
constexpr uint64_t kMapVersion = 3;

constexpr uint64_t kTexelBytes = sizeof(uint16_t);
// Between host and device; a largest map fits.
constexpr uint64_t kBetweenBytes = 2 * kTexelBytes * gpu_scene::kMostMapSide * gpu_scene::kMostMapSide;

void add_device(Digest& digest, const gpu::Device& device) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.physical(), &properties);
    digest.add_value(properties.vendorID), digest.add_value(properties.deviceID);
    digest.add_value(properties.driverVersion);
    digest.add_value(properties.pipelineCacheUUID);
    digest.add_list(std::string_view(properties.deviceName));
    digest.add_value(device.has_anisotropy());  // of masks
}

// Digests read it, so it is cached on the way to the device, too.
gpu::HostBuffer between(const gpu::Device& device, VkBufferUsageFlags usage) {
    return {device, kBetweenBytes, usage, gpu::HostBuffer::Direction::FromDevice};
}

void copy(const gpu::Device& device, VkBuffer from, VkBuffer to, std::span<const VkBufferCopy> copies) {
    const VkMemoryBarrier2 after{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT};
    device.run_once([&](VkCommandBuffer commands) {
        gpu::pipeline_barrier(commands, {}, &after);
        vkCmdCopyBuffer(commands, from, to, uint32_t(copies.size()), copies.data());
        gpu::pipeline_barrier(commands, {}, &after);
    });
}

Digest::Value map_key(const Digest::Value& surroundings, const MapToDraw& map) {
    const gpu_scene::MapLayout& layout = map.layout;
    Digest digest;
    digest.add_value(surroundings);
    digest.add_value(layout.side), digest.add_value(layout.hemispheres);
    digest.add_value(layout.zoom), digest.add_value(layout.range), digest.add_value(layout.flat);
    digest.add_value(map.frame.position), digest.add_value(map.frame.rotation);
    digest.add_list(map.fixture);
    digest.add_value(map.lamp);
    return digest.value();
}

}  // namespace

Digest::Value map_surroundings(const gpu::Device& device, const gpu_scene::GpuScene& scene,
                               const std::vector<uint32_t>& still, const gpu_scene::SceneFrame& poses) {
    Digest digest;
    digest.add_value(kMapVersion);
    digest.add_list(std::string_view(VESPER_VERSION));
    add_map_shaders(digest);
    add_device(digest, device);
    digest.add_value(scene.occluders());
    digest.add_list(still);
    for (const uint32_t placement : still) digest.add_value(poses.world[scene.placements()[placement].node]);
    return digest.value();
}

bool KeptMaps::find(const MapToDraw& map) {
    const Digest::Value key = map_key(surroundings_, map);
    const uint64_t bytes = kTexelBytes * map.layout.texels();
    if (found_.bytes() == 0) found_ = between(device_, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    if (filled_ + bytes > kBetweenBytes) upload();
    if (!cache_.read(key, {found_.data() + filled_, bytes})) {
        if (cache_.writes()) missing_.push_back({key, map.layout.first, map.layout.texels()});
        return false;
    }
    copies_.push_back({filled_, kTexelBytes * map.layout.first, bytes});
    filled_ += bytes;
    return true;
}

void KeptMaps::upload() {
    if (!copies_.empty()) {
        found_.flush();
        copy(device_, found_.buffer(), distances_, copies_);
    }
    copies_.clear(), filled_ = 0;
}

void KeptMaps::download(std::span<const Missing> maps, const gpu::HostBuffer& to) const {
    std::vector<VkBufferCopy> copies;
    uint64_t at = 0;
    for (const Missing& map : maps) {
        copies.push_back({kTexelBytes * map.first, at, kTexelBytes * map.texels});
        at += kTexelBytes * map.texels;
    }
    copy(device_, distances_, to.buffer(), copies);
    to.invalidate();
}

std::string KeptMaps::keep() {
    if (missing_.empty()) return {};
    found_ = {};
    const gpu::HostBuffer drawn = between(device_, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    for (size_t first = 0, end = 0; first < missing_.size() && cache_.writes(); first = end) {
        uint64_t bytes = 0;
        for (; end < missing_.size() && bytes + kTexelBytes * missing_[end].texels <= kBetweenBytes; ++end)
            bytes += kTexelBytes * missing_[end].texels;
        const std::span<const Missing> maps(&missing_[first], end - first);
        download(maps, drawn);
        const std::byte* texels = drawn.data();
        for (const Missing& map : maps) {
            cache_.write(map.key, {texels, kTexelBytes * map.texels});
            texels += kTexelBytes * map.texels;
        }
    }
    missing_.clear();
    return cache_.settle();
}

}  // namespace vesper::render
