// Lanes as lines that are driven along. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace vesper {

/// The middle of a lane in the direction of traffic.
class Lane {
public:
    /// A place on a lane.
    struct Place {
        glm::dvec3 position{0};  ///< scene, m
        double yaw = 0;          ///< as VehicleState
        double slope = 0;        ///< rad, up
    };
    /// Where a point is beside a lane.
    struct Beside {
        double s = 0;       ///< along the lane, m; before its start negative, beyond its end more than its length
        double offset = 0;  ///< to the left, m
        double distance = 0;  ///< in plan, m
    };

    Lane(std::string name, std::vector<glm::dvec3> points, double width, double speed);

    const std::string& name() const { return name_; }
    double width() const { return width_; }  ///< m
    double speed() const { return speed_; }  ///< allowed, m/s
    double length() const { return starts_.back(); }  ///< m
    /// Straight on before the start and beyond the end. Between the points the direction turns evenly.
    Place at(double s) const;
    Beside beside(glm::dvec2 point) const;

    int left = -1, right = -1;  ///< neighbours of the same direction, as indices; -1: none

private:
    std::string name_;
    std::vector<glm::dvec3> points_;
    std::vector<double> starts_;  // of each point, m in plan
    std::vector<double> yaws_;    // at each point, continuous
    double width_, speed_;
};

}  // namespace vesper
