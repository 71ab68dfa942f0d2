// The mean of several samples of every pixel. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "render/frame_context.h"

namespace vesper::render {

constexpr uint32_t kMostSamples = 65536;  ///< of a pixel

/// Where `count` samples of a pixel lie, px from its middle, in (-0.5, 0.5): a Hammersley set (Niederreiter 1992,
/// theorem 3.8), moved to be even about the middle. Where the count is a power of two every rectangle of an area of
/// 1 / count whose sides are powers of two has one of them. One sample lies in the middle.
std::vector<glm::dvec2> sample_places(uint32_t count);

/// Sums that outlive their frame, 16 bytes a pixel each.
struct SampleSums {
    graph::Resource sums;   ///< cd/m^2
    graph::Resource rests;  ///< what rounding took from them
};

/// Adds a frame's luminance to the sums; the first replaces them.
void add_sample(const FrameContext& frame, graph::Resource scene, const SampleSums& sums, bool first);

/// The mean of `samples` that were added, cd/m^2: within 1e-7 of the exact mean of theirs. What is not finite in one
/// sample is not finite in the mean.
graph::Resource add_mean_of_samples(const FrameContext& frame, const SampleSums& sums, uint32_t samples);

}  // namespace vesper::render
