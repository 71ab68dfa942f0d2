// Declaring a frame, and every mistake that can be seen while doing so. SPDX-License-Identifier: MIT
#include "graph/frame_graph.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/error.h"

namespace vesper::graph {
namespace {

using PassInfo = FrameGraph::PassInfo;
using PassKind = FrameGraph::PassKind;
using ResourceInfo = FrameGraph::ResourceInfo;
using Origin = FrameGraph::Origin;

bool is_depth(VkFormat format) {
    return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT && format != VK_FORMAT_S8_UINT;
}

struct TexelBytes {
    VkFormat format;
    uint64_t bytes;
};
constexpr TexelBytes kTexelBytes[] = {
    {VK_FORMAT_R8_UNORM, 1},
    {VK_FORMAT_R16_SFLOAT, 2},
    {VK_FORMAT_R8G8B8A8_UNORM, 4},
    {VK_FORMAT_R8G8B8A8_SRGB, 4},
    {VK_FORMAT_R16G16_SFLOAT, 4},
    {VK_FORMAT_R32_SFLOAT, 4},
    {VK_FORMAT_R32_UINT, 4},
    {VK_FORMAT_D32_SFLOAT, 4},
    {VK_FORMAT_R16G16B16A16_SFLOAT, 8},
    {VK_FORMAT_R32G32_SFLOAT, 8},
    {VK_FORMAT_R32G32_UINT, 8},
    {VK_FORMAT_R32G32B32A32_SFLOAT, 16},
    {VK_FORMAT_R32G32B32A32_UINT, 16},
    {VK_FORMAT_B8G8R8A8_UNORM, 4},
    {VK_FORMAT_B8G8R8A8_SRGB, 4},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, 4},
    {VK_FORMAT_A8B8G8R8_SRGB_PACK32, 4},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, 4},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, 4},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, 4},
    {VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, 4},
};

std::string in_quotes(std::string_view name) { return "'" + std::string(name) + "'"; }

[[noreturn]] void fail(const PassInfo& pass, const std::string& reason) {
    throw Error("pass " + in_quotes(pass.name) + " " + reason);
}

bool is_target(Access access) { return access == Access::ColorTarget || access == Access::DepthTarget; }
bool is_read_first(Access access) {
    return access != Access::Store && access != Access::CopyTarget && access != Access::CopyPart && !is_target(access);
}

bool allowed(PassKind kind, Access access) {
    switch (access) {
        case Access::Sample:
        case Access::Load:
        case Access::Store:
        case Access::Update:
            return kind != PassKind::Transfer;
        case Access::Arguments:
            return kind != PassKind::Transfer;
        case Access::ColorTarget:
        case Access::DepthTarget:
        case Access::Vertices:
            return kind == PassKind::Raster;
        case Access::CopySource:
        case Access::CopyTarget:
        case Access::CopyPart:
            return kind == PassKind::Transfer;
        case Access::HostRead:
            return false;
    }
    return false;
}

std::string access_name(PassKind kind, Access access) {
    AccessSet one;
    one.add(kind == PassKind::Dispatch ? Stage::Compute
            : kind == PassKind::Raster ? Stage::Graphics
                                       : Stage::Transfer,
            access);
    return one.text();
}

/// What a use may not do to a resource of this origin and shape.
void check_use(const PassInfo& pass, const Use& use, const ResourceInfo& r) {
    if (!allowed(pass.kind, use.access))
        fail(pass, "cannot use " + in_quotes(r.name) + " as " + access_name(pass.kind, use.access));
    if (writes(use.access) && r.origin == Origin::HistoryPrevious)
        fail(pass, "writes " + in_quotes(r.name) + ", which the last frame left; write its current");
    if (writes(use.access) && r.origin == Origin::Upload) fail(pass, "writes the upload " + in_quotes(r.name));
    if (writes(use.access) && r.origin == Origin::External)
        fail(pass, "writes " + in_quotes(r.name) + ", which is external");
    if (use.access == Access::Vertices && r.shape.is_image())
        fail(pass, "reads vertices from the image " + in_quotes(r.name));
    if (!is_target(use.access)) return;
    if (!r.shape.is_image()) fail(pass, "has the buffer " + in_quotes(r.name) + " as a target");
    if (r.origin != Origin::Transient)
        fail(pass, "has the history " + in_quotes(r.name) + " as a target; draw to a transient");
    if ((use.access == Access::DepthTarget) != is_depth(r.shape.format))
        fail(pass, "has " + in_quotes(r.name) + " as a target its format does not fit");
}

