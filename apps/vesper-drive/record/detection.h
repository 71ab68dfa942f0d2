// From which distance obstacles of a drive are seen. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "plots/line_plot.h"
#include "render/seen_obstacles.h"

namespace vesper::drive {

/// A visibility level of at least this says that a driver sees an obstacle (Adrian 1989: 7 and more), unless
/// --visible-from says otherwise.
constexpr double kVisibleFrom = 7;

/// Whether an obstacle that is measured is seen, brighter or darker than what is around it; nothing where its level is
/// not known.
std::optional<bool> is_visible(const render::SeenObstacle&, double age, double visible_from);

/// Gathers the frames of a drive.
class Detections {
public:
    Detections(const std::vector<scene::Obstacle>&, double visible_from);

    /// Obstacles of the next frame, in their order; of none where nothing was measured. `glare`: light was scattered in
    /// the eye, so that levels with it are known.
    void add(std::span<const render::SeenObstacle>, double age, bool glare);

    /// A line for each under a heading: the distance in the first frame in which it was seen, with glare and without,
    /// and the least at which it was measured, m. A + stands where that was the first frame of the drive. Says so if no
    /// frame had glare.
    std::string table() const;
    /// Levels over distance, of the kMostDrawn that come nearest.
    static constexpr size_t kMostDrawn = 8;
    apps::LinePlot plot() const;

private:
    struct Moment {
        double distance;                      // m
        std::optional<double> with, without;  // levels, not negative
    };
    struct Track {
        std::string name;
        std::vector<Moment> moments;  // of each frame
        double nearest() const;       // m, at which it was measured; infinite: never
    };
    std::string first_of(const Track&, std::optional<double> Moment::*level) const;

    std::vector<Track> tracks_;
    double visible_from_;
    bool glare_ = false;  // in a frame
};

}  // namespace vesper::drive
