#include "graph/executor.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "base/stopwatch.h"
#include "graph/realized.h"

namespace vesper::graph {
namespace {

constexpr size_t kMostGraphs = 8;          // in turn, such as of screens of several sizes, whose transients stay
constexpr size_t kSpareTransients = 64;    // of other frames
constexpr uint64_t kSliceAlignment = 256;  // at least every minimum offset alignment Vulkan allows a device to ask for
constexpr VkBufferUsageFlags kHostUsage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                          VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                          VK_BUFFER_USAGE_INDEX_BUFFER_BIT;

uint64_t aligned(uint64_t value, uint64_t alignment) { return (value + alignment - 1) / alignment * alignment; }

// Room of texels, for what grows from frame to frame.
uint64_t with_room(uint64_t bytes) {
    constexpr uint64_t kLeast = 1u << 12u, kLarge = 1u << 17u;
    return aligned(bytes < kLarge ? std::bit_ceil(std::max(2 * bytes, kLeast)) : bytes + bytes / 2, kSliceAlignment);
}
// Places of texels that the last frame did not have are given up where they take more than this, and than four times
// those that it had.
constexpr uint64_t kMostIdleBytes = 16u << 20u;

// Makes a buffer that is too small larger, and one that is much too large smaller.
void fit(const gpu::Device& device, gpu::HostBuffer& buffer, uint64_t bytes, gpu::HostBuffer::Direction direction) {
    constexpr uint64_t kSpare = 4u << 20u;
    const uint64_t wanted = bytes + std::min(bytes, 4 * kSpare) + kSpare;
    if (buffer.bytes() >= bytes && buffer.bytes() <= 2 * wanted + kMostIdleBytes) return;
    buffer = {};
    buffer = gpu::HostBuffer(device, wanted, kHostUsage, direction);
}

}  // namespace

struct Executor::Past {
    Shape shape;
    uint32_t usage;
    gpu::Arena arena;
    gpu::OwnedImage images[2];
    gpu::OwnedImageView views[2];
    gpu::OwnedBuffer buffers[2];
    int current = 0;     // the half the next frame writes
    bool is_new = true;  // zero before the next frame

    Past(const gpu::Device& device, const Shape& s, uint32_t u) : shape(s), usage(u), arena(device) {
        for (int half : {0, 1}) {
            if (s.is_image()) {
                images[half] = gpu::make_image(device, gpu::image_info(s.format, s.extent, 1, u));
                arena.bind(images[half].get());
                views[half] = gpu::make_view(device, images[half].get(), s.format);
            } else {
                buffers[half] = gpu::make_buffer(device, s.bytes, u);
                arena.bind(buffers[half].get());
            }
        }
    }

