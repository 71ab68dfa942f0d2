#include "render/view_statistics.h"

#include <algorithm>

namespace vesper::render {

FovealTexels texels_about(std::span<const glm::vec4> level, glm::uvec2 size, glm::vec2 gaze) {
    // The adaptation reads from one texel before the one below the gaze, less half, to two behind.
    const glm::ivec2 base(glm::floor(gaze - 0.5f)), last = glm::ivec2(size) - 1,
                                                    from = glm::clamp(base - 1, glm::ivec2(0), last),
                                                    to = glm::clamp(base + 2, glm::ivec2(0), last);
    FovealTexels about{.size = glm::uvec2(to - from + 1), .gaze = gaze - glm::vec2(from), .texels = {}};
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) about.texels.push_back(level[size_t(y) * size.x + size_t(x)]);
    return about;
}

shared::Histogram sum_of_histograms(std::span<const ViewStatistics> pictures) {
    shared::Histogram sum{};
    for (const ViewStatistics& picture : pictures) {
        const shared::Histogram& one = picture.histogram;
        sum.finite += one.finite, sum.non_finite += one.non_finite, sum.votes += one.votes;
        for (size_t bin = 0; bin < shared::kMaxBins; ++bin) sum.count[bin] += one.count[bin];
    }
    return sum;
}

glm::vec4 whole_of(std::span<const ViewStatistics> pictures) {
    if (pictures.size() == 1) return pictures.front().whole;
    double pixels = 0, luminance = 0, logarithm = 0;
    float largest = 0;
    for (const ViewStatistics& picture : pictures) {
        const glm::dvec4 whole = picture.whole;
        if (!(whole.y > 0)) continue;  // nothing that is finite
        luminance += whole.y * whole.x, logarithm += whole.y * whole.z, pixels += whole.y;
        largest = std::max(largest, picture.whole.w);
    }
    if (pixels == 0) return pictures.empty() ? glm::vec4(0) : pictures.front().whole;
    return {luminance / pixels, pixels, logarithm / pixels, largest};
}

}  // namespace vesper::render
