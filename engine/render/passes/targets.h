// Luminances of targets and of what surrounds them. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "render/frame_context.h"
#include "shared/targets.h"

namespace vesper::render {

/// What targets are measured in: images of full size, and one of a single texel.
struct TargetImages {
    graph::Resource triangle;       ///< of the G-buffer
    graph::Resource scene, retina;  ///< rgba32f, cd/m^2; they may be the same
    graph::Resource whole;          ///< the last level of the pyramid of the retina
};

struct TargetPixels {
    std::vector<uint32_t> of_instances;     ///< 1 + number of the target of each instance of the G-buffer; 0: of none
    std::vector<shared::TargetRect> rects;  ///< of each target, within the picture; may be empty
};

/// Where an object of some rectangle of pixels (low, high; y down) is looked for: with its surroundings, a frame of
/// half the rectangle's shorter side, at least kLeastFrame px. Empty if none of the rectangle is in the picture.
constexpr double kLeastFrame = 2;
shared::TargetRect target_rect(glm::dvec2 low, glm::dvec2 high, VkExtent2D picture);

/// shared::TargetSums of each target, a buffer. Surroundings are the pixels of its rectangle that belong to no target.
/// Luminances of glare sources do not count, nor those that are not finite. A glare source is brighter than
/// shared::kLeastSourceLuminance, and than shared::kGlareContrast times the log average of the picture, or its mean
/// where that is less. The same from run to run. Without targets there is no pass. Throws Error for more than
/// shared::kMostTargets.
graph::Resource add_targets(const FrameContext& frame, const TargetImages& images, const TargetPixels& targets);

}  // namespace vesper::render
