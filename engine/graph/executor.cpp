#include "graph/executor.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/stopwatch.h"

namespace vesper {
namespace {

constexpr uint64_t kSliceAlignment = 256;  // at least every minimum offset alignment Vulkan allows a device to ask for
constexpr VkBufferUsageFlags kHostUsage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                          VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                          VK_BUFFER_USAGE_INDEX_BUFFER_BIT;

uint64_t align_up(uint64_t value, uint64_t alignment) { return (value + alignment - 1) / alignment * alignment; }

bool is_texel(uint32_t usage) {
    return usage & (VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
}

OwnedBufferView view_texels(const Device& device, VkBuffer buffer, VkFormat format, uint64_t offset, uint64_t bytes) {
    const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                      .buffer = buffer,
                                      .format = format,
                                      .offset = offset,
                                      .range = bytes};
    VkBufferView view = VK_NULL_HANDLE;
    check(vkCreateBufferView(device.handle(), &info, nullptr, &view), "viewing a texel buffer");
    return {device.handle(), view};
}

}  // namespace

// A transient owns its objects; everything else borrows them from a history or a host buffer.
struct Executor::Realized {
    OwnedImage owned_image;
    OwnedImageView owned_view;
    OwnedBuffer owned_buffer;
    OwnedBufferView texels;
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    uint64_t offset = 0, bytes = 0;
};

struct Executor::Past {
    Shape shape;
    uint32_t usage;
    Arena arena;
    OwnedImage images[2];
    OwnedImageView views[2];
    OwnedBuffer buffers[2];
    int current = 0;  // the half the next frame writes

    Past(const Device& device, const Shape& s, uint32_t u) : shape(s), usage(u), arena(device) {
        for (int half : {0, 1}) {
            if (s.is_image()) {
                images[half] = make_image(device, image_info(s.format, s.extent, 1, u));
                arena.bind(images[half].get());
                views[half] = make_view(device, images[half].get(), s.format);
            } else {
                buffers[half] = make_buffer(device, s.bytes, u);
                arena.bind(buffers[half].get());
            }
        }
        zero(device);
    }

    void zero(const Device& device) const {
        device.run_once([&](VkCommandBuffer commands) {
            for (int half : {0, 1}) {
                if (!shape.is_image()) {
                    vkCmdFillBuffer(commands, buffers[half].get(), 0, VK_WHOLE_SIZE, 0);
                    continue;
                }
                const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
                const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                                    .dstStageMask = VK_PIPELINE_STAGE_2_CLEAR_BIT,
                                                    .dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                                    .newLayout = VK_IMAGE_LAYOUT_GENERAL,
                                                    .image = images[half].get(),
                                                    .subresourceRange = all};
                const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                                  .imageMemoryBarrierCount = 1,
                                                  .pImageMemoryBarriers = &barrier};
                vkCmdPipelineBarrier2(commands, &dependency);
                const VkClearColorValue black{};
                vkCmdClearColorImage(commands, images[half].get(), VK_IMAGE_LAYOUT_GENERAL, &black, 1, &all);
            }
        });
    }
};

class Executor::FrameRecording final : public Recording {
public:
    explicit FrameRecording(const Executor& executor) : executor_(executor) {}
    VkCommandBuffer commands() const override { return executor_.commands_; }
    VkImage image(Resource r) const override { return executor_.resources_[r.index].image; }
    VkImageView view(Resource r) const override { return executor_.resources_[r.index].view; }
    VkBuffer buffer(Resource r) const override { return executor_.resources_[r.index].buffer; }
    uint64_t offset(Resource r) const override { return executor_.resources_[r.index].offset; }

private:
    const Executor& executor_;
};