/// Why this descriptor cannot be filled by this use; empty if it can.
std::string mismatch(VkDescriptorType type, Access access, const Shape& shape) {
    bool sampled = false, image = false, texels = false;
    const char* kind = "";
    switch (type) {
        case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
            sampled = true, image = true, kind = "a sampled image";
            break;
        case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
            sampled = true, image = true, kind = "a sampled image";
            break;
        case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
            sampled = true, texels = true, kind = "a uniform texel buffer";
            break;
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
            sampled = true, kind = "a uniform buffer";
            break;
        case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
            image = true, kind = "a storage image";
            break;
        case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
            texels = true, kind = "a storage texel buffer";
            break;
        case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
            kind = "a storage buffer";
            break;
        default:
            return "a descriptor of a kind the engine does not use";
    }
    if (sampled != (access == Access::Sample) || image != shape.is_image()) return kind;
    if (texels && shape.format == VK_FORMAT_UNDEFINED) return std::string(kind) + ", which needs a texel format";
    return {};
}

/// Texels that a kernel reads from a storage buffer (glsl/texels.glsl) are loaded, not sampled.
void load_texels(PassInfo& pass, const std::vector<ResourceInfo>& resources) {
    if (!pass.kernel->texels_in_storage) return;
    const size_t bound = std::min(pass.uses.size(), pass.kernel->bindings.size());
    for (size_t i = 0; i < bound; ++i) {
        const Shape& shape = resources[pass.uses[i].resource.index].shape;
        const bool texels = !shape.is_image() && shape.format != VK_FORMAT_UNDEFINED;
        if (texels && pass.uses[i].access == Access::Sample &&
            pass.kernel->bindings[i] == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
            pass.uses[i].access = Access::Load;
    }
}

void check_kernel(const PassInfo& pass, const std::vector<ResourceInfo>& resources) {
    const gpu::KernelInterface& kernel = *pass.kernel;
    const size_t bound = pass.uses.size() - (pass.is_indirect() ? 1 : 0);
    if (bound != kernel.bindings.size())
        fail(pass, "has " + std::to_string(bound) + " uses, but " + kernel.name + " has " +
                       std::to_string(kernel.bindings.size()) + " bindings");
    for (size_t i = 0; i < bound; ++i) {
        const ResourceInfo& r = resources[pass.uses[i].resource.index];
        const std::string wanted = mismatch(kernel.bindings[i], pass.uses[i].access, r.shape);
        if (!wanted.empty())
            fail(pass, "gives " + in_quotes(r.name) + " as " + access_name(pass.kind, pass.uses[i].access) + " of " +
                           (r.shape.is_image() ? "an image" : "a buffer") + " to binding " + std::to_string(i) +
                           " of " + kernel.name + ": it is " + wanted);
    }
    if (pass.push.size() != kernel.push_bytes)
        fail(pass, "pushes " + std::to_string(pass.push.size()) + " bytes, but " + kernel.name + " takes " +
                       std::to_string(kernel.push_bytes));
    if (pass.groups.x == 0 || pass.groups.y == 0 || pass.groups.z == 0) fail(pass, "dispatches zero groups");
}

void check_targets(const PassInfo& pass, const std::vector<ResourceInfo>& resources) {
    const ResourceInfo* first = nullptr;
    uint32_t depths = 0;
    for (const Use& use : pass.uses) {
        if (!is_target(use.access)) continue;
        const ResourceInfo& r = resources[use.resource.index];
        if (!first) first = &r;
        if (r.shape.extent.width != first->shape.extent.width || r.shape.extent.height != first->shape.extent.height)
            fail(pass, "has targets " + in_quotes(first->name) + " and " + in_quotes(r.name) + " of different extents");
        if (use.access == Access::DepthTarget && ++depths > 1)
            fail(pass, "has a second depth target, " + in_quotes(r.name));
    }
    const bool has_extent = pass.extent.width > 0 && pass.extent.height > 0;
    if (!first && !has_extent) fail(pass, "has no target");
    if (first && has_extent) fail(pass, "has a target, " + in_quotes(first->name) + ", and an extent of its own");
}

/// A copy, without its commands, among so many resources.
PassInfo copying(std::string_view name, Resource from, const Use& to, size_t resources) {
    PassInfo pass{std::string(name), PassKind::Transfer, {{from, Access::CopySource}, to}, nullptr, {}, {}, 0, {}};
    if (from.index >= resources) fail(pass, "has no valid resource to copy from");
    if (to.resource.index >= resources) fail(pass, "has no valid resource to copy to");
    return pass;
}

VkBufferImageCopy whole_image(const Shape& shape, uint64_t offset) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    const VkImageAspectFlags aspect = is_depth(shape.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    region.imageSubresource = {aspect, 0, 0, 1};
    region.imageExtent = {shape.extent.width, shape.extent.height, 1};
    return region;
}

}  // namespace

