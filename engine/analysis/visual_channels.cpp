#include "analysis/visual_channels.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/parallel.h"
#include "vision/fourier.h"

namespace vesper::analysis {
namespace {

using vision::Complexes, vision::fast_length, vision::spectrum_of;
using Complex = std::complex<double>;

constexpr int kOrientations = 4;
constexpr double kCoarsest = 0.5;  // cycles/degree: octaves go down to about here
constexpr size_t kMostOctaves = 12;
constexpr double kReach = 2;       // degrees beyond each edge that are its mirror image: coarse channels reach so far
constexpr size_t kGains = 4096;    // of a radial function
constexpr int kAdaptations = 256;  // luminances at which a channel's sensitivity is known

// The square root of the share of an octave about `centre`: channels an octave apart sum to 1 in their squares.
double octave_share(double octaves) { return std::abs(octaves) < 1 ? std::cos(kPi / 2 * octaves) : 0; }

// Index of a sample in a row of `length` that goes on as its own mirror image.
size_t mirrored(size_t i, size_t length) {
    const size_t turn = i % (2 * length);
    return turn < length ? turn : 2 * length - 1 - turn;
}

// The picture in the top left corner, and its mirror images up to half of the margin on either side, which wraps.
size_t source_of(size_t i, size_t length, size_t whole) {
    const size_t after = (whole - length) / 2;
    return i < length + after ? mirrored(i, length) : mirrored(whole - 1 - i, length);
}

class Pyramid {
public:
    Pyramid(const PicturePair& pair, const JndScale& scale)
        : pair_(pair), scale_(scale), highest_(pair.pixels_per_degree / 2) {
        octaves_ = size_t(std::clamp(std::lround(std::log2(highest_ / kCoarsest)), 1l, long(kMostOctaves)));
        while (octaves_ > 1 && (size_t{1} << octaves_) > std::min(pair.width, pair.height)) --octaves_;
        const size_t coarsest = size_t{1} << (octaves_ - 1);
        const double margins = std::ceil(2 * kReach * pair.pixels_per_degree);
        const auto side = [&](uint32_t length) {
            return uint32_t(fast_length(length + size_t(std::min(margins, double(length))), coarsest));
        };
        whole_ = {side(pair.width), side(pair.height), 1};
        if (whole_.size() > 2 * scaled_limit(kMostChannelPixels))
            throw Error("pictures of " + std::to_string(pair.width) + " x " + std::to_string(pair.height) +
                        " pixels that cover so small an angle cannot be compared: make them smaller");
    }

    void visit(const std::function<void(const Channel&)>& visit) {
        const Complexes first = jnd_spectrum(pair_.first), second = jnd_spectrum(pair_.second);
        grid_ = grid_of(octaves_ - 1);
        const double lowest = centre(octaves_);
        const Radial low = [&](double u) { return u <= lowest ? 1 : octave_share(std::log2(u / lowest)); };
        first_ = adaptation(first, low), second_ = adaptation(second, low);
        // Of both pictures: weights that differ would make a difference of equal luminances.
        const Adaptation both = common();
        const Weights alike = weights(low, lowest, both);
        show(first, second, {Channel::Band::Below, lowest, -1}, {&both, alike}, {&both, alike}, visit);
        for (size_t octave = octaves_; octave-- > 0;) {
            refine(grid_of(octave));
            const Radial share = [&](double u) { return octave_share(std::log2(u / centre(octave))); };
            const Seen one{&first_, weights(share, centre(octave), first_)},
                other{&second_, weights(share, centre(octave), second_)};
            for (int o = 0; o < kOrientations; ++o)
                show(first, second, {Channel::Band::Octave, centre(octave), o}, one, other, visit);
        }
        const Radial high = [&](double u) { return u >= highest_ ? 1 : octave_share(std::log2(u / highest_)); };
        const double middle = highest_ / std::sqrt(2);  // of what pixels hold of it: from half of it on
        show(first, second, {Channel::Band::Above, highest_, -1}, {&first_, weights(high, middle, first_)},
             {&second_, weights(high, middle, second_)}, visit);
    }

private:
    using Radial = std::function<double(double)>;  // share of a frequency, of its amplitude
    struct Filter {
        Channel::Band band;
        double frequency;  // at its middle
        int orientation;   // -1: all
    };
    // Of a picture: frequencies are weighted at the luminance of its mean JND, and each place then at its own.
    struct Adaptation {
        double mean = 0;                 // cd/m^2
        std::vector<double> logarithms;  // log10 cd/m^2, at the samples of grid_
    };
    struct Weights {
        std::vector<double> gains;    // by frequency, 0 to the largest of grid_ in kGains steps
        std::vector<double> factors;  // by the logarithm of the luminance of adaptation, in kAdaptations steps
    };
    // By an eye in this state.
    struct Seen {
        const Adaptation* adaptation;
        Weights weights;
    };