Executor::Executor(Device& device) : device_(device) {
    const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                      .magFilter = VK_FILTER_LINEAR,
                                      .minFilter = VK_FILTER_LINEAR,
                                      .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    VkSampler raw_sampler = VK_NULL_HANDLE;
    check(vkCreateSampler(device.handle(), &sampler, nullptr, &raw_sampler), "making a sampler");
    sampler_ = {device.handle(), raw_sampler};

    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .queueFamilyIndex = device.queue_family()};
    VkCommandPool raw_pool = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, &raw_pool), "making a command pool");
    pool_ = {device.handle(), raw_pool};
    const VkCommandBufferAllocateInfo allocate_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                    .commandPool = raw_pool,
                                                    .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                    .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device.handle(), &allocate_info, &commands_), "making a command buffer");

    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence raw_fence = VK_NULL_HANDLE;
    check(vkCreateFence(device.handle(), &fence, nullptr, &raw_fence), "making a fence");
    fence_ = {device.handle(), raw_fence};
}

Executor::~Executor() = default;

Measure Executor::measure() const {
    return [this](const Shape& shape, uint32_t usage) -> Footprint {
        VkMemoryRequirements2 needs{.sType = VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
        if (shape.is_image()) {
            const VkImageCreateInfo info = image_info(shape.format, shape.extent, 1, usage);
            const VkDeviceImageMemoryRequirements query{
                .sType = VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS, .pCreateInfo = &info};
            vkGetDeviceImageMemoryRequirements(device_.handle(), &query, &needs);
        } else {
            const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = shape.bytes, .usage = usage};
            const VkDeviceBufferMemoryRequirements query{
                .sType = VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS, .pCreateInfo = &info};
            vkGetDeviceBufferMemoryRequirements(device_.handle(), &query, &needs);
        }
        const VkMemoryRequirements& m = needs.memoryRequirements;
        // Images and buffers share the heap, so each keeps to pages of its own.
        return {m.size, std::max(m.alignment, device_.limits().bufferImageGranularity), m.memoryTypeBits};
    };
}

void Executor::run(const FrameGraph& graph) {
    Stopwatch watch;
    plan_ = graph.compile(measure());
    place(graph);
    realize_histories(graph);
    realize_uploads(graph);
    realize_externals(graph);
    realize_readbacks(graph);
    host_times_.plan = watch.lap();
    record(graph);
    host_times_.record = watch.lap();
    finish(graph);
}

void Executor::place(const FrameGraph& graph) {
    // Everything the transients' objects are made from; names and contents of passes may change freely.
    std::string key = std::to_string(graph.resources().size());
    for (const Plan::Heap& heap : plan_.heaps) key += " h" + std::to_string(heap.bytes) + "," + std::to_string(heap.memory_types);
    for (const Plan::Placement& p : plan_.placements) {
        const Shape& s = graph.resources()[p.resource].shape;
        for (const uint64_t part : {uint64_t(p.resource), uint64_t(p.heap), p.offset, uint64_t(s.format),
                                    uint64_t(s.extent.width), uint64_t(s.extent.height), s.bytes, uint64_t(plan_.usage[p.resource])})
            key += " " + std::to_string(part);
    }
    if (key == placed_key_) return;

    placed_key_.clear();
    resources_.clear();
    heaps_.clear();
    for (const Plan::Heap& heap : plan_.heaps)
        heaps_.push_back(allocate(device_, heap.bytes, device_.memory_type(heap.memory_types, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)));
    resources_.resize(graph.resources().size());
    for (const Plan::Placement& p : plan_.placements) {
        const Shape& shape = graph.resources()[p.resource].shape;
        const uint32_t usage = plan_.usage[p.resource];
        Realized& r = resources_[p.resource];
        if (shape.is_image()) {
            r.owned_image = make_image(device_, image_info(shape.format, shape.extent, 1, usage));
            check(vkBindImageMemory(device_.handle(), r.owned_image.get(), heaps_[p.heap].get(), p.offset), "placing an image");
            r.owned_view = make_view(device_, r.owned_image.get(), shape.format);
            r.image = r.owned_image.get(), r.view = r.owned_view.get(), r.aspect = aspect_of(shape.format);
        } else {
            r.owned_buffer = make_buffer(device_, shape.bytes, usage);
            check(vkBindBufferMemory(device_.handle(), r.owned_buffer.get(), heaps_[p.heap].get(), p.offset), "placing a buffer");
            if (is_texel(usage)) r.texels = view_texels(device_, r.owned_buffer.get(), shape.format, 0, shape.bytes);
            r.buffer = r.owned_buffer.get(), r.bytes = shape.bytes;
        }
    }
    placed_key_ = std::move(key);
}

