#include "samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vesper::bench {
namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return percentile(values, 50);
}

}  // namespace

double percentile(std::span<const double> ascending, double percent) {
    if (ascending.empty()) return 0;
    const double place = percent / 100 * double(ascending.size() - 1);
    const size_t below = std::min(size_t(place), ascending.size() - 1),
                 above = std::min(below + 1, ascending.size() - 1);
    return std::lerp(ascending[below], ascending[above], place - double(below));
}

std::vector<double> Samples::ascending() const {
    std::vector<double> all;
    for (const auto& lap : laps_) all.insert(all.end(), lap.begin(), lap.end());
    std::sort(all.begin(), all.end());
    return all;
}

Spread Samples::spread() const {
    std::vector<double> medians;
    for (const auto& lap : laps_)
        if (!lap.empty()) medians.push_back(median(lap));
    if (medians.empty()) return {};
    const auto [low, high] = std::minmax_element(medians.begin(), medians.end());
    return {percentile(ascending(), 50), *low, *high};
}

double one_percent_low(std::span<const double> ascending_ms) {
    if (ascending_ms.empty()) return 0;
    const auto slowest = ascending_ms.last((ascending_ms.size() + 99) / 100);
    return 1000 * double(slowest.size()) / std::accumulate(slowest.begin(), slowest.end(), 0.0);
}

Ratio ratio(const Spread& a, const Spread& b) {
    if (!(a.low > 0 && a.median > 0 && a.high > 0)) return {0, 0, 0};
    return {b.median / a.median, b.low / a.high, b.high / a.low};
}

}  // namespace vesper::bench
