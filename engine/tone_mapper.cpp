#include "tone_mapper.h"

#include <chrono>
#include <cstring>
#include <numbers>

namespace vesper {

ToneMapper::ToneMapper(Device& device) : device_(device), kernels_(device), executor_(device) {}

ToneMapped ToneMapper::map(const ToneChainSettings& settings, const LuminancePicture& picture, float seconds, Outputs outputs) {
    const auto start = std::chrono::steady_clock::now();
    const auto [width, height] = picture.extent;
    if (width == 0 || height == 0 || picture.rgba.size() != uint64_t{4} * width * height)
        throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) + " px does not have " + std::to_string(picture.rgba.size()) + " values");
    if (!(picture.vertical_fov > 0 && picture.vertical_fov < std::numbers::pi)) throw Error("a picture covers more than 0 and less than 180 degrees in height");

    const auto bytes = std::as_bytes(picture.rgba);
    if (pixels_.bytes() < bytes.size())
        pixels_ = HostBuffer(device_, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HostBuffer::Direction::ToDevice);
    std::memcpy(pixels_.data(), bytes.data(), bytes.size());
    pixels_.flush();

    FrameGraph graph;
    const Resource scene = graph.transient("scene", image_shape(kSceneFormat, picture.extent));
    graph.copy("picture", graph.external("picture", pixels_.buffer(), bytes.size()), scene);
    const View view = View::symmetric(picture.extent, float(picture.vertical_fov), glm::mat4(1));
    const ToneChain chain = add_tone_chain(graph, kernels_, scene, view, settings, seconds, outputs, eye_ ? &*eye_ : nullptr);
    executor_.run(graph);
    eye_.reset();
    plan_ = graph.describe(executor_.plan());

    ToneMapped result;
    read_tone_chain(executor_, chain, picture.extent, result);
    result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace vesper