    // Within a barrier for all that uses it.
    void zero(VkCommandBuffer commands) const {
        constexpr gpu::Touch before{VK_PIPELINE_STAGE_2_CLEAR_BIT},
            clear{VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
        for (int half : {0, 1}) {
            if (!shape.is_image()) {
                vkCmdFillBuffer(commands, buffers[half].get(), 0, VK_WHOLE_SIZE, 0);
                continue;
            }
            const VkImageMemoryBarrier2 barrier = gpu::image_barrier(
                images[half].get(), before, clear, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
            gpu::pipeline_barrier(commands, {&barrier, 1});
            const VkClearColorValue black{};
            vkCmdClearColorImage(commands, images[half].get(), VK_IMAGE_LAYOUT_GENERAL, &black, 1,
                                 &barrier.subresourceRange);
        }
    }
};

Executor::Executor(gpu::Device& device) : device_(device) {
    const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                      .magFilter = VK_FILTER_LINEAR,
                                      .minFilter = VK_FILTER_LINEAR,
                                      .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                      .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    VkSampler raw_sampler = VK_NULL_HANDLE;
    gpu::check(vkCreateSampler(device.handle(), &sampler, nullptr, &raw_sampler), "making a sampler");
    sampler_ = {device.handle(), raw_sampler};
}

Executor::~Executor() {
    for (const auto& slot : slots_) slot->settle();
}

Measure Executor::measure() const {
    return [this](const Shape& shape, uint32_t usage) -> Footprint {
        VkMemoryRequirements2 needs{.sType = VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
        if (shape.is_image()) {
            const VkImageCreateInfo info = gpu::image_info(shape.format, shape.extent, 1, usage);
            const VkDeviceImageMemoryRequirements query{.sType = VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS,
                                                        .pCreateInfo = &info};
            vkGetDeviceImageMemoryRequirements(device_.handle(), &query, &needs);
        } else {
            const VkBufferCreateInfo info{
                .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = shape.bytes, .usage = usage};
            const VkDeviceBufferMemoryRequirements query{.sType = VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS,
                                                         .pCreateInfo = &info};
            vkGetDeviceBufferMemoryRequirements(device_.handle(), &query, &needs);
        }
        const VkMemoryRequirements& m = needs.memoryRequirements;
        // Images and buffers share the heap, so each keeps to pages of its own.
        return {m.size, std::max(m.alignment, device_.limits().bufferImageGranularity), m.memoryTypeBits};
    };
}

void Executor::run(const FrameGraph& graph) {
    finish();
    submit(graph, {});
    finish();
}

void Executor::submit(const FrameGraph& graph, const SubmitSemaphores& semaphores) {
    Stopwatch watch;
    const bool goes_on = std::ranges::any_of(graph.resources(), [](const auto& r) {
        return r.external_image.image != VK_NULL_HANDLE || r.origin == FrameGraph::Origin::Persistent;
    });
    const bool among_others = goes_on || !semaphores.wait.empty() || !semaphores.signal.empty() ||
                              std::ranges::any_of(slots_, &FrameSlot::under_way);
    FrameSlot *const last = slot_, *const read = read_;
    HostTimes times;
    Plan before = std::move(plan_);
    try {
        plan_ = graph.compile(measure());
        check_sizes(graph);
        enter_slot();
        place(graph);
        realize_histories(graph);
        realize_uploads(graph);
        realize_externals(graph);
        realize_external_images(graph);
        realize_readbacks(graph);
        times.plan = watch.lap();
        record(graph, among_others);
        find_turning(graph);
        times.record = watch.lap();
        slot_->submit(semaphores);
    } catch (...) {
        slot_ = last, read_ = read;  // what that frame left can be read
        plan_ = std::move(before);
        throw;
    }
    // From here on nothing can fail: who is told that a frame failed may hand over its semaphores again.
    unread_.push_back(slot_), read_ = slot_;
    turned_.swap(turning_);
    for (Past* past : turned_) past->current ^= 1;
    for (Past* past : cleared_) past->is_new = false;
    times.submit = watch.lap();
    slot_->host_times = times;
}

// What a device allows is not known before. A buffer of texels that is too long for it has no other kernel to read it.
void Executor::check_sizes(const FrameGraph& graph) const {
    const VkPhysicalDeviceLimits& limits = device_.limits();
    for (const Plan::Step& step : plan_.steps) {
        const FrameGraph::PassInfo& pass = graph.passes()[step.pass];
        for (size_t i = 0; pass.kernel && i < pass.kernel->bindings.size(); ++i) {
            const FrameGraph::ResourceInfo& r = graph.resources()[pass.uses[i].resource.index];
            const VkDescriptorType type = pass.kernel->bindings[i];
            const auto check = [&](uint64_t size, uint64_t most, const char* of, const char* limit) {
                if (size > most)
                    throw Error("pass '" + pass.name + "': '" + r.name + "' has " + std::to_string(size) + of +
                                device_.name() + " allows " + std::to_string(most) + " (" + limit + ")");
            };
            if (type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER)
                check(r.shape.bytes / std::max<uint64_t>(texel_bytes(r.shape.format), 1), limits.maxTexelBufferElements,
                      " texels, ", "maxTexelBufferElements");
            if (type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
                check(r.shape.bytes, limits.maxStorageBufferRange, " bytes, ", "maxStorageBufferRange");
        }
    }
}

// A frame that failed is nobody's past, and has left nothing; nor have those after it.
void Executor::fail() noexcept {
    for (const auto& slot : slots_) slot->settle();
    for (Past* past : turned_) past->current ^= 1;
    turned_.clear(), unread_.clear();
}

void Executor::wait() {
    Stopwatch watch;
    const bool last = slot_ && slot_->under_way;
    try {
        for (const auto& slot : slots_) slot->wait();
    } catch (...) {
        fail();
        throw;
    }
    if (last) slot_->host_times.wait = watch.lap();
    turned_.clear();
    read_ = slot_;
}

bool Executor::finish() {
    wait();
    if (unread_.empty()) return false;
    read_ = unread_.back();
    unread_.clear();
    return true;
}

bool Executor::finish_oldest(bool waits) {
    if (unread_.empty() || (!waits && !unread_.front()->is_done())) return false;
    Stopwatch watch;
    FrameSlot* const oldest = unread_.front();
    try {
        oldest->wait();
    } catch (...) {
        fail();
        throw;
    }
    oldest->host_times.wait = watch.lap();
    unread_.pop_front();
    read_ = oldest;
    if (unread_.empty()) turned_.clear();
    return true;
}

// The next one in turn. With nothing left to read the first, so that whoever finishes every frame has one.
void Executor::enter_slot() {
    const auto last = std::ranges::find(slots_, slot_, &std::unique_ptr<FrameSlot>::get);
    const size_t next = unread_.empty() ? 0 : (size_t(last - slots_.begin()) + 1) % kFramesUnderWay;
    if (next == slots_.size()) slots_.push_back(std::make_unique<FrameSlot>(device_));
    slot_ = slots_[next].get();
    slot_->wait();
    std::erase(unread_, slot_);
    slot_->views.clear();
}

Executor::TransientKey Executor::key_of(const FrameGraph& graph, const Plan::Placement& p) const {
    const FrameGraph::ResourceInfo& info = graph.resources()[p.resource];
    const auto& [format, extent, bytes] = info.shape;
    return {info.name, format, extent.width, extent.height, bytes, plan_.usage[p.resource], p.heap, p.offset};
}

// Transients that this frame does not have stay, for a frame that has them again.
void Executor::place(const FrameGraph& graph) {
    // Memory stays where it is large enough, and not more than four times so.
    const auto suffices = [](const Plan::Heap& had, const Plan::Heap& wanted) {
        return had.memory_types == wanted.memory_types && had.bytes >= wanted.bytes && had.bytes / 4 <= wanted.bytes;
    };
    const bool has_room = std::ranges::equal(allocated_, plan_.heaps, suffices);
    std::vector<TransientKey> keys;
    for (const Plan::Placement& p : plan_.placements) keys.push_back(key_of(graph, p));
    const bool all_placed =
        has_room && std::ranges::all_of(keys, [&](const TransientKey& key) { return transients_.contains(key); });
    const bool crowded = transients_.size() > kMostGraphs * plan_.placements.size() + kSpareTransients;
    if (!all_placed || crowded) wait();  // what is under way uses what goes now
    if (!has_room || crowded) transients_.clear();
    if (!has_room) {
        heaps_.clear(), allocated_.clear();
        for (const Plan::Heap& heap : plan_.heaps)
            heaps_.push_back(gpu::allocate(
                device_, heap.bytes, device_.memory_type(heap.memory_types, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)));
        allocated_ = plan_.heaps;
    }
    resources_.assign(graph.resources().size(), {});
    for (size_t i = 0; i < keys.size(); ++i) {
        const Plan::Placement& p = plan_.placements[i];
        const FrameGraph::ResourceInfo& info = graph.resources()[p.resource];
        auto found = transients_.find(keys[i]);
        if (found == transients_.end()) found = transients_.emplace(std::move(keys[i]), make_transient(info, p)).first;
        const Transient& t = found->second;
        Realized& r = resources_[p.resource];
        r.image = t.image.get(), r.view = t.view.get(), r.aspect = gpu::aspect_of(info.shape.format);
        r.buffer = &t.buffer, r.bytes = r.viewed_bytes = info.shape.bytes;
    }
}

Executor::Transient Executor::make_transient(const FrameGraph::ResourceInfo& info, const Plan::Placement& p) const {
    Transient t;
    const uint32_t usage = plan_.usage[p.resource];
    if (info.shape.is_image()) {
        t.image = gpu::make_image(device_, gpu::image_info(info.shape.format, info.shape.extent, 1, usage));
        gpu::check(vkBindImageMemory(device_.handle(), t.image.get(), heaps_[p.heap].get(), p.offset),
                   "placing an image");
        t.view = gpu::make_view(device_, t.image.get(), info.shape.format);
    } else {
        t.buffer = gpu::make_buffer(device_, info.shape.bytes, usage);
        gpu::check(vkBindBufferMemory(device_.handle(), t.buffer.get(), heaps_[p.heap].get(), p.offset),
                   "placing a buffer");
    }
    return t;
}

void Executor::realize_histories(const FrameGraph& graph) {
    cleared_.clear();
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::HistoryCurrent || !plan_.usage[i]) continue;
        uint32_t usage = plan_.usage[i] | plan_.usage[info.partner];
        usage |= info.shape.is_image() ? uint32_t(VK_IMAGE_USAGE_TRANSFER_DST_BIT)
                                       : uint32_t(VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        auto& past = histories_[info.name];
        const bool fits = past && past->shape == info.shape && past->usage == usage;
        if (!fits) {
            wait();  // what is under way uses it
            past = std::make_unique<Past>(device_, info.shape, usage);
        }
        if (past->is_new) cleared_.push_back(past.get());
        for (const auto& [index, half] : {std::pair{i, past->current}, std::pair{info.partner, 1 - past->current}}) {
            Realized& r = resources_[index];
            r.image = past->images[half].get(), r.view = past->views[half].get();
            r.buffer = &past->buffers[half], r.bytes = r.viewed_bytes = info.shape.bytes;
        }
    }
}

// Among the frame's commands, so that nothing waits for a queue that may be busy with others' work.
void Executor::record_clearing() const {
    if (cleared_.empty()) return;
    gpu::pipeline_barrier(slot_->commands, {}, &gpu::kWholeBarrier);
    for (const Past* past : cleared_) past->zero(slot_->commands);
    gpu::pipeline_barrier(slot_->commands, {}, &gpu::kWholeBarrier);
}

// Only a frame that was submitted is the past of the next.
void Executor::find_turning(const FrameGraph& graph) {
    turning_.clear();
    for (uint32_t i = 0; i < graph.resources().size(); ++i)
        if (graph.resources()[i].origin == FrameGraph::Origin::HistoryCurrent && plan_.usage[i])
            turning_.push_back(histories_.at(graph.resources()[i].name).get());
}

// Texels keep their place from frame to frame, with room to grow, so that their views stay; all else follows them.
void Executor::realize_uploads(const FrameGraph& graph) {
    uint64_t used = 0;
    for (const auto& [name, place] : upload_places_)
        if (place.last_frame == frame_) used += place.bytes;
    if (upload_end_ - used > std::max(kMostIdleBytes, 4 * used)) upload_places_.clear(), upload_end_ = 0;
    ++frame_;
    for (const auto& info : graph.resources()) {
        if (info.origin != FrameGraph::Origin::Upload || info.shape.format == VK_FORMAT_UNDEFINED) continue;
        UploadPlace& place = upload_places_[info.name];
        place.last_frame = frame_;
        if (place.bytes >= info.contents.size()) continue;
        place.offset = upload_end_, place.bytes = with_room(info.contents.size());
        upload_end_ += place.bytes;
    }
    uint64_t end = upload_end_;
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::Upload) continue;
        Realized& r = resources_[i];
        r.bytes = r.viewed_bytes = info.contents.size();
        if (info.shape.format == VK_FORMAT_UNDEFINED) {
            r.offset = end;
            end = aligned(end + r.bytes, kSliceAlignment);
            continue;
        }
        const UploadPlace& place = upload_places_.at(info.name);
        const uint64_t most = device_.limits().maxTexelBufferElements * texel_bytes(info.shape.format);
        r.offset = place.offset, r.viewed_bytes = std::max(std::min(place.bytes, most), r.bytes);
    }
    if (end == 0) return;
    gpu::HostBuffer& uploads = slot_->uploads;
    fit(device_, uploads, end, gpu::HostBuffer::Direction::ToDevice);
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::Upload) continue;
        resources_[i].buffer = &uploads.owned();
        std::memcpy(uploads.data() + resources_[i].offset, info.contents.data(), info.contents.size());
    }
    uploads.flush();
}