uint64_t texel_bytes(VkFormat format) {
    const auto found = std::ranges::find(kTexelBytes, format, &TexelBytes::format);
    return found == std::end(kTexelBytes) ? 0 : found->bytes;
}

uint64_t packed_bytes(const Shape& shape) {
    if (!shape.is_image()) return shape.bytes;
    return texel_bytes(shape.format) * shape.extent.width * shape.extent.height;
}

Resource FrameGraph::add(std::string_view name, const Shape& shape, Origin origin) {
    if (name.empty()) throw Error("a resource has no name");
    for (const ResourceInfo& r : resources_)
        if (r.name == name) throw Error("resource " + in_quotes(name) + " is declared twice");
    const bool image = shape.extent.width != 0 || shape.extent.height != 0;
    if (image ? shape.extent.width == 0 || shape.extent.height == 0 : shape.bytes == 0)
        throw Error("resource " + in_quotes(name) + " has no size");
    if (image && shape.bytes != 0) throw Error("resource " + in_quotes(name) + " is both image and buffer");
    if (image && shape.format == VK_FORMAT_UNDEFINED) throw Error("image " + in_quotes(name) + " has no format");
    ResourceInfo& r = resources_.emplace_back();
    r.name = name;
    r.shape = shape;
    r.origin = origin;
    return {static_cast<uint32_t>(resources_.size() - 1)};
}

Resource FrameGraph::transient(std::string_view name, const Shape& shape) {
    return add(name, shape, Origin::Transient);
}

Resource FrameGraph::reserved(std::string_view name, const Shape& shape, std::initializer_list<Access> uses) {
    const Resource resource = add(name, shape, Origin::Transient);
    uint32_t usage = 0;
    for (const Access access : uses) {
        usage |= shape.is_image() ? image_usage_of(access) : buffer_usage_of(access, false);
        if (shape.format != VK_FORMAT_UNDEFINED && !shape.is_image()) usage |= buffer_usage_of(access, true);
    }
    if (usage == 0) throw Error("reserved resource " + in_quotes(name) + " has no uses");
    resources_.back().reserved_usage = usage;
    return resource;
}

Resource FrameGraph::upload(std::string_view name, std::span<const std::byte> contents, VkFormat texel) {
    const Resource resource = add(name, buffer_shape(contents.size(), texel), Origin::Upload);
    resources_.back().contents.assign(contents.begin(), contents.end());
    return resource;
}

Resource FrameGraph::upload(std::string_view name, std::vector<std::byte>&& contents) {
    const Resource resource = add(name, buffer_shape(contents.size()), Origin::Upload);
    resources_.back().contents = std::move(contents);
    return resource;
}

Resource FrameGraph::external(std::string_view name, const gpu::OwnedBuffer& buffer, uint64_t bytes, VkFormat texel) {
    const Resource resource = add(name, buffer_shape(bytes, texel), Origin::External);
    resources_.back().buffer = &buffer;
    return resource;
}

Resource FrameGraph::persistent(std::string_view name, const gpu::OwnedBuffer& buffer, uint64_t bytes, VkFormat texel) {
    const Resource resource = add(name, buffer_shape(bytes, texel), Origin::Persistent);
    resources_.back().buffer = &buffer;
    return resource;
}

Resource FrameGraph::external(std::string_view name, const ExternalImage& image) {
    const Resource resource = add(name, image_shape(image.format, image.extent), Origin::External);
    resources_.back().external_image = image;
    return resource;
}

Resource FrameGraph::target(std::string_view name, const ExternalImage& image) {
    const Resource resource = add(name, image_shape(image.format, image.extent), Origin::Target);
    resources_.back().external_image = image;
    keep(resource);
    return resource;
}

Resource FrameGraph::readback(std::string_view name, uint64_t bytes) {
    const Resource resource = add(name, buffer_shape(bytes), Origin::Readback);
    keep(resource);
    return resource;
}

History FrameGraph::history(std::string_view name, const Shape& shape) {
    const Resource current = add(name, shape, Origin::HistoryCurrent);
    const Resource previous = add(std::string(name) + " (previous)", shape, Origin::HistoryPrevious);
    resources_[current.index].partner = previous.index;
    resources_[previous.index].partner = current.index;
    return {previous, current};
}

