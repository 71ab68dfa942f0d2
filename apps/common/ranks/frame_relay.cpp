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
    // All up to what the eye sees needs no eye.
    const render::RenderSettings settings = ldr_baseline(given);
    render::RenderSettings drawn = settings;
    drawn.glare = render::Glare::None;
    render::Frame frame = renderer.render(drawn, view, moment, 0, {.display = false, .retina = true});
    const vision::ImageAngles angles = gpu_scene::angles_of(view);
    render::HostPicture picture{
        .extent = view.extent, .values = frame.retina, .channels = 4, .outside = frame.outside, .angles = &angles};
    const auto found = [&]() -> shared::EyeState {
        if (eye) return *eye;
        shared::EyeState before{};
        if (index > 0) PacketReader(ranks_.receive(rank_of(index - 1), Ranks::Stream::Eyes)).value(before);
        return finds.fresh ? shared::EyeState{} : before;
    };
    const auto hand_on = [&](const shared::EyeState& left) {
        if (finds.all_known || index + 1 == frames_) return;
        PacketWriter packet;
        packet.value(left);
        ranks_.send(rank_of(index + 1), Ranks::Stream::Eyes, packet.take());
    };
    render::ToneMapped shown;
    if (render::FrameQueue::needs_finished_frame(settings)) {  // the eye has a say in what is scattered in it
        mapper_.set_eye(found());
        shown = mapper_.map(settings, picture, seconds, outputs);
        hand_on(shown.eye);
    } else {
        // Ranks wait for one another while an eye adapts, and for nothing else.
        render::ToneChainSettings rest = settings;
        std::vector<float> retina;
        if (settings.glare == render::Glare::Scatter) {
            render::ToneMapped scattered = mapper_.map(settings, picture, 0, {.display = false, .retina = true});
            graph::add_times(frame.timings, scattered.timings);
            retina = std::move(scattered.retina), picture.values = retina;
            rest.glare = render::Glare::None;
        }
        const render::ViewStatistics seen = mapper_.measure(rest, picture);
        shared_eye_.set_eye(found());
        const render::ToneMapped adapted = shared_eye_.adapt(rest, std::span(&seen, 1), 0, seconds);
        hand_on(adapted.eye);
        shown = mapper_.show(
            rest, picture, adapted.curve,
            {.display = outputs.display, .display_light = outputs.display_light, .projection = outputs.projection});
        shown.curve = adapted.curve, shown.histogram = adapted.histogram, shown.eye = adapted.eye;
        graph::add_times(frame.timings, adapted.timings);
        if (outputs.scene) shown.scene = std::move(frame.retina);
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
