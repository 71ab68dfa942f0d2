// Submits frames, and carries the state of the eye from each to the next. SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "base/stopwatch.h"
#include "eye/corona.h"
#include "eye/scatter.h"
#include "graph/executor.h"
#include "render/eye_state.h"
#include "render/frame_context.h"
#include "render/tone_chain.h"

namespace vesper::render {

/// Submits frames and reads their results. Not thread-safe.
class FrameQueue {
public:
    /// Keeps the fitted eye scatter of `views` sizes or angles of pictures.
    explicit FrameQueue(gpu::Device& device, size_t views = 1);

    /// Whether frames of these settings need the state of the eye on the host, so that the last frame must be finished.
    static bool needs_finished_frame(const ToneChainSettings& settings) {
        return settings.glare == Glare::Scatter && settings.scatter.has_corona();
    }
    /// Finishes the last frame, and drops its results, if frames of these settings need that.
    void prepare(const ToneChainSettings& settings);
    /// A frame to be declared.
    FrameContext context(graph::FrameGraph& graph, const gpu_scene::View& view) const {
        return {graph, kernels_, pipelines_, view};
    }
    /// The eye as a frame of `view` finds it `seconds` after the last one, with its scatter if the settings have any.
    ChainInputs inputs(const ToneChainSettings& settings, const gpu_scene::View& view, float seconds);

    /// Runs a graph that is no frame of its own, and waits for it; nothing remains of frames before it to be finished.
    /// Returns the time of its passes.
    const std::vector<graph::Timing>& run(const graph::FrameGraph& graph);

    /// A declared frame.
    struct Declared {
        Stopwatch watch;  ///< since its declaration began
        graph::FrameGraph graph;
        ToneChain chain;
        VkExtent2D extent{};
    };
    /// Submits a frame, which was declared with these inputs, between semaphores and without waiting. If it throws
    /// Error nothing has changed.
    void submit(Declared frame, const ChainInputs& inputs, const graph::SubmitSemaphores& semaphores);
    /// Waits for all submitted frames. Returns the results of the last one, once, and gives up those before it; its
    /// readbacks can be read until the next frame is submitted.
    std::optional<ToneMapped> finish();
    /// The same of the oldest frame whose results are left: of the last graph::Executor::kFramesUnderWay. Without
    /// `waits` there is nothing while it is under way.
    std::optional<ToneMapped> finish_oldest(bool waits);
    /// Frames whose results are left.
    size_t unfinished() const { return pending_.size(); }
    /// Waits for all submitted frames; the results of the last one remain to be finished.
    void wait() { executor_.wait(); }

    const graph::Executor& executor() const { return executor_; }
    const EyeState& eye() const { return eye_; }
    /// The state that the next frame takes.
    void set_eye(const EyeState& eye) { eye_ = eye; }
    /// The plan of the last frame as text.
    std::string plan() const { return graph_.describe(executor_.plan()); }

private:
    struct Pending {
        Stopwatch watch;
        ToneChain chain;
        EyeState eye;       // that it took
        ToneMapped result;  // what the host knows before the frame is finished
    };

    template <class Finish>
    std::optional<ToneMapped> take(const Finish& finish);
    void forget_lost() {
        while (pending_.size() > executor_.unfinished()) pending_.pop_front();
    }

    gpu::KernelCache kernels_;
    gpu::GraphicsPipelineCache pipelines_;
    eye::ScatterCache scatter_;
    eye::CoronaCache corona_;
    EyeState eye_;
    graph::FrameGraph graph_;      // of the last frame
    graph::Executor executor_;     // waits for its frames, which use the members above
    std::deque<Pending> pending_;  // the oldest first
};

}  // namespace vesper::render
