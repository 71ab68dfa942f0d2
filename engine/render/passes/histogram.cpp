#include "render/passes/histogram.h"

#include <algorithm>

#include "shaders/histogram/histogram.comp.inc"

namespace vesper::render {
namespace {

constexpr gpu::Shader kHistogram{"histogram.comp", histogram_comp};
constexpr uint32_t kHalvings = 3;  // texels that vote overlap by so many halvings of their side

}  // namespace

graph::Resource add_histogram(const FrameContext& frame, const Pyramid& pyramid, uint32_t level,
                              const HistogramSettings& settings) {
    if (settings.bins < 1 || settings.bins > shared::kMaxBins)
        throw Error("histogram: " + std::to_string(settings.bins) + " bins; 1 to " + std::to_string(shared::kMaxBins) +
                    " are possible");
    if (level < 1 || level > pyramid.levels.size())
        throw Error("histogram: foveal level " + std::to_string(level) + "; the image has levels 1 to " +
                    std::to_string(pyramid.levels.size()));
    graph::FrameGraph& graph = frame.graph;
    const VkExtent2D image = frame.view.extent;
    const uint32_t rows = frame.kernels.device().is_cpu() ? 8 : 1;  // texels of a column that one invocation does
    const gpu::Kernel& kernel = frame.kernels.get(kHistogram, {rows});
    const graph::Resource histogram = graph.transient("histogram", graph::buffer_shape(sizeof(shared::Histogram)));
    graph.clear("clear histogram", histogram);
    // As many votes per pixel as 32 bits hold for all of them, twice, and for what rounding adds.
    const uint64_t pixels = std::max(uint64_t(image.width) * image.height, settings.electorate);
    const uint32_t votes = uint32_t(std::clamp<uint64_t>(0xf0000000u / (2 * pixels), 1, 4096));
    const auto count = [&](const char* name, graph::Resource texels, VkExtent2D size, uint32_t from, bool census,
                           uint32_t overlap) {
        const shared::HistogramPush push{{image.width, image.height},
                                         {size.width, size.height},
                                         from,
                                         settings.bins,
                                         settings.ln_low(),
                                         settings.bins_per_ln(),
                                         votes,
                                         settings.split ? 1u : 0u,
                                         census ? 1u : 0u,
                                         overlap};
        graph.dispatch(name, kernel, {graph::load(texels), graph::update(histogram)}, push,
                       graph::cover(size.width, size.height, kernel.group[0], kernel.group[1] * rows));
    };
    const bool fine = settings.fine && level > 1, overlaps = fine && settings.overlap;
    // A texel for every 2^-kHalvings of its side: of those of the finer level and the ones 1, 2, 4 ... before them.
    const uint32_t halvings = overlaps ? std::min(level - 1, kHalvings) : 0;
    LevelTexels texels{pyramid.levels[level - halvings - 1], pyramid.extents[level - halvings - 1]};
    for (uint32_t k = 0; k < halvings; ++k)
        texels = add_overlapping(frame, "overlapping " + std::to_string(k + 1), texels, 1u << k);
    count("histogram", texels.texels, texels.extent, level, !overlaps, 2 * halvings);
    if (fine) count("fine histogram", pyramid.levels[0], pyramid.extents[0], 1, overlaps, 0);
    return histogram;
}

}  // namespace vesper::render
