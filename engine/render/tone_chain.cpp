#include "render/tone_chain.h"

#include "graph/times.h"

namespace vesper::render {
namespace {

using graph::Resource;

template <class T>
void read_all(const graph::Executor& executor, Resource readback, std::vector<T>& to) {
    to.clear();
    if (!readback) return;
    const auto values = executor.read_as<T>(readback);
    to.assign(values.begin(), values.end());
}

}  // namespace

Resource add_readback(graph::FrameGraph& graph, const std::string& name, Resource from, uint64_t bytes, bool wanted) {
    if (!wanted) return {};
    const Resource to = graph.readback(name + " on the host", bytes);
    graph.copy("read " + name, from, to);
    return to;
}

ToneChain add_tone_chain(const FrameContext& frame, Resource light, const ToneChainSettings& settings,
                         const ChainInputs& inputs, const Outputs& outputs) {
    graph::FrameGraph& graph = frame.graph;
    const uint64_t pixels = uint64_t(frame.view.extent.width) * frame.view.extent.height;
    ToneChain chain{.shown_extent = outputs.projection ? outputs.projection->extent : frame.view.extent};
    chain.scene = add_readback(graph, "scene", light, pixels * 16, outputs.scene);

    const Resource retina = add_retina(frame, light, inputs.scatter, inputs.corona);
    if (outputs.retina) {
        chain.retina = add_readback(graph, "retina", retina, pixels * 16);
        return chain;
    }
    const Statistics statistics = add_statistics(frame, retina, settings);
    chain.foveal_level = statistics.fovea.level;
    chain.retina_light = retina, chain.whole_retina = statistics.luminance.levels.back();

    Resource curve;
    if (inputs.curve) {
        curve = graph.upload("tone curve", std::vector{*inputs.curve}, VK_FORMAT_R32G32B32A32_SFLOAT);
    } else {
        const Adaptation adapted = add_adaptation_to(frame, statistics, settings, inputs.eye, inputs.seconds);
        curve = adapted.curve;
        chain.curve = add_readback(graph, "tone curve", curve, sizeof(shared::ToneCurve));
        chain.histogram = add_readback(graph, "histogram", statistics.histogram, sizeof(shared::Histogram));
        chain.eye = add_readback(graph, "eye", adapted.eye, sizeof(shared::EyeState));
    }
    const Shown shown = add_show(frame, retina, statistics, curve, settings,
                                 {outputs.display_light, outputs.shown, outputs.projection});
    const uint64_t shown_pixels = uint64_t{chain.shown_extent.width} * chain.shown_extent.height;
    chain.display = add_readback(graph, "display", shown.codes, shown_pixels * 4, outputs.display);
    chain.display_light = add_readback(graph, "display light", shown.display_light, pixels * 16, outputs.display_light);
    return chain;
}

void read_tone_chain(const graph::Executor& executor, const ToneChain& chain, VkExtent2D extent, ToneMapped& to) {
    to.extent = extent, to.shown_extent = chain.shown_extent;
    read_all(executor, chain.display, to.display);
    read_all(executor, chain.scene, to.scene);
    read_all(executor, chain.retina, to.retina);
    read_all(executor, chain.display_light, to.display_light);
    if (chain.curve) {
        to.curve = read_one<shared::ToneCurve>(executor, chain.curve);
        to.histogram = read_one<shared::Histogram>(executor, chain.histogram);
        to.eye = read_one<shared::EyeState>(executor, chain.eye);
    }
    to.foveal_level = chain.foveal_level;
    to.timings.clear();
    graph::add_times(to.timings, executor.timings());  // passes of one name are counted together
    to.host_times = executor.host_times();
}

}  // namespace vesper::render
