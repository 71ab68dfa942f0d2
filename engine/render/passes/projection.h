// What a projector shows of the picture. SPDX-License-Identifier: MIT
#pragma once

#include "eye/projection.h"
#include "render/frame_context.h"
#include "vision/display.h"

namespace vesper::render {

struct ProjectionSettings {
    vision::Display display;
    bool blue_first = false;  ///< as of CompositeSettings
};

/// Display codes of a projector's picture, r32ui as of add_composite, from `light` of add_shown_light: what is shown at
/// the place of each pixel, between the middles of four pixels and beyond the last as that one, times the pixel's
/// factor; the darkest where nothing is drawn. Throws Error if the projection is for a picture of another extent.
graph::Resource add_projection(const FrameContext& frame, graph::Resource light, const eye::Projection& projection,
                               const ProjectionSettings& settings);

}  // namespace vesper::render
