#include "render/tone_mapper.h"

#include <numbers>

#include "render/passes/picture.h"

namespace vesper::render {
namespace {

gpu_scene::View view_of(VkExtent2D extent, double vertical_fov, const vision::ImageAngles* angles) {
    if (angles) return gpu_scene::View::of(*angles);
    if (!(vertical_fov > 0 && vertical_fov < std::numbers::pi))
        throw Error("a picture covers more than 0 and less than 180 degrees in height");
    return gpu_scene::View::symmetric(extent, float(vertical_fov), glm::mat4(1));
}

}  // namespace

ToneMapper::ToneMapper(gpu::Device& device, size_t views) : device_(device), frames_(device, views) {}

ToneMapped ToneMapper::map(const ToneChainSettings& settings, const HostPicture& picture, float seconds,
                           Outputs outputs) {
    return run(settings, picture, seconds, {}, outputs);
}

ViewStatistics ToneMapper::measure(const ToneChainSettings& settings, const HostPicture& picture) {
    return *run(settings, picture, 0, {}, {.display = false, .statistics = true}).statistics;
}

ToneMapped ToneMapper::show(const ToneChainSettings& settings, const HostPicture& picture,
                            const shared::ToneCurve& curve, const Outputs& outputs) {
    return run(settings, picture, 0, curve, outputs);
}

ToneMapped ToneMapper::run(const ToneChainSettings& settings, const HostPicture& picture, float seconds,
                           const std::optional<shared::ToneCurve>& curve, const Outputs& outputs) {
    const Stopwatch watch;
    const auto [width, height] = picture.extent;
    const uint64_t pixels = uint64_t{width} * height, bytes = pixels * 4 * sizeof(float);
    if (pixels == 0 || (picture.channels != 3 && picture.channels != 4) ||
        picture.values.size() != pixels * picture.channels)
        throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) + " px does not have " +
                    std::to_string(picture.values.size()) + " values");
    const gpu_scene::View view = view_of(picture.extent, picture.vertical_fov, picture.angles);

    finish();
    if (pixels_.bytes() < bytes) {
        pixels_ = {};  // before the next one takes its memory
        pixels_ =
            gpu::HostBuffer(device_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::HostBuffer::Direction::ToDevice);
    }
    float* to = reinterpret_cast<float*>(pixels_.data());
    for (const float *from = picture.values.data(), *end = from + picture.values.size(); from != end;
         from += picture.channels) {
        for (size_t c = 0; c < 3; ++c) *to++ = picture.scale * from[c];
        *to++ = 1;
    }
    pixels_.flush();

    FrameQueue::Declared frame{.watch = watch};
    const graph::Resource scene = frame.graph.transient("scene", graph::image_shape(kSceneFormat, picture.extent));
    frame.graph.copy("picture", frame.graph.external("picture", pixels_.buffer(), bytes), scene);
    ChainInputs inputs = frames_.inputs(settings, view, seconds);
    inputs.curve = curve;
    inputs.scatter.lamps = picture.outside, inputs.scatter.pictures = picture.beyond;
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