void Executor::realize_histories(const FrameGraph& graph) {
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::HistoryCurrent || !plan_.usage[i]) continue;
        uint32_t usage = plan_.usage[i] | plan_.usage[info.partner];
        usage |= info.shape.is_image() ? uint32_t(VK_IMAGE_USAGE_TRANSFER_DST_BIT) : uint32_t(VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        auto& past = histories_[info.name];
        if (!past || !(past->shape == info.shape) || past->usage != usage) past = std::make_unique<Past>(device_, info.shape, usage);
        for (const auto& [index, half] : {std::pair{i, past->current}, std::pair{info.partner, 1 - past->current}}) {
            Realized& r = resources_[index];
            r.image = past->images[half].get(), r.view = past->views[half].get();
            r.buffer = past->buffers[half].get(), r.offset = 0, r.bytes = info.shape.bytes;
            r.texels = is_texel(usage) && r.buffer ? view_texels(device_, r.buffer, info.shape.format, 0, r.bytes) : OwnedBufferView();
        }
        past->current = 1 - past->current;
    }
}

void Executor::realize_uploads(const FrameGraph& graph) {
    uint64_t total = 0;
    for (const auto& info : graph.resources())
        if (info.origin == FrameGraph::Origin::Upload) total = align_up(total, kSliceAlignment) + info.contents.size();
    if (uploads_.bytes() < total)
        uploads_ = HostBuffer(device_, align_up(total * 3 / 2, kSliceAlignment), kHostUsage, HostBuffer::Direction::ToDevice);
    uint64_t offset = 0;
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::Upload) continue;
        offset = align_up(offset, kSliceAlignment);
        std::memcpy(uploads_.data() + offset, info.contents.data(), info.contents.size());
        Realized& r = resources_[i];
        r.buffer = uploads_.buffer(), r.offset = offset, r.bytes = info.contents.size();
        r.texels = is_texel(plan_.usage[i]) ? view_texels(device_, r.buffer, info.shape.format, offset, r.bytes) : OwnedBufferView();
        offset += r.bytes;
    }
    if (total) uploads_.flush();
}

void Executor::realize_externals(const FrameGraph& graph) {
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::External) continue;
        Realized& r = resources_[i];
        r.buffer = info.buffer, r.offset = 0, r.bytes = info.shape.bytes;
        r.texels = is_texel(plan_.usage[i]) ? view_texels(device_, r.buffer, info.shape.format, 0, r.bytes) : OwnedBufferView();
    }
}

void Executor::realize_readbacks(const FrameGraph& graph) {
    uint64_t total = 0;
    for (const auto& info : graph.resources())
        if (info.origin == FrameGraph::Origin::Readback) total = align_up(total, kSliceAlignment) + info.shape.bytes;
    if (readbacks_.bytes() < total)
        readbacks_ = HostBuffer(device_, total, kHostUsage, HostBuffer::Direction::FromDevice);
    uint64_t offset = 0;
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::Readback) continue;
        offset = align_up(offset, kSliceAlignment);
        Realized& r = resources_[i];
        r.buffer = readbacks_.buffer(), r.offset = offset, r.bytes = info.shape.bytes;
        offset += r.bytes;
    }
}

