#include <algorithm>

#include "passes/passes.h"

namespace vesper {

Resource add_histogram(FrameGraph& graph, const Kernels& kernels, const Pyramid& pyramid, uint32_t level, VkExtent2D image, const HistogramSettings& settings) {
    if (settings.bins < 1 || settings.bins > shared::kMaxBins)
        throw Error("histogram: " + std::to_string(settings.bins) + " bins; 1 to " + std::to_string(shared::kMaxBins) + " are possible");
    if (level < 1 || level > pyramid.levels.size())
        throw Error("histogram: foveal level " + std::to_string(level) + "; the image has levels 1 to " + std::to_string(pyramid.levels.size()));
    const Resource histogram = graph.transient("histogram", buffer_shape(sizeof(shared::Histogram)));
    graph.clear("clear histogram", histogram);
    // As many votes per pixel as 32 bits hold for all of them, twice.
    const uint64_t pixels = uint64_t(image.width) * image.height;
    const uint32_t votes = uint32_t(std::clamp<uint64_t>(0xffffffffu / (2 * pixels), 1, 4096));
    const auto count = [&](const char* name, uint32_t from, bool census) {
        const VkExtent2D size = pyramid.extents[from - 1];
        const shared::HistogramPush push{{image.width, image.height}, {size.width, size.height}, from, settings.bins, settings.ln_low(), settings.bins_per_ln(),
                                         votes, settings.split ? 1u : 0u, census ? 1u : 0u};
        const Kernel& kernel = kernels.histogram;
        graph.dispatch(name, kernel, {load(pyramid.levels[from - 1]), update(histogram)}, push,
                       cover(size.width, size.height, kernel.group[0], kernel.group[1] * kernels.histogram_rows));
    };
    count("histogram", level, true);
    if (settings.fine && level > 1) count("fine histogram", 1, false);
    return histogram;
}

}  // namespace vesper
