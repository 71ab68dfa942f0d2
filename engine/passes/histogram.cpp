#include <algorithm>
#include <cmath>

#include "passes/passes.h"

namespace vesper {

Resource add_histogram(FrameGraph& graph, const Kernels& kernels, const Pyramid& pyramid, uint32_t level, VkExtent2D image, const HistogramSettings& settings) {
    if (settings.bins < 1 || settings.bins > shared::kMaxBins)
        throw Error("histogram: " + std::to_string(settings.bins) + " bins; 1 to " + std::to_string(shared::kMaxBins) + " are possible");
    if (level < 1 || level > pyramid.levels.size())
        throw Error("histogram: foveal level " + std::to_string(level) + "; the image has levels 1 to " + std::to_string(pyramid.levels.size()));
    const Resource histogram = graph.transient("histogram", buffer_shape(sizeof(shared::Histogram)));
    graph.clear("clear histogram", histogram);
    const VkExtent2D size = pyramid.extents[level - 1];
    const shared::HistogramPush push{{image.width, image.height}, {size.width, size.height}, level, settings.bins, settings.ln_low(), settings.bins_per_ln()};
    graph.dispatch("histogram", kernels.histogram, {load(pyramid.levels[level - 1]), update(histogram)}, push,
                   cover(size.width, size.height, kernels.histogram.group[0], kernels.histogram.group[1]));
    return histogram;
}

}  // namespace vesper
