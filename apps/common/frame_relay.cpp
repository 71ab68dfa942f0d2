#include "frame_relay.h"

#include "graph/times.h"

namespace vesper::apps {

render::Frame FrameRelay::render(render::Renderer& renderer, const render::RenderSettings& given,
                                 const gpu_scene::View& view, const gpu_scene::SceneFrame& moment, float seconds,
                                 const render::Outputs& outputs, unsigned index, const Finds& finds) {
    const auto& [fresh, eye] = finds;
    if (ranks_.size() == 1) {
        if (eye) renderer.set_eye(*eye);
        if (fresh) renderer.reset_adaptation();
        return renderer.render(given, view, moment, seconds, outputs);
    }
    // All up to what the eye sees needs no eye.
    const render::RenderSettings settings = ldr_baseline(given);
    render::RenderSettings drawn = settings;
    drawn.glare = render::Glare::None;
    render::Frame frame = renderer.render(drawn, view, moment, 0, {.display = false, .retina = true});
    if (eye) mapper_.set_eye(*eye);
    if (!eye && index > 0) {
        const Bytes bytes = ranks_.receive(rank_of(index - 1), Ranks::Stream::Eyes);
        mapper_.set_eye(PacketReader(bytes).value<shared::EyeState>());
    }
    if (fresh) mapper_.reset_adaptation();
    const vision::ImageAngles angles = gpu_scene::angles_of(view);
    render::ToneMapped shown = mapper_.map(
        settings,
        {.extent = view.extent, .values = frame.retina, .channels = 4, .outside = frame.outside, .angles = &angles},
        seconds, outputs);
    if (!eye && index + 1 < frames_) {
        PacketWriter packet;
        packet.value(shown.eye);
        ranks_.send(rank_of(index + 1), Ranks::Stream::Eyes, packet.take());
    }
    graph::add_times(frame.timings, shown.timings);
    shown.timings = std::move(frame.timings), shown.milliseconds += frame.milliseconds;
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
