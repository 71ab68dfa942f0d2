#include <algorithm>

#include "render/passes/passes.h"

namespace vesper {

constexpr uint32_t kHalvings = 3;  // texels that vote overlap by so many halvings of their side

Resource add_histogram(FrameGraph& graph, const Kernels& kernels, const Pyramid& pyramid, uint32_t level, VkExtent2D image, const HistogramSettings& settings) {
    if (settings.bins < 1 || settings.bins > shared::kMaxBins)
        throw Error("histogram: " + std::to_string(settings.bins) + " bins; 1 to " + std::to_string(shared::kMaxBins) + " are possible");
    if (level < 1 || level > pyramid.levels.size())
        throw Error("histogram: foveal level " + std::to_string(level) + "; the image has levels 1 to " + std::to_string(pyramid.levels.size()));
    const Resource histogram = graph.transient("histogram", buffer_shape(sizeof(shared::Histogram)));
    graph.clear("clear histogram", histogram);
    // As many votes per pixel as 32 bits hold for all of them, twice, and for what rounding adds.
    const uint64_t pixels = uint64_t(image.width) * image.height;
    const uint32_t votes = uint32_t(std::clamp<uint64_t>(0xf0000000u / (2 * pixels), 1, 4096));
    const auto count = [&](const char* name, Resource texels, VkExtent2D size, uint32_t from, bool census, uint32_t overlap) {
        const shared::HistogramPush push{{image.width, image.height}, {size.width, size.height}, from, settings.bins, settings.ln_low(), settings.bins_per_ln(),
                                         votes, settings.split ? 1u : 0u, census ? 1u : 0u, overlap};
        const Kernel& kernel = kernels.histogram;
        graph.dispatch(name, kernel, {load(texels), update(histogram)}, push, cover(size.width, size.height, kernel.group[0], kernel.group[1] * kernels.histogram_rows));
    };
    const bool fine = settings.fine && level > 1, overlaps = fine && settings.overlap;
    // A texel for every 2^-kHalvings of its side: of those of the finer level and the ones 1, 2, 4 ... before them.
    const uint32_t halvings = overlaps ? std::min(level - 1, kHalvings) : 0;
    Resource texels = pyramid.levels[level - halvings - 1];
    VkExtent2D size = pyramid.extents[level - halvings - 1];
    for (uint32_t k = 0; k < halvings; ++k) {
        const uint32_t apart = 1u << k;
        const VkExtent2D larger{size.width + apart, size.height + apart};
        const std::string name = "overlapping " + std::to_string(k + 1);
        const Resource to = graph.transient(name, image_shape(kSceneFormat, larger));
        graph.dispatch(name, kernels.pyramid, {load(texels), store(to)},
                       shared::PyramidPush{{size.width, size.height}, {larger.width, larger.height}, 0, 0, apart},
                       cover(larger.width, larger.height, kernels.pyramid.group[0], kernels.pyramid.group[1]));
        texels = to, size = larger;
    }
    count("histogram", texels, size, level, !overlaps, 2 * halvings);
    if (fine) count("fine histogram", pyramid.levels[0], pyramid.extents[0], 1, overlaps, 0);
    return histogram;
}

}  // namespace vesper
