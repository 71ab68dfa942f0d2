#include "analysis/visible_differences.h"

#include <algorithm>
#include <cmath>

#include "base/budget.h"
#include "base/parallel.h"

namespace vesper::analysis {
namespace {

constexpr float kMaskingSlope = 0.7f;  // s of Daly 1993, whose b is 4
// Of a pixel, in the mean of a fovea: detected for certain, and sums of it do not round off what small ones add.
constexpr double kMostPower = 1e9;
constexpr double kLeastSquare = 1e-6;  // of differences in thresholds: detected once in 5e10 times
constexpr double kBeside = 1;          // degrees: around a place, of what an eye that looks there compares
constexpr double kMostGain = 2;        // of a channel: its response over the largest JND of a pattern that suits it

// The largest of the values up to `reach` before and behind each one of rows of `width`, and the rows as columns.
std::vector<float> largest_in_rows(const std::vector<float>& rows, size_t width, size_t reach) {
    const size_t height = rows.size() / width, window = 2 * reach + 1;
    std::vector<float> columns(rows.size());
    in_parallel(height, 16, [&](size_t begin, size_t end) {
        // From the first value of each part of the window's length on, and back from its last one.
        std::vector<float> on(width + 2 * reach), back(on.size());
        for (size_t y = begin; y < end; ++y) {
            const auto value = [&](size_t i) {
                return i < reach || i >= reach + width ? 0 : rows[y * width + i - reach];
            };
            for (size_t i = 0; i < on.size(); ++i) on[i] = i % window == 0 ? value(i) : std::max(on[i - 1], value(i));
            for (size_t i = on.size(); i-- > 0;)
                back[i] = i + 1 == on.size() || (i + 1) % window == 0 ? value(i) : std::max(back[i + 1], value(i));
            for (size_t x = 0; x < width; ++x) columns[x * height + y] = std::max(back[x], on[x + 2 * reach]);
        }
    });
    return columns;
}

// By pixel, the largest difference of the two pictures within a square of kBeside on each side, JND.
std::vector<float> largest_around(const PicturePair& pair, const JndScale& scale) {
    std::vector<float> differences(pair.first.size());
    in_parallel(differences.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
        const auto jnd = [&](float l) { return scale.jnd(std::isfinite(l) ? double(l) : 0); };
        for (size_t i = begin; i < end; ++i) differences[i] = float(std::abs(jnd(pair.first[i]) - jnd(pair.second[i])));
    });
    const double most = std::max(pair.width, pair.height);
    const auto reach = size_t(std::min(std::ceil(kBeside * pair.pixels_per_degree), most));
    return largest_in_rows(largest_in_rows(differences, pair.width, reach), pair.height, reach);
}

}  // namespace

double threshold_elevation(double response) {
    return std::sqrt(std::sqrt(1 + double(std::pow(float(std::abs(response)), 4 * kMaskingSlope))));  // fast
}

VisibleDifferences visible_differences(const PicturePair& pair, const ContrastEye& eye) {
    const Budget budget("comparing pictures");
    const JndScale scale(eye);
    ChannelSum sum;
    std::vector<float> around;
    visit_channels(pair, scale, [&](const Channel& channel) {
        const ChannelGrid& grid = channel.grid;
        if (around.empty()) around = largest_around(pair, scale);  // of a pair that can be compared
        std::vector<double>& powers = sum.at(grid);
        const bool masked = channel.band != Channel::Band::Below;  // luminance of a region is no contrast
        in_parallel(grid.height, 8, [&](size_t begin, size_t end) {
            for (size_t y = begin; y < end; ++y)
                for (size_t x = 0; x < grid.width; ++x) {
                    const size_t i = y * grid.width + x,
                                 at = std::min<size_t>(y * grid.step, pair.height - 1) * pair.width +
                                      std::min<size_t>(x * grid.step, pair.width - 1);
                    const std::complex<double> difference = channel.first[i] - channel.second[i];
                    // What coarse filters carry there from afar does not count.
                    const double most = kMostGain * double(around[at]),
                                 size = std::min(std::sqrt(std::norm(difference)), most);
                    if (!(size * size > kLeastSquare)) continue;
                    const double mask = std::sqrt(std::min(std::norm(channel.first[i]), std::norm(channel.second[i])));
                    powers[i] += power_of_contrast(masked ? size / threshold_elevation(mask) : size);
                }
        });
    });
    std::vector<double> powers = sum.pixels(pair.width, pair.height);
    const auto place = size_t(std::max_element(powers.begin(), powers.end()) - powers.begin());
    for (double& power : powers) power = std::min(power, kMostPower);
    const std::vector<double> means = foveal_means(powers, pair.width, pair.height, pair.pixels_per_degree);
    VisibleDifferences found{.x = uint32_t(place % pair.width), .y = uint32_t(place / pair.width)};
    found.probability.resize(means.size());
    in_parallel(means.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) found.probability[i] = float(detection_probability(means[i]));
    });
    found.largest = detection_probability(*std::max_element(means.begin(), means.end()));
    double half = 0, most = 0, nearly_all = 0;
    for (const float p : found.probability) half += p > 0.5f, most += p > 0.75f, nearly_all += p > 0.95f;
    const auto pixels = double(means.size());
    found.above_half = half / pixels, found.above_75 = most / pixels, found.above_95 = nearly_all / pixels;
    return found;
}

}  // namespace vesper::analysis
