#include "render/passes/bloom.h"

#include <algorithm>
#include <cmath>

#include "shaders/bloom/bloom_blur.comp.inc"
#include "shaders/bloom/bloom_bright.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store;

constexpr gpu::Shader kBloomBright{"bloom_bright.comp", bloom_bright_comp},
    kBloomBlur{"bloom_blur.comp", bloom_blur_comp};

constexpr uint32_t kMaxRadius = 256;  // texels

// Weights 0 .. radius of a Gaussian that sums to one over -radius .. radius.
std::vector<float> gaussian(double sigma) {
    // In double: the sigma of a view of hardly any angle is beyond integers.
    const uint32_t radius = uint32_t(std::min(double(kMaxRadius), std::ceil(3 * sigma)));
    std::vector<float> weights;
    double sum = 0;
    for (uint32_t i = 0; i <= radius; ++i) {
        const double w = std::exp(-0.5 * double(i) * double(i) / (sigma * sigma));
        weights.push_back(float(w));
        sum += i == 0 ? w : 2 * w;
    }
    for (float& w : weights) w = float(w / sum);
    return weights;
}

}  // namespace

graph::Resource add_bloom(const FrameContext& frame, graph::Resource scene, graph::Resource curve, uint32_t tone,
                          const vision::Display& display, const BloomSettings& settings) {
    if (settings.gain == 0) return {};
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const gpu::Kernel& blur = frame.kernels.get(kBloomBlur);
    constexpr uint32_t shrink = shared::kBloomShrink;
    const VkExtent2D small{(view.extent.width + shrink - 1) / shrink, (view.extent.height + shrink - 1) / shrink};
    const glm::uvec2 size{small.width, small.height};
    const graph::Shape shape = graph::image_shape(kBloomFormat, small);
    const graph::Groups groups = graph::cover(small.width, small.height, blur.group[0], blur.group[1]);

    const graph::Resource bright = graph.transient("bright", shape);
    graph.dispatch(
        "bright", frame.kernels.get(kBloomBright, {tone}), {load(scene), sample(curve), store(bright)},
        shared::BloomBrightPush{
            {view.extent.width, view.extent.height}, size, display.low(), display.high(), settings.threshold},
        groups);

    const std::vector<float> weights =
        gaussian(std::max(1e-3, settings.sigma_degrees / view.degrees_per_pixel() / shrink));
    const uint32_t radius = uint32_t(weights.size()) - 1;
    const graph::Resource taps = graph.upload("glare weights", weights, VK_FORMAT_R32_SFLOAT);
    const graph::Resource across = graph.transient("glare across", shape), bloom = graph.transient("glare", shape);
    graph.dispatch("glare across", blur, {load(bright), sample(taps), store(across)},
                   shared::BloomBlurPush{size, {1, 0}, radius}, groups);
    graph.dispatch("glare", blur, {load(across), sample(taps), store(bloom)},
                   shared::BloomBlurPush{size, {0, 1}, radius}, groups);
    return bloom;
}

}  // namespace vesper::render
