// Looking at the grid of a road-lighting calculation from its observers. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "gpu_scene/view.h"
#include "roads/road_layout.h"

namespace vesper::commands {

/// A view of exactly the field of a layout, with half a step of the grid around it, from an observer who looks along
/// the road. The road is seen at 1.4 degrees and less, so a pixel is made much flatter than wide: it covers at most 5
/// cm of the road at the far end of the field, unless that takes more than `max_rows`.
gpu_scene::View road_view(const roads::RoadLayout& layout, const roads::LaneObserver& observer,
                          uint32_t max_rows = 4096);

/// A view of 8 x 8 pixels about a point of the road, which lies between the four in the middle, from an observer who
/// looks along the road. A pixel covers 1 mm of it, in length and width.
gpu_scene::View road_point_view(const roads::LaneObserver& observer, glm::dvec2 point);

/// A view of square pixels, `width` of them, from 40 m ahead of an observer to the horizon.
gpu_scene::View road_overview(const roads::RoadLayout& layout, const roads::LaneObserver& observer, uint32_t width);

/// A view of what may dazzle an eye at `eye` (in the frame of the layout) that looks along the road and 1 degree down,
/// 50 degrees to both sides and up to the roof of the car, 20 degrees above the horizon.
gpu_scene::View road_glare_view(glm::dvec3 eye);

/// Where a point of the frame of the layout is seen, px from the upper left corner; centres of pixels are at halves.
glm::dvec2 project(const gpu_scene::View& view, glm::dvec3 road_point);

/// Length of the road that a pixel covers at a point of the field, m.
double depth_of_pixel(const gpu_scene::View& view, const roads::LaneObserver& observer, double x);

/// Luminance at a place of an image (RGBA, cd/m^2 RGB), bilinear between the centres of pixels. A pixel holds the
/// luminance at its centre, not a mean, so that between them only the curvature over a pixel is lost. Not a number
/// where a neighbour is outside.
double luminance_at(std::span<const float> rgba, VkExtent2D extent, glm::dvec2 place);

}  // namespace vesper::commands