void FrameGraph::add_pass(PassInfo pass) {
    if (pass.name.empty()) throw Error("a pass has no name");
    for (size_t i = 0; i < pass.uses.size(); ++i) {
        const Use& use = pass.uses[i];
        if (use.resource.index >= resources_.size()) fail(pass, "has no valid resource as use " + std::to_string(i));
        const ResourceInfo& r = resources_[use.resource.index];
        check_use(pass, use, r);
        for (size_t j = 0; j < i; ++j)
            if (pass.uses[j].resource == use.resource && (writes(use.access) || writes(pass.uses[j].access)))
                fail(pass, "uses " + in_quotes(r.name) + " twice and writes it");
        if (!is_read_first(use.access) || is_filled(r.origin)) continue;
        const bool written = std::ranges::any_of(passes_, [&](const PassInfo& earlier) {
            return std::ranges::any_of(earlier.uses,
                                       [&](const Use& u) { return u.resource == use.resource && writes(u.access); });
        });
        if (!written) fail(pass, "reads " + in_quotes(r.name) + " before any pass has written it");
    }
    if (pass.kind == PassKind::Dispatch) {
        load_texels(pass, resources_);
        check_kernel(pass, resources_);
    }
    if (pass.kind == PassKind::Raster) check_targets(pass, resources_);
    if (pass.kind != PassKind::Dispatch && !pass.record) fail(pass, "records nothing");
    passes_.push_back(std::move(pass));
}

void FrameGraph::dispatch(std::string_view name, const gpu::KernelInterface& kernel, std::initializer_list<Use> uses,
                          std::span<const std::byte> push, Groups groups) {
    add_pass({std::string(name), PassKind::Dispatch, uses, &kernel, {push.begin(), push.end()}, groups, 0, {}});
}

void FrameGraph::dispatch_indirect(std::string_view name, const gpu::KernelInterface& kernel,
                                   std::initializer_list<Use> uses, std::span<const std::byte> push,
                                   Arguments arguments) {
    PassInfo pass{
        std::string(name), PassKind::Dispatch, uses, &kernel, {push.begin(), push.end()}, {}, arguments.offset, {}};
    if (arguments.buffer.index >= resources_.size()) fail(pass, "has no valid resource as arguments");
    const ResourceInfo& r = resources_[arguments.buffer.index];
    if (r.shape.is_image()) fail(pass, "reads arguments from the image " + in_quotes(r.name));
    if (arguments.offset % 4 != 0 || arguments.offset + sizeof(VkDispatchIndirectCommand) > r.shape.bytes)
        fail(pass, "reads arguments at byte " + std::to_string(arguments.offset) + " of " + in_quotes(r.name) +
                       ", which has " + std::to_string(r.shape.bytes));
    pass.uses.push_back({arguments.buffer, Access::Arguments});
    add_pass(std::move(pass));
}

void FrameGraph::raster(std::string_view name, std::vector<Use> uses, Record record, VkExtent2D extent) {
    add_pass({std::string(name), PassKind::Raster, std::move(uses), nullptr, {}, {}, 0, std::move(record), extent});
}

void FrameGraph::clear(std::string_view name, Resource buffer) {
    PassInfo pass{std::string(name), PassKind::Transfer, {{buffer, Access::CopyTarget}}, nullptr, {}, {}, 0, {}};
    if (buffer.index >= resources_.size()) fail(pass, "has no valid resource to clear");
    const ResourceInfo& r = resources_[buffer.index];
    if (r.shape.is_image()) fail(pass, "clears the image " + in_quotes(r.name) + "; only buffers can be");
    if (r.shape.bytes % 4 != 0) fail(pass, "clears " + in_quotes(r.name) + ", whose size is not a multiple of 4 bytes");
    pass.record = [buffer, bytes = r.shape.bytes](const Recording& frame) {
        vkCmdFillBuffer(frame.commands(), frame.buffer(buffer), frame.offset(buffer), bytes, 0);
    };
    add_pass(std::move(pass));
}

void FrameGraph::fill(std::string_view name, Resource buffer, uint32_t word, std::vector<Region> regions) {
    PassInfo pass{std::string(name), PassKind::Transfer, {{buffer, Access::CopyPart}}, nullptr, {}, {}, 0, {}};
    if (buffer.index >= resources_.size()) fail(pass, "has no valid resource to fill");
    const ResourceInfo& r = resources_[buffer.index];
    if (r.shape.is_image()) fail(pass, "fills the image " + in_quotes(r.name) + "; only buffers can be");
    for (const Region& region : regions)
        if (region.to % 4 != 0 || region.bytes % 4 != 0 || region.bytes == 0 || region.bytes > r.shape.bytes ||
            region.to > r.shape.bytes - region.bytes)
            fail(pass, "fills " + std::to_string(region.bytes) + " bytes at " + std::to_string(region.to) + " of " +
                           in_quotes(r.name) + ", which has " + std::to_string(r.shape.bytes));
    pass.record = [buffer, word, regions = std::move(regions)](const Recording& frame) {
        for (const Region& region : regions)
            vkCmdFillBuffer(frame.commands(), frame.buffer(buffer), frame.offset(buffer) + region.to, region.bytes,
                            word);
    };
    add_pass(std::move(pass));
}

