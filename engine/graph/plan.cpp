// The tables behind Access: what each way of touching a resource is to Vulkan. SPDX-License-Identifier: MIT
#include "graph/plan.h"

#include <array>

namespace vesper::graph {
namespace {

constexpr uint32_t kStageCount = 4;
constexpr std::array<const char*, kStageCount> kStageNames{"compute", "graphics", "transfer", "host"};

struct AccessRow {
    const char* name;
    bool writes;
    VkAccessFlags2 access;
    VkImageLayout layout;
    VkImageUsageFlags image_usage;
    VkBufferUsageFlags buffer_usage, texel_usage;
};

constexpr VkAccessFlags2 kStorageRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
constexpr VkAccessFlags2 kStorageWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
constexpr VkImageUsageFlags kStorage = VK_IMAGE_USAGE_STORAGE_BIT;
constexpr VkBufferUsageFlags kStorageBuffer = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kStorageTexels = VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;

// One row per Access, in its order.
constexpr std::array<AccessRow, kAccessCount> kRows{{
    {"sample", false, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT, VK_IMAGE_LAYOUT_GENERAL,
     VK_IMAGE_USAGE_SAMPLED_BIT, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT},
    {"load", false, kStorageRead, VK_IMAGE_LAYOUT_GENERAL, kStorage, kStorageBuffer, kStorageTexels},
    {"store", true, kStorageWrite, VK_IMAGE_LAYOUT_GENERAL, kStorage, kStorageBuffer, kStorageTexels},
    {"update", true, kStorageRead | kStorageWrite, VK_IMAGE_LAYOUT_GENERAL, kStorage, kStorageBuffer, kStorageTexels},
    // Blending and loading read, so both targets read as well as write.
    {"color-target", true, VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
     VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0, 0},
    {"depth-target", true,
     VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
     VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0, 0},
    {"copy-source", false, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
     VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VK_BUFFER_USAGE_TRANSFER_SRC_BIT},
    {"copy-target", true, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_TRANSFER_DST_BIT,
     VK_BUFFER_USAGE_TRANSFER_DST_BIT, VK_BUFFER_USAGE_TRANSFER_DST_BIT},
    {"copy-part", true, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_TRANSFER_DST_BIT,
     VK_BUFFER_USAGE_TRANSFER_DST_BIT, VK_BUFFER_USAGE_TRANSFER_DST_BIT},
    {"read", false, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_GENERAL, 0, 0, 0},
    {"vertices", false, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_GENERAL, 0,
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
    {"arguments", false, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, VK_IMAGE_LAYOUT_GENERAL, 0,
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
}};

const AccessRow& row(Access access) { return kRows[static_cast<size_t>(access)]; }

VkPipelineStageFlags2 graphics_stages(Access access) {
    switch (access) {
        case Access::ColorTarget:
            return VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
        case Access::DepthTarget:
            return VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
        case Access::Vertices:
            return VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT;
        case Access::Arguments:
            return VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
        default:
            return VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    }
}

VkPipelineStageFlags2 vulkan_stages(Stage stage, Access access) {
    switch (stage) {
        case Stage::Compute:
            return access == Access::Arguments ? VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT
                                               : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
        case Stage::Graphics:
            return graphics_stages(access);
        case Stage::Transfer:
            return VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;  // copies and fills
        case Stage::Host:
            return VK_PIPELINE_STAGE_2_HOST_BIT;
    }
    return VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
}

/// Calls visit(stage, access) for each pair of the set, in order.
template <class Visit>
void for_each(const AccessSet& set, Visit visit) {
    for (uint32_t s = 0; s < kStageCount; ++s)
        for (uint32_t a = 0; a < kAccessCount; ++a)
            if (set.has(static_cast<Stage>(s), static_cast<Access>(a)))
                visit(static_cast<Stage>(s), static_cast<Access>(a));
}

}  // namespace

bool writes(Access access) { return row(access).writes; }
VkImageLayout layout_of(Access access) { return row(access).layout; }
VkImageUsageFlags image_usage_of(Access access) { return row(access).image_usage; }
VkBufferUsageFlags buffer_usage_of(Access access, bool texels) {
    return texels ? row(access).texel_usage : row(access).buffer_usage;
}

bool AccessSet::writes() const {
    bool any = false;
    for_each(*this, [&](Stage, Access access) { any = any || row(access).writes; });
    return any;
}

VkPipelineStageFlags2 AccessSet::stages() const {
    VkPipelineStageFlags2 flags = 0;
    for_each(*this, [&](Stage stage, Access access) { flags |= vulkan_stages(stage, access); });
    return flags;
}

VkAccessFlags2 AccessSet::accesses() const {
    VkAccessFlags2 flags = 0;
    for_each(*this, [&](Stage, Access access) { flags |= row(access).access; });
    return flags;
}

std::string AccessSet::text() const {
    std::string text;
    for_each(*this, [&](Stage stage, Access access) {
        if (!text.empty()) text += '|';
        text += std::string(kStageNames[static_cast<size_t>(stage)]) + ' ' + row(access).name;
    });
    return text.empty() ? "nothing" : text;
}

}  // namespace vesper::graph
