#include "tone_mapper.h"

#include <numbers>

#include "base/stopwatch.h"

namespace vesper {

ToneMapper::ToneMapper(Device& device) : device_(device), kernels_(device), executor_(device), scatter_(device) {}

ToneMapped ToneMapper::map(const ToneChainSettings& settings, const HostPicture& picture, float seconds, Outputs outputs) {
    const Stopwatch watch;
    const auto [width, height] = picture.extent;
    const uint64_t pixels = uint64_t{width} * height, bytes = pixels * 4 * sizeof(float);
    if (pixels == 0 || (picture.channels != 3 && picture.channels != 4) || picture.values.size() != pixels * picture.channels)
        throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) + " px does not have " + std::to_string(picture.values.size()) + " values");
    if (!(picture.vertical_fov > 0 && picture.vertical_fov < std::numbers::pi)) throw Error("a picture covers more than 0 and less than 180 degrees in height");

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
    const View view = View::symmetric(picture.extent, float(picture.vertical_fov), glm::mat4(1));
    ChainInputs given{.seconds = seconds, .remembered = eye_ ? &*eye_ : nullptr, .scatter = nullptr, .corona = nullptr, .outside = picture.outside};
    const shared::EyeState& before = eye_ ? *eye_ : last_eye_;
    if (settings.glare == Glare::Scatter) given.scatter = &scatter_.at(settings.scatter, view);
    if (given.scatter && settings.scatter.has_corona()) given.corona = &corona_.at(settings.scatter, double(before.adaptation), double(before.seconds + seconds));
    const ToneChain chain = add_tone_chain(graph, kernels_, scene, view, settings, given, outputs);
    const double declared_after = watch.milliseconds();
    executor_.run(graph);
    eye_.reset();
    plan_ = graph.describe(executor_.plan());

    ToneMapped result;
    read_tone_chain(executor_, chain, picture.extent, result);
    last_eye_ = result.eye;
    if (given.corona) result.pupil = given.corona->pupil, result.pattern_milliseconds = given.corona->milliseconds;
    result.host_times.declare = declared_after;
    result.milliseconds = watch.milliseconds();
    return result;
}

}  // namespace vesper
