// The frame graph: a frame is declared once, as resources and passes in the order they run.
// SPDX-License-Identifier: MIT
// A declared frame is compiled to a Plan (graph/plan.h), which knows no device; an Executor (graph/executor.h) runs it.
#pragma once

#include <cstring>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/kernel_interface.h"
#include "graph/plan.h"

namespace vesper::gpu {
class GraphicsPipeline;
class OwnedBuffer;
}  // namespace vesper::gpu
namespace vesper::graph {

/// A handle on a declared resource: copy it, pass it, compare it. Valid for the graph that made it.
struct Resource {
    uint32_t index = ~0u;
    bool operator==(const Resource&) const = default;
    explicit operator bool() const { return index != ~0u; }
};

/// Something that outlives the frame: what the last frame left, and what this frame leaves.
struct History {
    Resource previous, current;
};

/// What a resource is made of: an image, or a buffer of so many bytes (with a texel format if read as a texel buffer).
struct Shape {
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{0, 0};  ///< px; 0 x 0 for a buffer
    uint64_t bytes = 0;       ///< of a buffer

    bool is_image() const { return extent.width != 0; }
    bool operator==(const Shape& o) const {
        return format == o.format && extent.width == o.extent.width && extent.height == o.extent.height &&
               bytes == o.bytes;
    }
};

/// Bytes of one tightly packed texel; 0 for formats the engine does not copy.
uint64_t texel_bytes(VkFormat format);
/// Bytes of a buffer, or of an image when tightly packed; 0 for formats the engine does not copy.
uint64_t packed_bytes(const Shape& shape);

inline Shape image_shape(VkFormat format, VkExtent2D extent) { return {format, extent, 0}; }
inline Shape buffer_shape(uint64_t bytes, VkFormat texel = VK_FORMAT_UNDEFINED) { return {texel, {0, 0}, bytes}; }

/// An image that the engine does not own; its first level of the first layer is used. A frame with such images waits
/// for all work that was submitted to the queue before it, and later work waits for the frame.
struct ExternalImage {
    VkImage image = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{0, 0};                                                              ///< px
    VkImageLayout before = VK_IMAGE_LAYOUT_UNDEFINED, after = VK_IMAGE_LAYOUT_UNDEFINED;  ///< the frame
};

/// One use of a resource by a pass. For a dispatch, use i is binding i of the kernel.
struct Use {
    Resource resource;
    Access access;
    VkClearValue clear{};  ///< of a target or a cleared buffer, on its first use in the frame
    bool renew = false;    ///< of a target: it is cleared on this use, too
};

inline Use sample(Resource r) { return {r, Access::Sample}; }
inline Use load(Resource r) { return {r, Access::Load}; }
inline Use store(Resource r) { return {r, Access::Store}; }
inline Use update(Resource r) { return {r, Access::Update}; }

/// Part of a buffer that is copied to another, bytes.
struct Region {
    uint64_t from = 0, to = 0, bytes = 0;
};

/// Workgroups of a dispatch.
struct Groups {
    uint32_t x = 1, y = 1, z = 1;
};

/// Workgroups that cover `width` x `height` invocations with groups of `group_x` x `group_y`.
constexpr Groups cover(uint32_t width, uint32_t height, uint32_t group_x, uint32_t group_y) {
    return {(width + group_x - 1) / group_x, (height + group_y - 1) / group_y, 1};
}

/// Workgroups of a dispatch as a pass before it wrote them: three words (VkDispatchIndirectCommand) of a buffer.
struct Arguments {
    Resource buffer;
    uint64_t offset = 0;  ///< bytes, a multiple of 4
};

/// What a recording callback may ask for while its pass runs. Implemented by the executor.
class Recording {
public:
    virtual ~Recording() = default;
    virtual VkCommandBuffer commands() const = 0;
    /// Descriptors of the next draws, to all bindings of the pipeline.
    virtual void bind(const gpu::GraphicsPipeline&, std::span<VkWriteDescriptorSet> writes) const = 0;
    virtual VkImage image(Resource) const = 0;
    virtual VkImageView view(Resource) const = 0;
    virtual VkBuffer buffer(Resource) const = 0;
    virtual uint64_t offset(Resource) const = 0;  ///< of a buffer resource within buffer(), bytes
    virtual uint64_t bytes(Resource) const = 0;   ///< of it
};
using Record = std::function<void(const Recording&)>;

/// Declares one frame. Throws Error, naming pass and resource, for every misuse that can be seen without a device.
class FrameGraph {
public:
    enum class Origin : uint8_t {
        Transient,
        Upload,
        External,
        Target,
        Readback,
        HistoryPrevious,
        HistoryCurrent,
        Persistent
    };
    enum class PassKind : uint8_t { Dispatch, Raster, Transfer };

    struct ResourceInfo {
        std::string name;
        Shape shape;
        Origin origin = Origin::Transient;
        uint32_t partner = ~0u;                    ///< of a history: the other half
        std::vector<std::byte> contents;           ///< of an upload
        const gpu::OwnedBuffer* buffer = nullptr;  ///< of an external or persistent buffer
        ExternalImage external_image;              ///< of an external image or a target
        uint32_t reserved_usage = 0;               ///< of a reserved transient: VkImageUsageFlags or VkBufferUsageFlags
        bool kept = false;
    };
    /// Whether a resource of this origin holds something before any pass of the frame has written it.
    static bool is_filled(Origin origin) {
        return origin == Origin::Upload || origin == Origin::External || origin == Origin::HistoryPrevious ||
               origin == Origin::Persistent;
    }
    struct PassInfo {
        std::string name;
        PassKind kind = PassKind::Dispatch;
        std::vector<Use> uses;  ///< of an indirect dispatch the last is its arguments, not a binding
        const gpu::KernelInterface* kernel = nullptr;  ///< of a dispatch
        std::vector<std::byte> push;
        Groups groups;
        uint64_t arguments_offset = 0;  ///< of an indirect dispatch, bytes
        Record record;                  ///< of a raster or transfer pass
        VkExtent2D extent{};            ///< of a raster pass without targets, px

