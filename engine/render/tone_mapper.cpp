#include "render/tone_mapper.h"

#include <numbers>

#include "render/passes/picture.h"

namespace vesper {
namespace {

View view_of(VkExtent2D extent, double vertical_fov, const ImageAngles* angles) {
    if (angles) return {.extent = extent, .tangent_low = angles->low, .tangent_high = angles->high};
    if (!(vertical_fov > 0 && vertical_fov < std::numbers::pi)) throw Error("a picture covers more than 0 and less than 180 degrees in height");
    return View::symmetric(extent, float(vertical_fov), glm::mat4(1));
}

}  // namespace

ToneMapper::ToneMapper(Device& device, size_t views) : device_(device), kernels_(device), eye_(device, views), executor_(device) {}

ToneMapped ToneMapper::map(const ToneChainSettings& settings, const HostPicture& picture, float seconds, Outputs outputs) {
    const Stopwatch watch;
    const auto [width, height] = picture.extent;
    const uint64_t pixels = uint64_t{width} * height, bytes = pixels * 4 * sizeof(float);
    if (pixels == 0 || (picture.channels != 3 && picture.channels != 4) || picture.values.size() != pixels * picture.channels)
        throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) + " px does not have " + std::to_string(picture.values.size()) + " values");
    const View view = view_of(picture.extent, picture.vertical_fov, picture.angles);

    finish();
    if (pixels_.bytes() < bytes) {
        pixels_ = {};  // before the next one takes its memory
        pixels_ = HostBuffer(device_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HostBuffer::Direction::ToDevice);
    }
    float* to = reinterpret_cast<float*>(pixels_.data());
    for (const float *from = picture.values.data(), *end = from + picture.values.size(); from != end; from += picture.channels) {
        for (size_t c = 0; c < 3; ++c) *to++ = picture.scale * from[c];
        *to++ = 1;
    }
    pixels_.flush();

    FrameGraph graph;
    const Resource scene = graph.transient("scene", image_shape(kSceneFormat, picture.extent));
    graph.copy("picture", graph.external("picture", pixels_.buffer(), bytes), scene);
    submit(graph, scene, settings, view, seconds, picture.outside, picture.beyond, outputs, {}, watch);
    return *finish();
}

void ToneMapper::submit(const ToneChainSettings& settings, const DevicePicture& picture, const ExternalImage& shown, float seconds, const SubmitSemaphores& semaphores) {
    const Stopwatch watch;
    const View view = view_of(picture.image.extent, picture.vertical_fov, picture.angles);
    FrameGraph graph;
    const Resource scene = add_picture({graph, kernels_, view}, graph.external("picture", picture.image), picture.scale);
    submit(graph, scene, settings, view, seconds, {}, nullptr, {.display = false, .shown = shown}, semaphores, watch);
}

void ToneMapper::submit(FrameGraph& graph, Resource scene, const ToneChainSettings& settings, const View& view, float seconds, const std::vector<OffscreenLamp>& outside,
                        const OffscreenLight* beyond, const Outputs& outputs, const SubmitSemaphores& semaphores, Stopwatch watch) {
    if (EyeKeeper::looks_back(settings)) finish();
    ChainInputs given = eye_.inputs(executor_, settings, view, seconds);
    given.scatter.lamps = outside, given.scatter.pictures = beyond;
    Pending pending{watch, {}, {}};
    pending.chain = add_tone_chain({graph, kernels_, view}, scene, settings, given, outputs);
    pending.result.extent = view.extent;
    if (given.corona) pending.result.pupil = given.corona->pupil, pending.result.pattern_milliseconds = given.corona->milliseconds;
    pending.result.host_times.declare = watch.milliseconds();
    executor_.submit(graph, semaphores);
    // Nothing fails from here on.
    eye_.submitted();
    graph_ = std::move(graph);
    pending_ = std::move(pending);
}

std::optional<ToneMapped> ToneMapper::finish() {
    if (!executor_.finish()) pending_.reset();
    if (!pending_) return std::nullopt;
    ToneMapped result = std::move(pending_->result);
    const double declared_after = result.host_times.declare;
    read_tone_chain(executor_, pending_->chain, result.extent, result);
    eye_.read(result.eye);
    result.host_times.declare = declared_after;
    result.milliseconds = pending_->watch.milliseconds();
    pending_.reset();
    return result;
}

}  // namespace vesper
