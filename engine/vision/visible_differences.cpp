#include "vision/visible_differences.h"

#include <algorithm>
#include <cmath>

#include "base/budget.h"
#include "base/parallel.h"

namespace vesper::vision {
namespace {

constexpr double kMaskingSlope = 0.7, kMaskingKnee = 4;  // s and b of Daly 1993
// Of a pixel, in the mean of a fovea: detected for certain, and sums of it do not round off what small ones add.
constexpr double kMostPower = 1e9;
constexpr double kLeastSquare = 1e-6;  // of differences in thresholds: detected once in 5e10 times

}  // namespace

double threshold_elevation(double response) {
    return std::pow(1 + std::pow(std::abs(response), kMaskingSlope * kMaskingKnee), 1 / kMaskingKnee);
}

VisibleDifferences visible_differences(const PicturePair& pair, const ContrastEye& eye) {
    const Budget budget("comparing pictures");
    ChannelSum sum;
    visit_channels(pair, eye, [&](const Channel& channel) {
        std::vector<double>& powers = sum.at(channel.grid);
        const bool masked = channel.band != Channel::Band::Below;  // luminance of a region is no contrast
        in_parallel(powers.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const std::complex<double> difference = channel.first[i] - channel.second[i];
                if (!(std::norm(difference) > kLeastSquare)) continue;
                const double mask = std::sqrt(std::min(std::norm(channel.first[i]), std::norm(channel.second[i])));
                powers[i] += power_of_contrast(masked ? difference / threshold_elevation(mask) : difference);
            }
        });
    });
    std::vector<double> powers = sum.pixels(pair.width, pair.height);
    const auto place = size_t(std::max_element(powers.begin(), powers.end()) - powers.begin());
    for (double& power : powers) power = std::min(power, kMostPower);
    const std::vector<double> means = foveal_means(powers, pair.width, pair.height, pair.pixels_per_degree);
    VisibleDifferences found{.x = uint32_t(place % pair.width), .y = uint32_t(place / pair.width)};
    found.probability.reserve(means.size());
    double half = 0, most = 0, nearly_all = 0;
    for (const double mean : means) {
        const double p = detection_probability(mean);
        found.probability.push_back(float(p));
        half += p > 0.5, most += p > 0.75, nearly_all += p > 0.95;
        found.largest = std::max(found.largest, p);
    }
    const auto pixels = double(means.size());
    found.above_half = half / pixels, found.above_75 = most / pixels, found.above_95 = nearly_all / pixels;
    return found;
}

}  // namespace vesper::vision
