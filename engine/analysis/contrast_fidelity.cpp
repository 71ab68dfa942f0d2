#include "analysis/contrast_fidelity.h"

#include <numeric>

#include "base/parallel.h"

namespace vesper::analysis {
namespace {

// Squares of the contrasts of one octave, at its samples: of a grating, squares of its orientations sum to its own.
struct Octave {
    double frequency = 0;
    ChannelGrid grid;
    std::vector<double> scene, shown;
};

// Counts octaves.
struct Counts {
    double octaves = 0;
    ChannelSum seen, lost, invented, amplified;
};

void judge(const Octave& octave, Counts& counts) {
    std::vector<double>&seen = counts.seen.at(octave.grid), &lost = counts.lost.at(octave.grid),
    &invented = counts.invented.at(octave.grid), &amplified = counts.amplified.at(octave.grid);
    constexpr double kSeenSquare = kSeen * kSeen, kRatio = kAmplified * kAmplified;
    in_parallel(seen.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const double scene = octave.scene[i], shown = octave.shown[i];
            const bool in_scene = scene >= kSeenSquare;
            seen[i] += in_scene;
            lost[i] += in_scene && shown < 1;
            invented[i] += shown >= kSeenSquare && scene < 1;
            amplified[i] += in_scene && shown >= kRatio * scene;
        }
    });
    ++counts.octaves;
}

}  // namespace

ContrastFidelity contrast_fidelity(const PicturePair& pair, const ContrastEye& eye) {
    Octave octave;
    Counts counts;
    visit_channels(pair, JndScale(eye), [&](const Channel& channel) {
        if (channel.band != Channel::Band::Octave) return;
        if (channel.frequency != octave.frequency) {
            if (octave.frequency > 0) judge(octave, counts);
            octave = {channel.frequency, channel.grid, std::vector<double>(channel.grid.size()),
                      std::vector<double>(channel.grid.size())};
        }
        in_parallel(channel.grid.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                octave.scene[i] += std::norm(channel.first[i]);
                octave.shown[i] += std::norm(channel.second[i]);
            }
        });
    });
    judge(octave, counts);
    const auto shares = [&](ChannelSum& sum) {
        std::vector<float> of_all;
        for (const double count : sum.pixels(pair.width, pair.height)) of_all.push_back(float(count / counts.octaves));
        return of_all;
    };
    return {shares(counts.seen), shares(counts.lost), shares(counts.invented), shares(counts.amplified)};
}

double mean_of(const std::vector<float>& shares) {
    return std::accumulate(shares.begin(), shares.end(), 0.0) / double(shares.size());
}

}  // namespace vesper::analysis
