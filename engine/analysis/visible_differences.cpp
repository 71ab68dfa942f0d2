#include "analysis/visible_differences.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/summed_energy.h"
#include "base/budget.h"
#include "base/parallel.h"

namespace vesper::analysis {
namespace {

constexpr float kMaskingSlope = 0.7f;  // s of Daly 1993, whose b is 4
constexpr double kFovea = 0.25;        // degrees: of the weight exp(-r^2 / (2 kFovea^2)) of what lies beside a place
constexpr double kMostGain = 2;        // of a pattern that suits the channels: its contrast over its largest JND
constexpr double kLeast = 1e-3;        // thresholds: detected once in 5e10 times

// The least of cost(i) + slope (x - i)^2 over each row of `width`, and the rows as columns: the lower envelope of
// parabolas (Felzenszwalb and Huttenlocher 2012).
std::vector<float> least_in_rows(const std::vector<float>& rows, size_t width, double slope) {
    const size_t height = rows.size() / width;
    std::vector<float> columns(rows.size());
    in_parallel(height, 16, [&](size_t begin, size_t end) {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        std::vector<size_t> lowest;  // parabolas of the envelope
        std::vector<double> from;    // where each of them begins
        for (size_t y = begin; y < end; ++y) {
            const float* const cost = rows.data() + y * width;
            // Where parabola b of two becomes the lower one.
            const auto crossing = [&](size_t a, size_t b) {
                return (double(a) + double(b)) / 2 +
                       (double(cost[b]) - double(cost[a])) / (2 * slope * (double(b) - double(a)));
            };
            lowest.clear(), from.clear();
            for (size_t i = 0; i < width; ++i) {
                if (std::isinf(cost[i])) continue;
                while (!lowest.empty() && crossing(lowest.back(), i) <= from.back()) lowest.pop_back(), from.pop_back();
                from.push_back(lowest.empty() ? -kInfinity : crossing(lowest.back(), i));
                lowest.push_back(i);
            }
            size_t at = 0;
            for (size_t x = 0; x < width; ++x) {
                while (at + 1 < lowest.size() && from[at + 1] < double(x)) ++at;
                const double away = lowest.empty() ? 0 : double(x) - double(lowest[at]);
                columns[x * height + y] = lowest.empty() ? std::numeric_limits<float>::infinity()
                                                         : float(double(cost[lowest[at]]) + slope * away * away);
            }
        }
    });
    return columns;
}

// By pixel, the largest difference of the two pictures, JND, each with its weight in a fovea about the pixel.
std::vector<float> largest_around(const PicturePair& pair, const JndScale& scale) {
    std::vector<float> costs(pair.first.size());  // -ln of differences
    in_parallel(costs.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
        const auto jnd = [&](float l) { return scale.jnd(std::isfinite(l) ? double(l) : 0); };
        for (size_t i = begin; i < end; ++i)
            costs[i] = float(-std::log(std::abs(jnd(pair.first[i]) - jnd(pair.second[i]))));
    });
    const double slope = 0.5 / std::pow(kFovea * pair.pixels_per_degree, 2);
    costs = least_in_rows(least_in_rows(costs, pair.width, slope), pair.height, slope);
    in_parallel(costs.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) costs[i] = std::exp(-costs[i]);
    });
    return costs;
}

// Energies of differences, in squares of thresholds of a grating across the field.
class Energies {
public:
    Energies(const PicturePair& pair, double field) : pair_(pair), field_(field) {}

    // Channels of a band come one behind the other.
    void add(const Channel& channel) {
        if (channel.frequency != frequency_) finish_band();
        band_kind_ = channel.band, frequency_ = channel.frequency, grid_ = channel.grid;
        band_.resize(grid_.size());
        const bool masked = channel.band != Channel::Band::Below;  // luminance of a region is no contrast
        visit_picture([&](size_t i) {
            const double size = std::abs(channel.first[i] - channel.second[i]);
            const double mask = std::sqrt(std::min(std::norm(channel.first[i]), std::norm(channel.second[i])));
            const double seen = masked ? size / threshold_elevation(mask) : size;
            band_[i] += seen * seen;
        });
    }

