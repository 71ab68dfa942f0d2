// The executor's commands: passes, what they wait for, and the borders of a frame. SPDX-License-Identifier: MIT
#include <vector>

#include "graph/realized.h"

namespace vesper::graph {

class Executor::FrameRecording final : public Recording {
public:
    explicit FrameRecording(const Executor& executor) : executor_(executor) {}
    VkCommandBuffer commands() const override { return executor_.slot_->commands; }
    void bind(const gpu::GraphicsPipeline& pipeline, std::span<VkWriteDescriptorSet> writes) const override {
        executor_.slot_->descriptors.bind(commands(), pipeline, writes);
    }
    VkImage image(Resource r) const override { return executor_.resources_[r.index].image; }
    VkImageView view(Resource r) const override { return executor_.resources_[r.index].view; }
    VkBuffer buffer(Resource r) const override { return executor_.resources_[r.index].buffer->get(); }
    uint64_t offset(Resource r) const override { return executor_.resources_[r.index].offset; }
    uint64_t bytes(Resource r) const override { return executor_.resources_[r.index].bytes; }

private:
    const Executor& executor_;
};

void Executor::record(const FrameGraph& graph, bool among_others) {
    const bool timed = device_.has_timestamps() && !plan_.steps.empty();
    slot_->begin(timed ? (uint32_t(plan_.steps.size()) + 1) * 2 : 0);
    const VkCommandBuffer commands = slot_->commands;
    if (among_others) record_border(graph, Border::Enter);
    record_clearing();

    // Before the first pass and after each. lavapipe writes a time down no sooner than it comes to the next one, so
    // each has a second behind it.
    const auto mark = [&](uint32_t boundary) {
        for (uint32_t i = 0; timed && i < 2; ++i)
            vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot_->queries.get(),
                                 2 * boundary + i);
    };
    const FrameRecording recording(*this);
    mark(0);
    for (uint32_t i = 0; i < plan_.steps.size(); ++i) {
        const Plan::Step& step = plan_.steps[i];
        const FrameGraph::PassInfo& pass = graph.passes()[step.pass];
        record_barriers(step.barriers);
        switch (pass.kind) {
            case FrameGraph::PassKind::Dispatch:
                record_dispatch(graph, pass);
                break;
            case FrameGraph::PassKind::Raster:
                record_raster(graph, step);
                break;
            case FrameGraph::PassKind::Transfer:
                pass.record(recording);
                break;
        }
        mark(i + 1);
    }
    record_barriers(plan_.final_barriers);
    if (among_others) record_border(graph, Border::Leave);

    slot_->timings.clear();
    for (const Plan::Step& step : plan_.steps)
        if (timed) slot_->timings.push_back({graph.passes()[step.pass].name, 0, step.bytes_read, step.bytes_written});
}

// What a plan says holds within it: at its borders everything waits for everything, and images of others change between
// their layout and ours.
void Executor::record_border(const FrameGraph& graph, Border border) const {
    constexpr gpu::Touch before{gpu::kWholeBarrier.srcStageMask, gpu::kWholeBarrier.srcAccessMask},
        after{gpu::kWholeBarrier.dstStageMask, gpu::kWholeBarrier.dstAccessMask};
    std::vector<VkImageMemoryBarrier2> images;
    for (const auto& info : graph.resources()) {
        const ExternalImage& image = info.external_image;
        const VkImageLayout from = border == Border::Enter ? image.before : VK_IMAGE_LAYOUT_GENERAL;
        const VkImageLayout to = border == Border::Enter ? VK_IMAGE_LAYOUT_GENERAL : image.after;
        if (image.image && from != to) images.push_back(gpu::image_barrier(image.image, before, after, from, to));
    }
    gpu::pipeline_barrier(slot_->commands, images, &gpu::kWholeBarrier);
}