    double centre(size_t octave) const { return highest_ / double(size_t{2} << octave); }
    ChannelGrid grid_of(size_t octave) const {
        return {whole_.width >> octave, whole_.height >> octave, uint32_t{1} << octave};
    }

    Complexes jnd_spectrum(std::span<const float> luminance) const {
        Complexes rows(whole_.size());
        in_parallel(whole_.height, 8, [&](size_t begin, size_t end) {
            for (size_t y = begin; y < end; ++y)
                for (size_t x = 0; x < whole_.width; ++x) {
                    const size_t from = source_of(y, pair_.height, whole_.height) * pair_.width +
                                        source_of(x, pair_.width, whole_.width);
                    const double l = double(luminance[from]);
                    rows[y * whole_.width + x] = scale_.jnd(std::isfinite(l) ? l : 0);
                }
        });
        return spectrum_of(rows, whole_.width, whole_.height);
    }

    double largest_frequency() const { return std::sqrt(2.0) * highest_ / grid_.step; }
    std::vector<double> gains(const Radial& radial) const {
        const double scale = 1.0 / (double(grid_.step) * grid_.step);
        std::vector<double> made(kGains + 2);
        in_parallel(made.size(), 256, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) made[i] = scale * radial(largest_frequency() * double(i) / kGains);
        });
        return made;
    }

    // What a filter passes, at the samples of grid_, whose frequencies hold it.
    Complexes filtered(const Complexes& spectrum, int orientation, const std::vector<double>& gains) const {
        const ChannelGrid grid = grid_;
        const double most = largest_frequency();
        const double turn = kPi * orientation / kOrientations, cosine = std::cos(turn), sine = std::sin(turn);
        Complexes part(grid.size());
        in_parallel(grid.width, 16, [&](size_t begin, size_t end) {
            for (size_t x = begin; x < end; ++x) {
                const bool right = 2 * x < grid.width;
                const double u = (double(x) - (right ? 0 : grid.width)) / whole_.width;
                const size_t column = right ? x : whole_.width - grid.width + x;
                for (size_t y = 0; y < grid.height; ++y) {
                    const bool lower = 2 * y < grid.height;
                    const double v = (double(y) - (lower ? 0 : grid.height)) / whole_.height;
                    const double r = std::sqrt(u * u + v * v), place = r * 2 * highest_ / most * kGains;
                    const size_t i = std::min(size_t(place), kGains);
                    double gain = std::lerp(gains[i], gains[i + 1], place - double(i));
                    if (orientation >= 0) gain *= oriented(r > 0 ? (u * cosine + v * sine) / r : 0);
                    const size_t row = lower ? y : whole_.height - grid.height + y;
                    part[x * grid.height + y] = gain * spectrum[column * whole_.height + row];
                }
            }
        });
        return vision::picture_of(part, grid.width, grid.height);
    }

    // Of the cosine of the angle to a channel's orientation: squares of four sum to 1 over both half planes, of which
    // one is left out and the other doubled, so that a response is a pair of a quadrature.
    static double oriented(double cosine) {
        const double kWhole = std::sqrt(5.0 / 4);  // the sum of cos^6 over four orientations
        return cosine > 0 ? 2 * cosine * cosine * cosine / kWhole : 0;
    }

    Adaptation adaptation(const Complexes& spectrum, const Radial& low) const {
        Adaptation made{scale_.luminance(spectrum[0].real() / double(whole_.size())), {}};
        for (const Complex& jnd : filtered(spectrum, -1, gains(low)))
            made.logarithms.push_back(std::log10(scale_.luminance(jnd.real())));
        return made;
    }

    // Sensitivity at a frequency over the peak's: 1 of a grating at the peak. It falls to nothing for luminance that is
    // the same everywhere; differences of whole pictures count as half a wave across the field.
    double relative(double frequency, double luminance) const {
        const double longest = 1 / (2 * scale_.eye().field);
        return contrast_sensitivity(std::max(frequency, longest), luminance, scale_.eye()) / scale_.peak(luminance);
    }

    void refine(const ChannelGrid& grid) {
        for (; grid_.step > grid.step; grid_ = {2 * grid_.width, 2 * grid_.height, grid_.step / 2})
            for (Adaptation* const one : {&first_, &second_}) one->logarithms = at_half_step(one->logarithms, grid_);
    }

    static double log_least() { return std::log10(JndScale::kLeast); }
    static double log_range() { return std::log10(JndScale::kMost) - log_least(); }