void Executor::record(const FrameGraph& graph) {
    check(vkResetCommandPool(device_.handle(), pool_.get(), 0), "recording");
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vkBeginCommandBuffer(commands_, &begin), "recording");
    const uint32_t query_count = (uint32_t(plan_.steps.size()) + 1) * 2;
    const bool timed = device_.has_timestamps() && !plan_.steps.empty();
    if (timed && query_capacity_ < query_count) {
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = query_count};
        VkQueryPool raw = VK_NULL_HANDLE;
        check(vkCreateQueryPool(device_.handle(), &info, nullptr, &raw), "making timestamps");
        queries_ = {device_.handle(), raw};
        query_capacity_ = query_count;
    }
    if (timed) vkCmdResetQueryPool(commands_, queries_.get(), 0, query_count);

    // Before the first pass and after each. lavapipe writes a time down no sooner than it comes to the next one, so each has a second behind it.
    const auto mark = [&](uint32_t boundary) {
        for (uint32_t i = 0; timed && i < 2; ++i) vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), 2 * boundary + i);
    };
    const FrameRecording recording(*this);
    mark(0);
    for (uint32_t i = 0; i < plan_.steps.size(); ++i) {
        const Plan::Step& step = plan_.steps[i];
        const FrameGraph::PassInfo& pass = graph.passes()[step.pass];
        record_barriers(step.barriers);
        switch (pass.kind) {
            case FrameGraph::PassKind::Dispatch: record_dispatch(pass); break;
            case FrameGraph::PassKind::Raster: record_raster(graph, step); break;
            case FrameGraph::PassKind::Transfer: pass.record(recording); break;
        }
        mark(i + 1);
    }
    record_barriers(plan_.final_barriers);
    check(vkEndCommandBuffer(commands_), "recording");
}

void Executor::record_barriers(const std::vector<Plan::Barrier>& barriers) const {
    VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    std::vector<VkImageMemoryBarrier2> images;
    for (const Plan::Barrier& b : barriers) {
        const Realized& r = resources_[b.resource];
        if (r.image && b.old_layout != b.new_layout)
            images.push_back({.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                              .srcStageMask = b.from.stages(),
                              .srcAccessMask = b.from.accesses(),
                              .dstStageMask = b.to.stages(),
                              .dstAccessMask = b.to.accesses(),
                              .oldLayout = b.old_layout,
                              .newLayout = b.new_layout,
                              .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                              .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                              .image = r.image,
                              .subresourceRange = {r.aspect, 0, 1, 0, 1}});
        // The bytes of a new transient may have belonged to something else, which an image barrier does not speak of.
        if (!b.from.empty() && (b.discard || b.old_layout == b.new_layout)) {
            memory.srcStageMask |= b.from.stages(), memory.srcAccessMask |= b.from.accesses();
            memory.dstStageMask |= b.to.stages(), memory.dstAccessMask |= b.to.accesses();
        }
    }
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .memoryBarrierCount = memory.srcStageMask ? 1u : 0u,
                                      .pMemoryBarriers = &memory,
                                      .imageMemoryBarrierCount = uint32_t(images.size()),
                                      .pImageMemoryBarriers = images.data()};
    if (memory.srcStageMask || !images.empty()) vkCmdPipelineBarrier2(commands_, &dependency);
}

void Executor::record_dispatch(const FrameGraph::PassInfo& pass) const {
    const Kernel& kernel = static_cast<const Kernel&>(*pass.kernel);
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    const size_t bound = kernel.bindings.size();
    std::vector<VkDescriptorImageInfo> images(bound);
    std::vector<VkDescriptorBufferInfo> buffers(bound);
    std::vector<VkBufferView> texels(bound);
    std::vector<VkWriteDescriptorSet> writes;
    for (uint32_t i = 0; i < bound; ++i) {
        const Realized& r = resources_[pass.uses[i].resource.index];
        images[i] = {sampler_.get(), r.view, VK_IMAGE_LAYOUT_GENERAL};
        buffers[i] = {r.buffer, r.offset, r.bytes};
        texels[i] = r.texels.get();
        writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                          .dstBinding = i,
                          .descriptorCount = 1,
                          .descriptorType = kernel.bindings[i],
                          .pImageInfo = &images[i],
                          .pBufferInfo = &buffers[i],
                          .pTexelBufferView = &texels[i]});
    }
    device_.push_descriptors(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, uint32_t(writes.size()), writes.data());
    if (!pass.push.empty())
        vkCmdPushConstants(commands_, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, uint32_t(pass.push.size()), pass.push.data());
    if (!pass.is_indirect()) return vkCmdDispatch(commands_, pass.groups.x, pass.groups.y, pass.groups.z);
    const Realized& arguments = resources_[pass.uses.back().resource.index];
    vkCmdDispatchIndirect(commands_, arguments.buffer, arguments.offset + pass.arguments_offset);
}