void Executor::record_barriers(const std::vector<Plan::Barrier>& barriers) const {
    VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    std::vector<VkImageMemoryBarrier2> images;
    for (const Plan::Barrier& b : barriers) {
        const Realized& r = resources_[b.resource];
        if (r.image && b.old_layout != b.new_layout)
            images.push_back(gpu::image_barrier(r.image, {b.from.stages(), b.from.accesses()},
                                                {b.to.stages(), b.to.accesses()}, b.old_layout, b.new_layout,
                                                r.aspect));
        // The bytes of a new transient may have belonged to something else, which an image barrier does not speak of.
        if (!b.from.empty() && (b.discard || b.old_layout == b.new_layout)) {
            memory.srcStageMask |= b.from.stages(), memory.srcAccessMask |= b.from.accesses();
            memory.dstStageMask |= b.to.stages(), memory.dstAccessMask |= b.to.accesses();
        }
    }
    if (memory.srcStageMask || !images.empty())
        gpu::pipeline_barrier(slot_->commands, images, memory.srcStageMask ? &memory : nullptr);
}

void Executor::record_dispatch(const FrameGraph& graph, const FrameGraph::PassInfo& pass) const {
    const gpu::Kernel& kernel = static_cast<const gpu::Kernel&>(*pass.kernel);
    vkCmdBindPipeline(slot_->commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    const size_t bound = kernel.bindings.size();
    std::vector<VkDescriptorImageInfo> images(bound);
    std::vector<VkDescriptorBufferInfo> buffers(bound);
    std::vector<VkBufferView> texels(bound);
    std::vector<VkWriteDescriptorSet> writes;
    for (uint32_t i = 0; i < bound; ++i) {
        const Use& use = pass.uses[i];
        const Realized& r = resources_[use.resource.index];
        images[i] = {sampler_.get(), r.view, VK_IMAGE_LAYOUT_GENERAL};
        if (r.buffer) buffers[i] = {r.buffer->get(), r.offset, r.bytes};
        if (kernel.bindings[i] == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER ||
            kernel.bindings[i] == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER)
            texels[i] = r.buffer->texels(graph.resources()[use.resource.index].shape.format, r.offset, r.viewed_bytes);
        writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                          .dstBinding = i,
                          .descriptorCount = 1,
                          .descriptorType = kernel.bindings[i],
                          .pImageInfo = &images[i],
                          .pBufferInfo = &buffers[i],
                          .pTexelBufferView = &texels[i]});
    }
    slot_->descriptors.bind(slot_->commands, kernel, writes);
    if (!pass.push.empty())
        vkCmdPushConstants(slot_->commands, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, uint32_t(pass.push.size()),
                           pass.push.data());
    if (!pass.is_indirect()) return vkCmdDispatch(slot_->commands, pass.groups.x, pass.groups.y, pass.groups.z);
    const Realized& arguments = resources_[pass.uses.back().resource.index];
    vkCmdDispatchIndirect(slot_->commands, arguments.buffer->get(), arguments.offset + pass.arguments_offset);
}

void Executor::record_raster(const FrameGraph& graph, const Plan::Step& step) const {
    const FrameGraph::PassInfo& pass = graph.passes()[step.pass];
    std::vector<VkRenderingAttachmentInfo> colors;
    VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    VkExtent2D extent = pass.extent;
    for (size_t i = 0; i < pass.uses.size(); ++i) {
        const Use& use = pass.uses[i];
        if (use.access != Access::ColorTarget && use.access != Access::DepthTarget) continue;
        extent = graph.resources()[use.resource.index].shape.extent;
        const VkRenderingAttachmentInfo attachment{
            .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = resources_[use.resource.index].view,
            .imageLayout = layout_of(use.access),
            .loadOp = step.first_use[i] || use.renew ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
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
    vkCmdBeginRendering(slot_->commands, &info);
    const VkViewport viewport{0, 0, float(extent.width), float(extent.height), 0, 1};
    vkCmdSetViewport(slot_->commands, 0, 1, &viewport);
    vkCmdSetScissor(slot_->commands, 0, 1, &area);
    pass.record(FrameRecording(*this));
    vkCmdEndRendering(slot_->commands);
}

}  // namespace vesper::graph
