#include "render/frame_queue.h"

#include <utility>

namespace vesper::render {

FrameQueue::FrameQueue(gpu::Device& device, size_t views)
    : kernels_(device), pipelines_(device), scatter_(device, views), executor_(device) {}

void FrameQueue::prepare(const ToneChainSettings& settings) {
    if (needs_finished_frame(settings)) finish();
}

ChainInputs FrameQueue::inputs(const ToneChainSettings& settings, const gpu_scene::View& view, float seconds) {
    ChainInputs inputs{.seconds = seconds, .eye = eye_};
    if (settings.glare != Glare::Scatter) return inputs;
    const vision::ImageAngles image = gpu_scene::angles_of(view);
    if (!scatter_.has(settings.scatter, image)) wait();  // frames under way use the fit that the new one replaces
    inputs.scatter.fit = &scatter_.at(settings.scatter, image);
    if (!settings.scatter.has_corona()) return inputs;
    const double life = double(eye_.value.seconds) + double(eye_.value.seconds_lost) + double(seconds);
    inputs.corona = &corona_.at(settings.scatter, double(eye_.value.pupil), life);
    return inputs;
}

const std::vector<graph::Timing>& FrameQueue::run(const graph::FrameGraph& graph) {
    finish();
    kernels_.compile();
    executor_.run(graph);
    return executor_.timings();
}

void FrameQueue::submit(Declared frame, const ChainInputs& inputs, const graph::SubmitSemaphores& semaphores) {
    Pending pending{frame.watch, frame.chain, inputs.eye, {}};
    pending.result.extent = frame.extent;
    if (inputs.corona) {
        pending.result.pupil = inputs.corona->pupil;
        pending.result.pattern_milliseconds = inputs.corona->milliseconds;
    }
    pending.result.host_times.declare = frame.watch.milliseconds();
    try {
        kernels_.compile();
        executor_.submit(frame.graph, semaphores);
    } catch (...) {
        forget_lost();
        throw;
    }
    // Nothing fails from here on.
    if (pending.chain.eye) eye_ = eye_.submitted();
    graph_ = std::move(frame.graph);
    pending_.push_back(std::move(pending));
    forget_lost();
}

std::optional<ToneMapped> FrameQueue::finish() {
    return take([this] { return executor_.finish(); });
}

std::optional<ToneMapped> FrameQueue::finish_oldest(bool waits) {
    return take([&] { return executor_.finish_oldest(waits); });
}

template <class Finish>
std::optional<ToneMapped> FrameQueue::take(const Finish& finish) {
    const size_t before = executor_.unfinished();
    try {
        if (!finish()) {
            forget_lost();
            return std::nullopt;
        }
    } catch (...) {
        // A frame that failed has left nothing: the next one takes the state that this one took.
        if (!pending_.empty() && eye_.on_device) eye_ = pending_.front().eye;
        pending_.clear();
        throw;
    }
    // All but the last are given up, or the oldest is taken.
    const size_t given_up = executor_.unfinished() == 0 ? pending_.size() : before - executor_.unfinished();
    Pending pending = std::move(pending_[given_up - 1]);
    pending_.erase(pending_.begin(), pending_.begin() + ptrdiff_t(given_up));
    ToneMapped result = std::move(pending.result);
    result.milliseconds = pending.watch.milliseconds();
    const double declared_after = result.host_times.declare;
    read_tone_chain(executor_, pending.chain, result.extent, result);
    result.host_times.declare = declared_after;
    if (pending.chain.eye) eye_ = eye_.finished(result.eye);
    return result;
}

}  // namespace vesper::render