void Executor::record_raster(const FrameGraph& graph, const Plan::Step& step) const {
    const FrameGraph::PassInfo& pass = graph.passes()[step.pass];
    std::vector<VkRenderingAttachmentInfo> colors;
    VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    VkExtent2D extent{};
    for (size_t i = 0; i < pass.uses.size(); ++i) {
        const Use& use = pass.uses[i];
        if (use.access != Access::ColorTarget && use.access != Access::DepthTarget) continue;
        extent = graph.resources()[use.resource.index].shape.extent;
        const VkRenderingAttachmentInfo attachment{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                                   .imageView = resources_[use.resource.index].view,
                                                   .imageLayout = layout_of(use.access),
                                                   .loadOp = step.first_use[i] ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
                                                   .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                   .clearValue = use.clear};
        if (use.access == Access::ColorTarget)
            colors.push_back(attachment);
        else
            depth = attachment;
    }
    const VkRect2D area{{0, 0}, extent};
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = area,
                               .layerCount = 1,
                               .colorAttachmentCount = uint32_t(colors.size()),
                               .pColorAttachments = colors.data(),
                               .pDepthAttachment = depth.imageView ? &depth : nullptr};
    vkCmdBeginRendering(commands_, &info);
    const VkViewport viewport{0, 0, float(extent.width), float(extent.height), 0, 1};
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdSetScissor(commands_, 0, 1, &area);
    pass.record(FrameRecording(*this));
    vkCmdEndRendering(commands_);
}

void Executor::finish(const FrameGraph& graph) {
    const VkCommandBufferSubmitInfo submitted{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, .commandBuffer = commands_};
    const VkSubmitInfo2 submit{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted};
    const VkFence fence = fence_.get();
    Stopwatch watch;
    check(vkQueueSubmit2(device_.queue(), 1, &submit, fence), "submitting a frame");
    host_times_.submit = watch.lap();
    check(vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX), "waiting for a frame");
    check(vkResetFences(device_.handle(), 1, &fence), "waiting for a frame");
    host_times_.wait = watch.lap();
    if (readbacks_.bytes()) readbacks_.invalidate();

    timings_.clear();
    if (!device_.has_timestamps() || plan_.steps.empty()) return;
    std::vector<uint64_t> ticks((plan_.steps.size() + 1) * 2);
    check(vkGetQueryPoolResults(device_.handle(), queries_.get(), 0, uint32_t(ticks.size()), ticks.size() * sizeof(uint64_t),
                                ticks.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "reading timestamps");
    for (size_t i = 0; i < plan_.steps.size(); ++i) {
        const Plan::Step& step = plan_.steps[i];
        timings_.push_back({graph.passes()[step.pass].name,
                            double(ticks[2 * (i + 1)] - ticks[2 * i]) * double(device_.limits().timestampPeriod) * 1e-6,
                            step.bytes_read, step.bytes_written});
    }
}

std::span<const std::byte> Executor::read(Resource readback) const {
    const Realized& r = resources_.at(readback.index);
    if (r.buffer != readbacks_.buffer()) throw Error("a resource that is not a readback cannot be read");
    return {readbacks_.data() + r.offset, r.bytes};
}

void Executor::reset(const std::string& history) {
    if (const auto found = histories_.find(history); found != histories_.end()) found->second->zero(device_);
}

uint64_t Executor::heap_bytes() const {
    uint64_t total = 0;
    for (const Plan::Heap& heap : plan_.heaps) total += heap.bytes;
    return total;
}

}  // namespace vesper
