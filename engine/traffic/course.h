// Lanes as lines. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "traffic/car_following.h"

namespace vesper::traffic {

/// The middle of a lane in the direction of traffic.
class Course {
public:
    /// A place on a lane.
    struct Place {
        glm::dvec3 position{0};  ///< scene, m
        double yaw = 0;          ///< as VehicleState
        double slope = 0;        ///< rad, up
    };
    /// A point relative to a lane.
    struct Beside {
        double s = 0;         ///< along the lane, m; before its start negative, beyond its end more than its length
        double offset = 0;    ///< to the left, m
        double distance = 0;  ///< in plan, m
    };

    /// A closed lane continues from its last point to its first. `width` m, `speed` m/s. Throws Error.
    Course(std::string name, std::vector<glm::dvec3> points, double width, double speed, bool closed = false);
    /// `limits`: the speed allowed from each point to the next, m/s.
    Course(std::string name, std::vector<glm::dvec3> points, double width, const std::vector<double>& limits,
           bool closed = false);

    const std::string& name() const { return name_; }
    double width() const { return width_; }  ///< m
    double speed() const { return speed_; }  ///< allowed at its start, m/s
    bool closed() const { return closed_; }
    double length() const { return starts_.back(); }  ///< m
    /// The place at `s`; straight on before the start and beyond the end. The direction turns evenly between points.
    Place at(double s) const;
    Beside beside(glm::dvec2 point) const;
    /// Distance from `from` ahead to `to`, m; at most one round of a closed lane, negative on an open lane if `to` is
    /// behind.
    double ahead(double from, double to) const;
    /// Desired speed at a place, m/s: the limit, or less in curves of more than kCurve across, and before both so as to
    /// brake with kEase.
    double speed_at(double s) const;
    static constexpr double kCurve = 2, kEase = 1.5;  ///< m/s^2, comfortable

    int left = -1, right = -1;  ///< neighbours of the same direction, as indices; -1: none

private:
    std::string name_;
    std::vector<glm::dvec3> points_;
    std::vector<double> starts_;  // of each point, m in plan
    std::vector<double> yaws_;    // at each point, continuous
    std::vector<double> speeds_;  // at each point
    double width_, speed_;
    bool closed_;
    size_t next_point(double s) const;
    double wrapped(double s) const;
};

/// Acceleration, m/s^2, of a car at `s` of a lane that desires `speed_factor` times speed_at(): idm_acceleration,
/// limited where that speed falls ahead (there the model alone brakes with kEase only when a quarter too fast).
double follow_lane(const Course& lane, CarFollowing following, double s, double speed_factor, double speed, double gap,
                   double closing);

}  // namespace vesper::traffic