    // By pixel: of what an eye sums that looks there, and of the place alone.
    std::vector<double> summed() { return finish_band(), summed_.pixels(pair_.width, pair_.height); }
    std::vector<double> local() { return finish_band(), local_.pixels(pair_.width, pair_.height); }

private:
    // Of the samples of the picture, without its margins, in parallel.
    template <typename Visit>
    void visit_picture(const Visit& visit) const {
        const size_t columns = (pair_.width - 1) / grid_.step + 1, rows = (pair_.height - 1) / grid_.step + 1;
        in_parallel(rows, 8, [&](size_t begin, size_t end) {
            for (size_t y = begin; y < end; ++y)
                for (size_t x = 0; x < columns; ++x) visit(y * grid_.width + x);
        });
    }
    void finish_band() {
        if (band_.empty()) return;
        add_to(local_, band_);
        const double area = summation_area(frequency_);
        band_ = summed_energies(band_, grid_, pair_.pixels_per_degree, area);
        if (band_kind_ == Channel::Band::Below) {
            // A picture that is brighter as a whole is brighter in the whole field.
            std::vector<double> whole(grid_.size());
            visit_picture([&](size_t i) { whole[i] = 1; });
            whole = summed_energies(whole, grid_, pair_.pixels_per_degree, area);
            visit_picture([&](size_t i) { band_[i] /= whole[i]; });
        } else {
            // A grating that is one threshold fills the field: 1 / (1 / field^2 + 1 / area) of the area.
            for (double& energy : band_) energy *= 1 + area / (field_ * field_);
        }
        add_to(summed_, band_);
        band_.clear();
    }
    void add_to(ChannelSum& sum, const std::vector<double>& values) const {
        std::vector<double>& to = sum.at(grid_);
        for (size_t i = 0; i < values.size(); ++i) to[i] += values[i];
    }

    const PicturePair& pair_;
    double field_;  // degrees
    double frequency_ = 0;
    ChannelGrid grid_;
    Channel::Band band_kind_ = Channel::Band::Below;
    std::vector<double> band_;
    ChannelSum summed_, local_;
};

}  // namespace

double threshold_elevation(double response) {
    return std::sqrt(std::sqrt(1 + double(std::pow(float(std::abs(response)), 4 * kMaskingSlope))));  // fast
}

VisibleDifferences visible_differences(const PicturePair& pair, const ContrastEye& eye) {
    const Budget budget("comparing pictures");
    const JndScale scale(eye);
    Energies energies(pair, eye.field);
    visit_channels(pair, scale, [&](const Channel& channel) { energies.add(channel); });
    const std::vector<double> local = energies.local(), summed = energies.summed();
    const std::vector<float> around = largest_around(pair, scale);
    const auto place = size_t(std::max_element(local.begin(), local.end()) - local.begin());
    VisibleDifferences found{.x = uint32_t(place % pair.width), .y = uint32_t(place / pair.width)};
    found.probability.resize(summed.size());
    in_parallel(summed.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            // Energy that is summed from afar does not count.
            const double contrast = std::min(std::sqrt(summed[i]), kMostGain * double(around[i]));
            found.probability[i] = contrast < kLeast ? 0 : float(detection_probability(power_of_contrast(contrast)));
        }
    });
    found.largest = double(*std::max_element(found.probability.begin(), found.probability.end()));
    double half = 0, most = 0, nearly_all = 0;
    for (const float p : found.probability) half += p > 0.5f, most += p > 0.75f, nearly_all += p > 0.95f;
    const auto pixels = double(summed.size());
    found.above_half = half / pixels, found.above_75 = most / pixels, found.above_95 = nearly_all / pixels;
    return found;
}

}  // namespace vesper::analysis
