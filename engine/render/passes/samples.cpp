#include "render/passes/samples.h"

#include <bit>

#include "shaders/samples/add_sample.comp.inc"
#include "shaders/samples/mean_of_samples.comp.inc"
#include "shared/samples.h"

namespace vesper::render {
namespace {

using graph::load, graph::store, graph::update;

constexpr gpu::Shader kAddSample{"add_sample.comp", add_sample_comp},
    kMeanOfSamples{"mean_of_samples.comp", mean_of_samples_comp};

// The bits of a whole number behind the point, the lowest first (van der Corput 1935).
double radical_inverse(uint32_t number) {
    double inverse = 0, digit = 0.5;
    for (; number != 0; number /= 2, digit /= 2) inverse += number % 2 * digit;
    return inverse;
}

graph::Groups groups_of(VkExtent2D extent, const gpu::Kernel& kernel) {
    return graph::cover(extent.width, extent.height, kernel.group[0], kernel.group[1]);
}

}  // namespace

std::vector<glm::dvec2> sample_places(uint32_t count) {
    std::vector<glm::dvec2> places(count);
    const double half_a_step = 0.5 / double(std::bit_ceil(count));
    for (uint32_t i = 0; i < count; ++i)
        places[i] = glm::dvec2((i + 0.5) / count, radical_inverse(i) + half_a_step) - 0.5;
    return places;
}

void add_sample(const FrameContext& frame, graph::Resource scene, const SampleSums& to, bool first) {
    const VkExtent2D extent = frame.view.extent;
    const gpu::Kernel& kernel = frame.kernels.get(kAddSample);
    const shared::SamplesPush push{{extent.width, extent.height}, first ? 1u : 0u, 0};
    frame.graph.dispatch("sample", kernel, {load(scene), update(to.sums), update(to.rests)}, push,
                         groups_of(extent, kernel));
}

graph::Resource add_mean_of_samples(const FrameContext& frame, const SampleSums& from, uint32_t samples) {
    const VkExtent2D extent = frame.view.extent;
    const gpu::Kernel& kernel = frame.kernels.get(kMeanOfSamples);
    const graph::Resource scene = frame.graph.transient("mean of samples", graph::image_shape(kSceneFormat, extent));
    const shared::SamplesPush push{{extent.width, extent.height}, 0, float(samples)};
    frame.graph.dispatch("mean of samples", kernel, {load(from.sums), load(from.rests), store(scene)}, push,
                         groups_of(extent, kernel));
    return scene;
}

}  // namespace vesper::render
