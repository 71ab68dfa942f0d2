// Runs declared frames on a device. SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "gpu/kernel.h"
#include "gpu/memory.h"
#include "graph/frame_graph.h"
#include "graph/frame_slot.h"

namespace vesper::graph {

/// Owns the memory behind a frame graph's resources and what survives from frame to frame.
class Executor {
public:
    explicit Executor(gpu::Device& device);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Returns the function that tells the memory needs of resources on this device.
    Measure measure() const;
    /// Runs the frame and waits for it. The same declaration again reuses everything. Throws Error; a frame that failed
    /// has left histories as they were, and unless the device is lost the next can be run.
    void run(const FrameGraph& graph);
    /// Submits the frame to the queue and returns. Waits first if its declaration differs from that of the previous
    /// frame, or if kFramesUnderWay frames are in flight.
    void submit(const FrameGraph& graph, const SubmitSemaphores& semaphores);
    static constexpr size_t kFramesUnderWay = 3;
    /// Waits for all submitted frames. Readbacks of the last one stay valid until the next submit().
    void wait();
    /// Waits for all submitted frames and gives up the results of all but the last. Returns true if there is a frame
    /// whose results were not given up before; its readbacks stay valid until the next submit().
    bool finish();
    /// The same for the oldest such frame. A frame's results are lost when kFramesUnderWay later ones were submitted.
    /// Without `waits` returns false while it is under way.
    bool finish_oldest(bool waits);
    /// Frames whose results can still be finished, at most kFramesUnderWay.
    size_t unfinished() const { return unread_.size(); }
    /// Bytes of a readback of the frame that was submitted or finished last, which must be finished.
    std::span<const std::byte> read(Resource readback) const;
    template <class T>
    std::span<const T> read_as(Resource readback) const {
        const auto bytes = read(readback);
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }

    const Plan& plan() const { return plan_; }  ///< of the last frame
    const std::vector<Timing>& timings() const {
        return read_->timings;
    }  ///< of the frame that is read, which is finished; empty without timestamps
    const HostTimes& host_times() const { return read_->host_times; }  ///< likewise
    uint64_t heap_bytes() const;                                       ///< device memory behind transients, bytes

private:
    struct Realized;  // what stands for one resource in this frame
    class FrameRecording;
    struct Past;  // both halves of a history
    struct UploadPlace {
        uint64_t offset = 0, bytes = 0;
        uint64_t last_frame = 0;  // that has the upload
    };
    // A transient is the same in frames where all of this is: name, shape (format, width, height, bytes), usage, heap,
    // offset.
    using TransientKey = std::tuple<std::string, VkFormat, uint32_t, uint32_t, uint64_t, uint32_t, uint32_t, uint64_t>;
    struct Transient {
        gpu::OwnedImage image;
        gpu::OwnedImageView view;
        gpu::OwnedBuffer buffer;
    };

    void check_sizes(const FrameGraph& graph) const;
    void enter_slot();
    void fail() noexcept;
    void place(const FrameGraph& graph);
    void find_turning(const FrameGraph& graph);
    TransientKey key_of(const FrameGraph& graph, const Plan::Placement& placement) const;
    Transient make_transient(const FrameGraph::ResourceInfo& info, const Plan::Placement& placement) const;
    void realize_histories(const FrameGraph& graph);
    void realize_uploads(const FrameGraph& graph);
    void realize_externals(const FrameGraph& graph);
    void realize_external_images(const FrameGraph& graph);
    void realize_readbacks(const FrameGraph& graph);
    void record(const FrameGraph& graph, bool among_others);
    enum class Border { Enter, Leave };
    void record_border(const FrameGraph& graph, Border border) const;
    void record_clearing() const;
    void record_barriers(const std::vector<Plan::Barrier>& barriers) const;
    void record_dispatch(const FrameGraph& graph, const FrameGraph::PassInfo& pass) const;
    void record_raster(const FrameGraph& graph, const Plan::Step& step) const;

    gpu::Device& device_;
    Plan plan_;
    std::vector<Realized> resources_;
    std::map<std::string, std::unique_ptr<Past>> histories_;
    std::vector<Past*> turned_, turning_;  // by the last frame; by the one that is being submitted
    std::vector<Past*> cleared_;           // by it
    std::vector<gpu::OwnedMemory> heaps_;
    std::vector<Plan::Heap> allocated_;                 // what they are
    std::map<TransientKey, Transient> transients_;      // in `heaps_`
    std::map<std::string, UploadPlace> upload_places_;  // in FrameSlot::uploads, by name
    uint64_t upload_end_ = 0;
    uint64_t frame_ = 0;  // number of the last one
    gpu::OwnedSampler sampler_;
    std::vector<std::unique_ptr<FrameSlot>> slots_;
    FrameSlot* slot_ = nullptr;      // of the last frame, or of the one that is being submitted
    FrameSlot* read_ = nullptr;      // of the frame whose results are read
    std::deque<FrameSlot*> unread_;  // of frames whose results were not given up, the oldest first
};

}  // namespace vesper::graph