void FrameGraph::copy(std::string_view name, Resource from, Resource to) {
    PassInfo pass = copying(name, from, {to, Access::CopyTarget}, resources_.size());
    const ResourceInfo &source = resources_[from.index], &target = resources_[to.index];
    const VkExtent2D area = source.shape.extent;
    if (source.shape.is_image() && target.shape.is_image() &&
        (area.width != target.shape.extent.width || area.height != target.shape.extent.height))
        fail(pass, "copies the image " + in_quotes(source.name) + " to the image " + in_quotes(target.name) +
                       " of another extent");
    const uint64_t have = packed_bytes(source.shape), room = packed_bytes(target.shape);
    if (have != 0 && room != 0 && have != room)
        fail(pass, "copies " + std::to_string(have) + " bytes of " + in_quotes(source.name) + " to " +
                       in_quotes(target.name) + ", which has " + std::to_string(room));
    if (source.shape.is_image() && target.shape.is_image()) {
        pass.record = [from, to, area](const Recording& frame) {
            const VkImageSubresourceLayers layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            const VkImageCopy region{layer, {}, layer, {}, {area.width, area.height, 1}};
            vkCmdCopyImage(frame.commands(), frame.image(from), VK_IMAGE_LAYOUT_GENERAL, frame.image(to),
                           VK_IMAGE_LAYOUT_GENERAL, 1, &region);
        };
    } else if (source.shape.is_image()) {
        pass.record = [from, to, shape = source.shape](const Recording& frame) {
            const VkBufferImageCopy region = whole_image(shape, frame.offset(to));
            vkCmdCopyImageToBuffer(frame.commands(), frame.image(from), VK_IMAGE_LAYOUT_GENERAL, frame.buffer(to), 1,
                                   &region);
        };
    } else if (target.shape.is_image()) {
        pass.record = [from, to, shape = target.shape](const Recording& frame) {
            const VkBufferImageCopy region = whole_image(shape, frame.offset(from));
            vkCmdCopyBufferToImage(frame.commands(), frame.buffer(from), frame.image(to), VK_IMAGE_LAYOUT_GENERAL, 1,
                                   &region);
        };
    } else {
        pass.record = [from, to, bytes = have](const Recording& frame) {
            const VkBufferCopy region{frame.offset(from), frame.offset(to), bytes};
            vkCmdCopyBuffer(frame.commands(), frame.buffer(from), frame.buffer(to), 1, &region);
        };
    }
    add_pass(std::move(pass));
}

void FrameGraph::copy(std::string_view name, Resource from, Resource to, std::vector<Region> regions) {
    PassInfo pass = copying(name, from, {to, Access::CopyPart}, resources_.size());
    const ResourceInfo &source = resources_[from.index], &target = resources_[to.index];
    if (source.shape.is_image() || target.shape.is_image())
        fail(pass, "copies parts of an image; only buffers have any");
    if (regions.empty()) fail(pass, "copies nothing");
    for (const Region& region : regions)
        if (region.bytes == 0 || region.bytes > source.shape.bytes || region.bytes > target.shape.bytes ||
            region.from > source.shape.bytes - region.bytes || region.to > target.shape.bytes - region.bytes)
            fail(pass, "copies " + std::to_string(region.bytes) + " bytes from " + std::to_string(region.from) +
                           " of " + in_quotes(source.name) + " to " + std::to_string(region.to) + " of " +
                           in_quotes(target.name) + ", which have " + std::to_string(source.shape.bytes) + " and " +
                           std::to_string(target.shape.bytes));
    pass.record = [from, to, parts = std::move(regions)](const Recording& frame) {
        std::vector<VkBufferCopy> copies;
        copies.reserve(parts.size());
        for (const Region& part : parts)
            copies.push_back({frame.offset(from) + part.from, frame.offset(to) + part.to, part.bytes});
        vkCmdCopyBuffer(frame.commands(), frame.buffer(from), frame.buffer(to), uint32_t(copies.size()), copies.data());
    };
    add_pass(std::move(pass));
}

void FrameGraph::keep(Resource resource) {
    if (resource.index >= resources_.size()) throw Error("keep: not a resource of this frame");
    resources_[resource.index].kept = true;
}

}  // namespace vesper::graph
