#include "render/shared_eye.h"

#include <algorithm>

namespace vesper::render {
namespace {

constexpr size_t kRowOfTiles = 256;  // of the image that has the colours of all pictures

graph::Resource image_of(graph::FrameGraph& graph, const std::string& name, const std::vector<glm::vec4>& texels,
                         VkExtent2D extent) {
    const graph::Resource image = graph.transient(name, graph::image_shape(kSceneFormat, extent));
    graph.copy(name, graph.upload(name + " of the host", texels), image);
    return image;
}

// Tiles without pixels, which have no say, fill the last row.
Colours colours_of(graph::FrameGraph& graph, std::span<const ViewStatistics> pictures) {
    std::vector<glm::vec4> tiles;
    for (const ViewStatistics& picture : pictures)
        tiles.insert(tiles.end(), picture.colours.begin(), picture.colours.end());
    if (tiles.empty()) return {};
    const size_t columns = std::min(tiles.size(), kRowOfTiles), rows = (tiles.size() + columns - 1) / columns;
    tiles.resize(rows * columns, glm::vec4(0));
    const VkExtent2D extent{uint32_t(columns), uint32_t(rows)};
    return {image_of(graph, "colours", tiles, extent), extent};
}

}  // namespace

ToneMapped SharedEye::adapt(const ToneChainSettings& settings, std::span<const ViewStatistics> pictures,
                            size_t looked_at, float seconds) {
    const OperatorInfo& op = operator_info(settings.tone_operator);
    const FovealTexels& fovea = pictures[looked_at].fovea;
    FrameQueue::Declared frame{.extent = {1, 1}};
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View view = gpu_scene::View::symmetric({1, 1}, 1, glm::mat4(1));
    const ChainInputs inputs{.seconds = seconds, .eye = frames_.eye()};
    shared::ToneParameters parameters = tone_parameters(op, settings.histogram, settings.tone, settings.display,
                                                        {1, {fovea.size.x, fovea.size.y}, {1, 1}}, seconds);
    parameters.gaze = fovea.gaze;
    const graph::Resource histogram = graph.upload("histogram", std::vector{sum_of_histograms(pictures)});
    const auto [curve, eye] = add_adaptation(frames_.context(graph, view),
                                             {image_of(graph, "all pictures", {whole_of(pictures)}, {1, 1}),
                                              image_of(graph, "fovea", fovea.texels, {fovea.size.x, fovea.size.y}),
                                              histogram, colours_of(graph, pictures), inputs.eye},
                                             op, parameters);
    frame.chain.curve = add_readback(graph, "tone curve", curve, sizeof(shared::ToneCurve));
    frame.chain.histogram = add_readback(graph, "histogram", histogram, sizeof(shared::Histogram));
    frame.chain.eye = add_readback(graph, "eye", eye, sizeof(shared::EyeState));
    frames_.submit(std::move(frame), inputs, {});
    return *frames_.finish();
}

}  // namespace vesper::render
