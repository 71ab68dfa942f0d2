#include "render/tone_mapper.h"

#include "render/passes/picture.h"

namespace vesper::render {
ToneMapper::ToneMapper(gpu::Device& device) : upload_(device), frames_(device) {}

ToneMapped ToneMapper::map(const ToneChainSettings& settings, const HostPicture& picture, float seconds,
                           Outputs outputs) {
    const Stopwatch watch;
    const gpu_scene::View view = view_of(picture.extent, picture.vertical_fov, picture.angles);
    FrameQueue::Declared frame{.watch = watch};
    const graph::Resource scene = upload_.add(frame.graph, picture);  // no such frame is left under way

    finish();
    ChainInputs inputs = frames_.inputs(settings, view, seconds);
    inputs.scatter.lamps = picture.outside;
    submit(std::move(frame), scene, settings, view, inputs, outputs, {});
    return *finish();
}

void ToneMapper::submit(const ToneChainSettings& settings, const DevicePicture& picture,
                        const graph::ExternalImage& shown, float seconds, const graph::SubmitSemaphores& semaphores) {
    const Stopwatch watch;
    const gpu_scene::View view = view_of(picture.image.extent, picture.vertical_fov, picture.angles);
    frames_.prepare(settings);
    FrameQueue::Declared frame{.watch = watch};
    const graph::Resource external = frame.graph.external("picture", picture.image);
    const graph::Resource scene = add_picture(frames_.context(frame.graph, view), external, picture.scale);
    submit(std::move(frame), scene, settings, view, frames_.inputs(settings, view, seconds),
           {.display = false, .shown = shown}, semaphores);
}

void ToneMapper::submit(FrameQueue::Declared frame, graph::Resource scene, const ToneChainSettings& settings,
                        const gpu_scene::View& view, const ChainInputs& inputs, const Outputs& outputs,
                        const graph::SubmitSemaphores& semaphores) {
    frame.chain = add_tone_chain(frames_.context(frame.graph, view), scene, settings, inputs, outputs);
    frame.extent = view.extent;
    frames_.submit(std::move(frame), inputs, semaphores);
}

}  // namespace vesper::render
