// A compiled frame as plain data: what runs, what it waits for, where everything lies. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace vesper::graph {

/// How a pass touches a resource.
enum class Access : uint8_t {
    Sample,       ///< read through a sampler or as a uniform texel buffer or uniform buffer
    Load,         ///< read as a storage image or storage buffer
    Store,        ///< written whole, as a storage image, storage texel buffer or storage buffer
    Update,       ///< read and written as storage
    ColorTarget,  ///< colour attachment
    DepthTarget,  ///< depth attachment, tested and written
    CopySource,
    CopyTarget,  ///< written whole by a copy, or cleared
    CopyPart,    ///< written in part by a copy; the rest stays
    HostRead,    ///< read by the host after the frame
    Vertices,    ///< read as vertex, instance or index data
    Arguments,   ///< read as how many workgroups a dispatch has, or vertices a draw
};
constexpr uint32_t kAccessCount = 12;

/// Who touches it: dispatches, draws and copies run in different stages.
enum class Stage : uint8_t { Compute, Graphics, Transfer, Host };

/// A set of (stage, access) pairs.
class AccessSet {
public:
    void add(Stage stage, Access access) { bits_ |= bit(stage, access); }
    void add(AccessSet other) { bits_ |= other.bits_; }
    bool has(Stage stage, Access access) const { return (bits_ & bit(stage, access)) != 0; }
    bool empty() const { return bits_ == 0; }
    bool writes() const;  ///< true if any access in the set writes
    bool operator==(const AccessSet&) const = default;

    VkPipelineStageFlags2 stages() const;  ///< as Vulkan stages
    VkAccessFlags2 accesses() const;       ///< as Vulkan accesses
    std::string text() const;              ///< "compute store|graphics sample"

private:
    static uint64_t bit(Stage stage, Access access) {
        return 1ull << (static_cast<uint32_t>(stage) * kAccessCount + static_cast<uint32_t>(access));
    }
    uint64_t bits_ = 0;
};

bool writes(Access access);              ///< changes the contents
VkImageLayout layout_of(Access access);  ///< GENERAL except for targets
VkImageUsageFlags image_usage_of(Access access);
VkBufferUsageFlags buffer_usage_of(Access access, bool texels);

/// What a resource occupies in which kind of memory. memory_types is Vulkan's memoryTypeBits.
struct Footprint {
    uint64_t bytes = 0, alignment = 1;
    uint32_t memory_types = ~0u;
};

struct Shape;
/// Tells the footprint of a transient of this shape used in these ways (VkImageUsageFlags or VkBufferUsageFlags).
using Measure = std::function<Footprint(const Shape& shape, uint32_t usage)>;

/// Pure data; every index is into FrameGraph::resources() or passes(). Its barriers hold between frames only while the
/// same plan runs on one queue: before another plan, wait for all commands. Uploads and readbacks belong to one frame
/// in flight each.
struct Plan {
    struct Barrier {
        uint32_t resource = 0;
        AccessSet from;  ///< what to wait for; empty: nothing has touched it or its memory
        AccessSet to;    ///< what waits
        VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED, new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
        bool discard = false;  ///< first use of a transient: old contents are not kept
    };
    struct Step {
        uint32_t pass = 0;
        std::vector<Barrier> barriers;  ///< before the pass
        std::vector<bool> first_use;    ///< per use of the pass: contents are new, targets are cleared
        /// What the pass must move: sizes of the resources it reads, and of those it writes, each once. Bytes.
        uint64_t bytes_read = 0, bytes_written = 0;
    };
    struct Placement {
        uint32_t resource = 0;
        uint32_t heap = 0;  ///< index into heaps
        uint64_t offset = 0, bytes = 0;
    };
    struct Heap {
        uint32_t memory_types = ~0u;
        uint64_t bytes = 0, alignment = 1;
    };

    std::vector<Step> steps;              ///< in declaration order
    std::vector<uint32_t> dropped;        ///< passes that feed nothing kept
    std::vector<Barrier> final_barriers;  ///< after the last step: what the host reads
    std::vector<Placement> placements;    ///< of live transients
    std::vector<Heap> heaps;
    std::vector<uint32_t> usage;  ///< per resource: VkImageUsageFlags or VkBufferUsageFlags; 0 if dead
    uint64_t bytes_without_aliasing = 0;
};

}  // namespace vesper::graph