    // Frequencies are weighted at one luminance; factors lead from there to that of each place.
    Weights weights(const Radial& share, double frequency, const Adaptation& adaptation) const {
        Weights made{gains([&](double u) { return share(u) * relative(u, adaptation.mean); }), {}};
        const double here = relative(frequency, adaptation.mean);  // 0 of waves that no optics pass
        for (int i = 0; i < kAdaptations + 1; ++i) {
            const double there = relative(frequency, std::pow(10, log_least() + log_range() * i / (kAdaptations - 1)));
            made.factors.push_back(here > 0 ? there / here : 0);
        }
        return made;
    }

    Complexes response(const Complexes& spectrum, const Filter& filter, const Seen& by) const {
        Complexes made = filtered(spectrum, filter.orientation, by.weights.gains);
        const std::vector<double>&factors = by.weights.factors, &logarithms = by.adaptation->logarithms;
        const double least = log_least(), range = log_range();
        in_parallel(made.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
            for (size_t at = begin; at < end; ++at) {
                const double place = (logarithms[at] - least) / range * (kAdaptations - 1);
                const size_t i = size_t(std::clamp(place, 0.0, double(kAdaptations - 1)));
                made[at] *= std::lerp(factors[i], factors[i + 1], place - double(i));
            }
        });
        return made;
    }

    Adaptation common() const {
        Adaptation both{std::sqrt(first_.mean * second_.mean), first_.logarithms};
        for (size_t i = 0; i < grid_.size(); ++i) both.logarithms[i] = (both.logarithms[i] + second_.logarithms[i]) / 2;
        return both;
    }

    void show(const Complexes& first, const Complexes& second, const Filter& filter, const Seen& one, const Seen& other,
              const std::function<void(const Channel&)>& visit) const {
        const Complexes a = response(first, filter, one), b = response(second, filter, other);
        visit({filter.band, filter.frequency, grid_, a, b});
    }

    const PicturePair& pair_;
    const JndScale& scale_;
    double highest_;  // cycles/degree that pixels can hold
    size_t octaves_;
    ChannelGrid whole_, grid_;  // of all pixels; of the channel
    Adaptation first_, second_;
};

}  // namespace

void visit_channels(const PicturePair& pair, const JndScale& scale, const std::function<void(const Channel&)>& visit) {
    const uint64_t pixels = uint64_t{pair.width} * pair.height;
    if (pixels == 0) throw Error("pictures without pixels cannot be compared");
    if (pixels > scaled_limit(kMostChannelPixels))
        throw Error("pictures of more than " + std::to_string(scaled_limit(kMostChannelPixels)) +
                    " pixels cannot be compared");
    if (pair.first.size() != pixels || pair.second.size() != pixels) throw Error("the two pictures differ in size");
    if (!(pair.pixels_per_degree > 0) || !std::isfinite(pair.pixels_per_degree))
        throw Error("pictures that are compared need the angle that they cover");
    Pyramid(pair, scale).visit(visit);
}

std::vector<double> at_half_step(std::span<const double> values, const ChannelGrid& grid) {
    const size_t w = grid.width, h = grid.height;
    std::vector<double> fine(4 * w * h);
    in_parallel(h, 8, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            for (size_t x = 0; x < w; ++x) {
                const size_t right = (x + 1) % w, below = (y + 1) % h;
                const double a = values[y * w + x], b = values[y * w + right], c = values[below * w + x],
                             d = values[below * w + right];
                double* const to = &fine[4 * y * w + 2 * x];
                to[0] = a, to[1] = (a + b) / 2, to[2 * w] = (a + c) / 2, to[2 * w + 1] = (a + b + c + d) / 4;
            }
    });
    return fine;
}

std::vector<double>& ChannelSum::at(const ChannelGrid& grid) {
    if (values_.empty()) grid_ = grid, values_.assign(grid.size(), 0);
    for (; grid_.step > grid.step; grid_ = {2 * grid_.width, 2 * grid_.height, grid_.step / 2})
        values_ = at_half_step(values_, grid_);
    return values_;
}

std::vector<double> ChannelSum::pixels(uint32_t width, uint32_t height) {
    std::vector<double> cut;
    cut.reserve(size_t{width} * height);
    for (size_t y = 0; y < height; ++y)
        cut.insert(cut.end(), values_.begin() + ptrdiff_t(y * grid_.width),
                   values_.begin() + ptrdiff_t(y * grid_.width + width));
    return cut;
}

double power_of_contrast(double contrast) {
    const double c = std::abs(contrast);
    return c * c * c * std::sqrt(c);  // 3.5
}

double detection_probability(double powers) { return -std::expm1(-std::log(2.0) * powers); }

}  // namespace vesper::analysis