void Executor::realize_externals(const FrameGraph& graph) {
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        const bool persistent = info.origin == FrameGraph::Origin::Persistent;
        if ((info.origin != FrameGraph::Origin::External && !persistent) || info.external_image.image) continue;
        Realized& r = resources_[i];
        r.buffer = info.buffer, r.bytes = r.viewed_bytes = info.shape.bytes;
    }
}

void Executor::realize_external_images(const FrameGraph& graph) {
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (!info.external_image.image) continue;
        Realized& r = resources_[i];
        r.image = info.external_image.image;
        const bool copied_only =
            !(plan_.usage[i] & ~uint32_t(VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT));
        if (!copied_only)
            r.view = slot_->views.emplace_back(gpu::make_view(device_, r.image, info.shape.format, 1)).get();
    }
}

void Executor::realize_readbacks(const FrameGraph& graph) {
    uint64_t total = 0;
    for (const auto& info : graph.resources())
        if (info.origin == FrameGraph::Origin::Readback) total = aligned(total, kSliceAlignment) + info.shape.bytes;
    gpu::HostBuffer& readbacks = slot_->readbacks;
    if (total) fit(device_, readbacks, total, gpu::HostBuffer::Direction::FromDevice);
    slot_->places.clear();
    uint64_t offset = 0;
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const auto& info = graph.resources()[i];
        if (info.origin != FrameGraph::Origin::Readback) continue;
        offset = aligned(offset, kSliceAlignment);
        Realized& r = resources_[i];
        r.buffer = &readbacks.owned(), r.offset = offset, r.bytes = r.viewed_bytes = info.shape.bytes;
        slot_->places[i] = {r.offset, r.bytes};
        offset += r.bytes;
    }
}

std::span<const std::byte> Executor::read(Resource readback) const {
    if (!read_) throw Error("there is no frame to be read");
    const auto place = read_->places.find(readback.index);
    if (place == read_->places.end()) throw Error("a resource that is not a readback cannot be read");
    if (read_->under_way) throw Error("a frame that is under way cannot be read");
    return {read_->readbacks.data() + place->second.offset, place->second.bytes};
}

uint64_t Executor::heap_bytes() const {
    uint64_t total = 0;
    for (const Plan::Heap& heap : allocated_) total += heap.bytes;
    return total;
}

}  // namespace vesper::graph