        bool is_indirect() const { return !uses.empty() && uses.back().access == Access::Arguments; }
    };

    /// A resource that lives within the frame and shares memory with others that do not overlap it.
    Resource transient(std::string_view name, const Shape& shape);
    /// A transient that has its place from the start of the frame on, also in frames in which no pass uses it: passes
    /// that only some frames have change no place of other resources, and nothing is made for them. `uses`: all that
    /// passes of any frame do with it.
    Resource reserved(std::string_view name, const Shape& shape, std::initializer_list<Access> uses);
    /// A buffer the host fills before the frame. `contents` is copied; at least one byte.
    Resource upload(std::string_view name, std::span<const std::byte> contents, VkFormat texel = VK_FORMAT_UNDEFINED);
    template <class T>
    Resource upload(std::string_view name, const std::vector<T>& values, VkFormat texel = VK_FORMAT_UNDEFINED) {
        return upload(name, std::as_bytes(std::span(values)), texel);
    }
    /// The same without a copy.
    Resource upload(std::string_view name, std::vector<std::byte>&& contents);
    /// A buffer that was filled before the frame; passes may only read it. It must outlive the frame.
    Resource external(std::string_view name, const gpu::OwnedBuffer& buffer, uint64_t bytes,
                      VkFormat texel = VK_FORMAT_UNDEFINED);
    /// A buffer that outlives the frame with all that passes change in it. The frame is made for those passes, too.
    Resource persistent(std::string_view name, const gpu::OwnedBuffer& buffer, uint64_t bytes,
                        VkFormat texel = VK_FORMAT_UNDEFINED);
    /// An external image, filled by what was handed to the queue earlier.
    Resource external(std::string_view name, const ExternalImage& image);
    /// An external image that passes write; it is kept. Its former content is lost.
    Resource target(std::string_view name, const ExternalImage& image);
    /// A buffer the host can read when the frame is done. It is kept.
    Resource readback(std::string_view name, uint64_t bytes);
    /// A resource kept from frame to frame under its name; zero before the first frame.
    History history(std::string_view name, const Shape& shape);

    /// A compute pass. Use i is binding i of the kernel: the list is both the dependencies and the descriptors.
    void dispatch(std::string_view name, const gpu::KernelInterface& kernel, std::initializer_list<Use> uses,
                  std::span<const std::byte> push, Groups groups);
    template <class Push>
    void dispatch(std::string_view name, const gpu::KernelInterface& kernel, std::initializer_list<Use> uses,
                  const Push& push, Groups groups) {
        dispatch(name, kernel, uses, std::as_bytes(std::span(&push, 1)), groups);
    }
    /// The same for as many workgroups as an earlier pass found. More than the device allows are for that pass to
    /// prevent.
    template <class Push>
    void dispatch(std::string_view name, const gpu::KernelInterface& kernel, std::initializer_list<Use> uses,
                  const Push& push, Arguments arguments) {
        dispatch_indirect(name, kernel, uses, std::as_bytes(std::span(&push, 1)), arguments);
    }
    void dispatch(std::string_view name, const gpu::KernelInterface& kernel, std::initializer_list<Use> uses,
                  Groups groups) {
        dispatch(name, kernel, uses, std::span<const std::byte>{}, groups);
    }
    void dispatch(std::string_view name, const gpu::KernelInterface& kernel, std::initializer_list<Use> uses,
                  Arguments arguments) {
        dispatch_indirect(name, kernel, uses, {}, arguments);
    }
    /// A raster pass: its targets are bound, cleared on their first use, and `record` draws. `extent`: of one without
    /// targets, px.
    void raster(std::string_view name, std::vector<Use> uses, Record record, VkExtent2D extent = {});
    /// Fills a buffer with zeros.
    void clear(std::string_view name, Resource buffer);
    /// Fills parts of a buffer (Region::to, bytes) with a word, and keeps the rest.
    void fill(std::string_view name, Resource buffer, uint32_t word, std::vector<Region> regions);
    /// Copies an image or buffer, tightly packed, into a buffer of the same size; or a buffer into an image; or the
    /// bits of an image into another of the same extent and bytes.
    void copy(std::string_view name, Resource from, Resource to);
    /// Copies parts of a buffer to another, which keeps the rest. Parts must not overlap in `to`.
    void copy(std::string_view name, Resource from, Resource to, std::vector<Region> regions);

    /// The frame is made for this resource; passes that do not contribute to a kept one are not run.
    void keep(Resource resource);

    const std::vector<ResourceInfo>& resources() const { return resources_; }
    const std::vector<PassInfo>& passes() const { return passes_; }

    /// Orders, culls, synchronizes and places the frame. `measure` tells what a resource occupies.
    Plan compile(const Measure& measure) const;
    /// The plan as text, for people and for tests.
    std::string describe(const Plan& plan) const;

private:
    Resource add(std::string_view name, const Shape& shape, Origin origin);
    void add_pass(PassInfo pass);
    void dispatch_indirect(std::string_view name, const gpu::KernelInterface& kernel, std::initializer_list<Use> uses,
                           std::span<const std::byte> push, Arguments arguments);

    std::vector<ResourceInfo> resources_;
    std::vector<PassInfo> passes_;
};

}  // namespace vesper::graph
