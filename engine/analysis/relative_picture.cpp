#include "analysis/relative_picture.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/luminance.h"

namespace vesper::analysis {
namespace {

constexpr double kHighlights = 0.99, kSuns = 0.999;  // parts of the pixels with light that are darker
constexpr double kCountsNothing = -8,
                 kCountsWhole = -6;  // log10 of luminance over highlights from which it counts, and fully

std::vector<float> lit_luminances(std::span<const float> rgb) {
    std::vector<float> lit;
    lit.reserve(rgb.size() / 3);
    for (size_t i = 0; i + 2 < rgb.size(); i += 3) {
        const auto l =
            static_cast<float>(std::min(luminance({rgb[i], rgb[i + 1], rgb[i + 2]}), static_cast<double>(FLT_MAX)));
        if (l > 0 && std::isfinite(rgb[i]) && std::isfinite(rgb[i + 1]) && std::isfinite(rgb[i + 2])) lit.push_back(l);
    }
    return lit;
}

double log_of(float luminance) { return std::log10(static_cast<double>(luminance)); }

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

RelativeLuminance relative_luminance(std::span<const float> rgb) {
    std::vector<float> lit = lit_luminances(rgb);
    if (lit.empty()) return {};
    const auto count = static_cast<double>(lit.size());
    const auto end = lit.begin() + static_cast<ptrdiff_t>(std::ceil(kSuns * count));
    const auto bright = lit.begin() + std::min(static_cast<ptrdiff_t>(kHighlights * count), end - lit.begin() - 1);
    if (end != lit.end()) std::nth_element(lit.begin(), end, lit.end());
    std::nth_element(lit.begin(), bright, end);

    double highlights = 0;
    for (auto l = bright; l != end; ++l) highlights += log_of(*l);
    highlights /= static_cast<double>(end - bright);
    double sum = 0, weights = 0;
    for (auto l = lit.begin(); l != end; ++l) {
        const double log = log_of(*l),
                     weight = smooth_step(highlights + kCountsNothing, highlights + kCountsWhole, log);
        sum += weight * log, weights += weight;
    }
    return {std::pow(10, sum / weights), std::pow(10, highlights)};
}

double plausible_luminance(const RelativeLuminance& picture) {
    if (!(picture.log_average > 0)) return 0;
    return std::clamp(std::pow(10, 3.5 - 0.75 * std::log10(picture.highlights / picture.log_average)), 0.1, 3000.0);
}

double plausible_scale(const RelativeLuminance& picture) {
    if (!(picture.log_average > 0)) return 1;
    const double scale =
        std::clamp(plausible_luminance(picture) / picture.log_average, 1e-36, 1e36);  // of what a float holds
    const double digits = std::pow(10, 5 - std::floor(std::log10(scale)));
    return std::round(scale * digits) / digits;
}

}  // namespace vesper::analysis
