#include "ranks/frame_relay.h"

#include "graph/times.h"

namespace vesper::apps {

render::Frame FrameRelay::render(render::Renderer& renderer, const render::RenderSettings& given,
                                 const gpu_scene::View& view, const gpu_scene::SceneFrame& moment, float seconds,
                                 const render::Outputs& outputs, unsigned index, const Finds& finds) {
    const std::optional<shared::EyeState>& eye = finds.eye;
    if (ranks_.size() == 1) {
        if (eye) renderer.set_eye(*eye);
        if (finds.fresh) renderer.reset_adaptation();
        return renderer.render(given, view, moment, seconds, outputs);
    }
    const render::RenderSettings settings = ldr_baseline(given);
    render::Frame frame =
        renderer.render(settings, view, moment, 0, {.display = false, .scene = outputs.scene, .light = &light_});
    const auto find_eye = [&] {
        if (eye) return eye_.set_eye(*eye);
        shared::EyeState before{};
        if (index > 0) PacketReader(ranks_.receive(rank_of(index - 1), Ranks::Stream::Eyes)).value(before);
        eye_.set_eye(finds.fresh ? shared::EyeState{} : before);
    };
    // Ranks wait for one another while an eye adapts, and for nothing else, unless it has a say in what is scattered.
    const bool adapts_first = render::FrameQueue::needs_finished_frame(settings);
    if (adapts_first) find_eye();
    const render::SharedEye::Seen seen = eye_.see(settings, light_, {.lamps = frame.outside}, seconds, view, retina_);
    if (!adapts_first) find_eye();
    const render::ToneMapped adapted = eye_.adapt(settings, std::span(&seen.statistics, 1), 0, seconds);
    if (!finds.all_known && index + 1 < frames_) {
        PacketWriter packet;
        packet.value(adapted.eye);
        ranks_.send(rank_of(index + 1), Ranks::Stream::Eyes, packet.take());
    }
    render::ToneMapped shown = eye_.show(
        settings, retina_, adapted.curve,
        {.display = outputs.display, .display_light = outputs.display_light, .projection = outputs.projection});
    shown.curve = adapted.curve, shown.histogram = adapted.histogram, shown.eye = adapted.eye;
    shown.scene = std::move(frame.scene);
    shown.pupil = seen.pupil, shown.pattern_milliseconds = seen.pattern_milliseconds;
    graph::add_times(frame.timings, seen.timings);
    graph::add_times(frame.timings, adapted.timings);
    graph::add_times(frame.timings, shown.timings);
    shown.timings = std::move(frame.timings);
    shown.milliseconds += frame.milliseconds + seen.milliseconds + adapted.milliseconds;
    static_cast<render::ToneMapped&>(frame) = std::move(shown);
    return frame;
}

void FrameRelay::take_until(unsigned frame, const Take& take) {
    for (; taken_ < frame; ++taken_) take(taken_, ranks_.receive(rank_of(taken_), Ranks::Stream::Pictures));
}

void FrameRelay::deliver(unsigned frame, Bytes made, const Take& take) {
    if (!ranks_.is_first()) return ranks_.send(0, Ranks::Stream::Pictures, std::move(made));
    take_until(frame, take);
    take(frame, made), ++taken_;
}

void FrameRelay::finish(const Take& take) {
    if (ranks_.is_first()) take_until(frames_, take);
}

}  // namespace vesper::apps
