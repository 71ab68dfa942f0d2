#include "gpu/memory.h"

#include <algorithm>
#include <cstring>

namespace vesper::gpu {
namespace {

uint64_t align_up(uint64_t value, uint64_t alignment) { return (value + alignment - 1) / alignment * alignment; }

}  // namespace

OwnedMemory::OwnedMemory(const Device& device, VkDeviceMemory memory, uint64_t bytes)
    : memory_(device.handle(), memory), use_(&device.use()), bytes_(bytes) {
    use_->bytes += bytes;
    use_->peak_bytes = std::max(use_->peak_bytes, use_->bytes);
}

OwnedMemory allocate(const Device& device, uint64_t bytes, uint32_t memory_type) {
    const VkMemoryAllocateInfo info{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = bytes, .memoryTypeIndex = memory_type};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device.handle(), &info, nullptr, &memory),
          "allocating " + std::to_string(bytes >> 20) + " MiB on " + device.name());
    ++device.use().objects;
    return {device, memory, bytes};
}

OwnedBuffer make_buffer(const Device& device, uint64_t bytes, VkBufferUsageFlags usage) {
    const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device.handle(), &info, nullptr, &buffer), "making a buffer");
    ++device.use().objects;
    return {device, buffer};
}

VkBufferView OwnedBuffer::texels(VkFormat format, uint64_t offset, uint64_t bytes) const {
    for (const View& v : views_)
        if (v.format == format && v.offset == offset && v.bytes == bytes) return v.view.get();
    const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                      .buffer = get(),
                                      .format = format,
                                      .offset = offset,
                                      .range = bytes};
    VkBufferView view = VK_NULL_HANDLE;
    check(vkCreateBufferView(device_->handle(), &info, nullptr, &view), "viewing a texel buffer");
    ++device_->use().objects;
    views_.push_back({format, offset, bytes, {device_->handle(), view}});
    return view;
}

VkImageCreateInfo image_info(VkFormat format, VkExtent2D extent, uint32_t levels, VkImageUsageFlags usage) {
    return {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
            .imageType = VK_IMAGE_TYPE_2D,
            .format = format,
            .extent = {extent.width, extent.height, 1},
            .mipLevels = levels,
            .arrayLayers = 1,
            .samples = VK_SAMPLE_COUNT_1_BIT,
            .tiling = VK_IMAGE_TILING_OPTIMAL,
            .usage = usage};
}

OwnedImage make_image(const Device& device, const VkImageCreateInfo& info) {
    const uint32_t limit = device.limits().maxImageDimension2D;
    if (info.extent.width > limit || info.extent.height > limit)
        throw Error("an image of " + std::to_string(info.extent.width) + "x" + std::to_string(info.extent.height) +
                    " is too large for " + device.name() + ", which takes " + std::to_string(limit) + " px a side");
    VkImage image = VK_NULL_HANDLE;
    check(vkCreateImage(device.handle(), &info, nullptr, &image), "making an image");
    ++device.use().objects;
    return {device.handle(), image};
}

VkImageAspectFlags aspect_of(VkFormat format) {
    return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

OwnedImageView make_view(const Device& device, VkImage image, VkFormat format, uint32_t levels) {
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format,
                                     .subresourceRange = {aspect_of(format), 0, levels, 0, 1}};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(device.handle(), &info, nullptr, &view), "viewing an image");
    ++device.use().objects;
    return {device.handle(), view};
}

HostBuffer::HostBuffer(const Device& device, uint64_t bytes, VkBufferUsageFlags usage, Direction direction)
    : device_(device.handle()), buffer_(make_buffer(device, bytes, usage)), bytes_(bytes) {
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer_.get(), &needs);
    const VkMemoryPropertyFlags preferred =
        direction == Direction::FromDevice ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const uint32_t type = device.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, preferred);
    coherent_ = device.is_coherent(type);
    memory_ = allocate(device, needs.size, type);
    check(vkBindBufferMemory(device_, buffer_.get(), memory_.get(), 0), "binding a buffer");
    void* data = nullptr;
    check(vkMapMemory(device_, memory_.get(), 0, VK_WHOLE_SIZE, 0, &data), "mapping a buffer");
    data_ = static_cast<std::byte*>(data);
}

void HostBuffer::flush() const {
    if (coherent_) return;
    const VkMappedMemoryRange range{
        .sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE, .memory = memory_.get(), .size = VK_WHOLE_SIZE};
    check(vkFlushMappedMemoryRanges(device_, 1, &range), "flushing a buffer");
}

void HostBuffer::invalidate() const {
    if (coherent_) return;
    const VkMappedMemoryRange range{
        .sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE, .memory = memory_.get(), .size = VK_WHOLE_SIZE};
    check(vkInvalidateMappedMemoryRanges(device_, 1, &range), "invalidating a buffer");
}

void Arena::bind(VkBuffer buffer) {
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_->handle(), buffer, &needs);
    const auto [memory, offset] = place(needs);
    check(vkBindBufferMemory(device_->handle(), buffer, memory, offset), "binding a buffer");
}

void Arena::bind(VkImage image) {
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_->handle(), image, &needs);
    const auto [memory, offset] = place(needs);
    check(vkBindImageMemory(device_->handle(), image, memory, offset), "binding an image");
}

std::pair<VkDeviceMemory, uint64_t> Arena::place(const VkMemoryRequirements& needs) {
    // Buffers and images may lie side by side: the granularity keeps them on pages of their own.
    const uint64_t alignment = std::max(needs.alignment, device_->limits().bufferImageGranularity);
    const uint32_t type = device_->memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    for (Block& block : blocks_) {
        const uint64_t offset = align_up(block.used, alignment);
        if (block.type != type || offset + needs.size > block.bytes) continue;
        block.used = offset + needs.size;
        return {block.memory.get(), offset};
    }
    const uint64_t bytes = std::max(needs.size, block_);
    blocks_.push_back({allocate(*device_, bytes, type), type, needs.size, bytes});
    bytes_ += bytes;
    return {blocks_.back().memory.get(), 0};
}

OwnedBuffer upload_buffer(const Device& device, Arena& arena, std::span<const std::byte> bytes,
                          VkBufferUsageFlags usage) {
    OwnedBuffer buffer = make_buffer(device, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    arena.bind(buffer.get());
    const HostBuffer staging(device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HostBuffer::Direction::ToDevice);
    std::memcpy(staging.data(), bytes.data(), bytes.size());
    staging.flush();
    device.run_once([&](VkCommandBuffer commands) {
        const VkBufferCopy region{.size = bytes.size()};
        vkCmdCopyBuffer(commands, staging.buffer(), buffer.get(), 1, &region);
    });
    return buffer;
}

}  // namespace vesper::gpu
