// A road as it is calculated and as it is rendered. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "gpu_scene/view.h"
#include "roads/road_lighting.h"
#include "vision/glare_report.h"

namespace vesper::commands {

/// What was read off pictures at the points of the grid, beside the calculation.
struct RoadReading {
    std::vector<double> luminance;  ///< at each point, cd/m^2
    double average_luminance = 0, overall_uniformity = 0, longitudinal_uniformity = 0;
    /// (picture - calculation) / calculation, %: of the average, of all points (root of the mean square), and the
    /// largest.
    double average_difference = 0, mean_difference = 0, largest_difference = 0;
    size_t largest_at = 0;  ///< index into RoadLighting::points
};

/// What an observer sees in the picture.
struct RenderedObserver {
    gpu_scene::View view;
    std::vector<float> rgba;  ///< cd/m^2 RGB, by every luminaire of the scene
    /// The standard leaves out luminaires more than 5H before, 12H beyond or 5H beside a point, and those outside of
    /// the r-table; so each point is read off a picture of its own (road_point_view) with the luminaires that count for
    /// it. And off the picture above, for what that leaves out.
    RoadReading counted, every;
    double longest_pixel = 0;  ///< m of road in a pixel, at the far end of the field
    /// Off a picture of the new luminaires from LaneObserver::glare_eye, those outside of it added.
    vision::GlareReport glare;
};

struct RenderedRoad {
    std::string device;
    std::vector<RenderedObserver> observers;
    gpu_scene::View overview;  ///< as the observer of the darkest lane sees the road
    std::vector<float> overview_rgba;
    size_t darkest = 0;  ///< which observer that is
};

/// Renders the scene of the road for every observer on a device and reads the grid off the pictures. Throws Error.
RenderedRoad render_road(const roads::LoadedLayout&, const roads::RoadLighting&, const std::string& device);

/// Calculation and picture side by side.
std::string text_of(const roads::RoadLighting&, const RenderedRoad&);
/// Writes false colours (.png) or the luminances of each observer (.exr, with the lane in the name where there are
/// several).
void write_picture(const std::string& file, const roads::LoadedLayout&, const roads::RoadLighting&,
                   const RenderedRoad&);

}  // namespace vesper::commands
