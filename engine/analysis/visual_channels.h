// Two pictures in channels of frequency and orientation, in units of the threshold of contrast.
// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "analysis/contrast_sensitivity.h"

namespace vesper::analysis {

/// Two pictures of one size: luminance on the retina, cd/m^2, row by row. Luminances that are not finite, and negative
/// ones, count as 0.
struct PicturePair {
    uint32_t width = 0, height = 0;  ///< px
    double pixels_per_degree = 0;    ///< where the eye looks
    std::span<const float> first, second;
};

/// Samples of a channel: every `step`-th pixel in each direction from the first one on, row by row, beyond the picture
/// as far as its mirrored margin goes.
struct ChannelGrid {
    uint32_t width = 0, height = 0;
    uint32_t step = 1;  ///< px
    size_t size() const { return size_t{width} * height; }
    bool operator==(const ChannelGrid&) const = default;
};

/// The response of one channel to both pictures, in thresholds. Of an octave: its magnitude is 0.89 for a grating of
/// the channel's frequency and orientation that is seen half of the time, and squares of the four orientations sum to
/// 1; its phase is that of the grating. Below the octaves: the scale of JNDs of whole regions, weighted alike in both
/// pictures. Above them: real, without orientation.
struct Channel {
    enum class Band : uint8_t { Below, Octave, Above };
    Band band = Band::Octave;
    double frequency = 0;  ///< at its middle, cycles/degree
    ChannelGrid grid;
    std::span<const std::complex<double>> first, second;
};

/// The most pixels of pictures that are compared, times VESPER_LIMITS. With their margins, which are 2 degrees and at
/// most half the picture on each side, they have at most twice as many, of 160 bytes each.
constexpr uint64_t kMostChannelPixels = uint64_t{1} << 24;

/// Calls `visit` with each channel, from coarse to fine: the frequencies below all octaves, each octave in four
/// orientations, the frequencies above. Luminance goes through the scale of an eye and into a steerable pyramid
/// (Simoncelli and Freeman 1995), whose squared responses sum to that of the picture, and whose oriented responses are
/// pairs of a quadrature (Portilla and Simoncelli 2000). Each response is weighted by the sensitivity at its frequency
/// to the local luminance of adaptation, which is the coarsest channel of each picture. Throws Error for pictures
/// without pixels, of more than kMostChannelPixels, of other sizes than they say or without an angle.
void visit_channels(const PicturePair&, const JndScale&, const std::function<void(const Channel&)>& visit);

/// What a thread takes at a time of loops over samples.
constexpr size_t kSamplesAtATime = 1u << 14;

/// Values at every pixel of half the step, linear between the samples of `grid`.
std::vector<double> at_half_step(std::span<const double> values, const ChannelGrid& grid);

/// Sums of values over the channels, each at its own step, brought to every pixel.
class ChannelSum {
public:
    /// Values to add to, at the samples of this grid, which is as fine as the last one or finer.
    std::vector<double>& at(const ChannelGrid&);
    /// Of the pixels of a picture, row by row.
    std::vector<double> pixels(uint32_t width, uint32_t height);

private:
    ChannelGrid grid_;
    std::vector<double> values_;
};

/// Probability of detection of a contrast in thresholds: 1 - 2^-|c|^kPsychometricSlope (Nachmias 1981); of several
/// independent ones the powers are summed first.
constexpr double kPsychometricSlope = 3.5;
double power_of_contrast(double contrast);    ///< |c|^kPsychometricSlope
double detection_probability(double powers);  ///< of the sum

}  // namespace vesper::analysis
