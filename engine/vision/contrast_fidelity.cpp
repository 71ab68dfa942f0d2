#include "vision/contrast_fidelity.h"

#include <numeric>

#include "base/parallel.h"

namespace vesper::vision {
namespace {

// Powers of the contrasts of one octave, at its samples.
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

void judge(const Octave& octave, double pixels_per_degree, Counts& counts) {
    const auto fovea = [&](const std::vector<double>& powers) {
        return foveal_means(powers, octave.grid.width, octave.grid.height, pixels_per_degree / octave.grid.step);
    };
    const std::vector<double> scene = fovea(octave.scene), shown = fovea(octave.shown);
    std::vector<double>&seen = counts.seen.at(octave.grid), &lost = counts.lost.at(octave.grid),
    &invented = counts.invented.at(octave.grid), &amplified = counts.amplified.at(octave.grid);
    const double is_seen = power_of_contrast(kSeen), ratio = power_of_contrast(kAmplified);
    in_parallel(scene.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const bool in_scene = scene[i] >= is_seen;
            seen[i] += in_scene;
            lost[i] += in_scene && shown[i] < 1;
            invented[i] += shown[i] >= is_seen && scene[i] < 1;
            amplified[i] += in_scene && shown[i] >= ratio * scene[i];
        }
    });
    ++counts.octaves;
}

}  // namespace

ContrastFidelity contrast_fidelity(const PicturePair& pair, const ContrastEye& eye) {
    Octave octave;
    Counts counts;
    visit_channels(pair, eye, [&](const Channel& channel) {
        if (channel.base) return;  // luminance, which is not compared
        if (channel.frequency != octave.frequency) {
            if (octave.frequency > 0) judge(octave, pair.pixels_per_degree, counts);
            octave = {channel.frequency, channel.grid, std::vector<double>(channel.grid.size()),
                      std::vector<double>(channel.grid.size())};
        }
        in_parallel(channel.grid.size(), kSamplesAtATime, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                octave.scene[i] += power_of_contrast(channel.first[i]);
                octave.shown[i] += power_of_contrast(channel.second[i]);
            }
        });
    });
    judge(octave, pair.pixels_per_degree, counts);
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

}  // namespace vesper::vision
