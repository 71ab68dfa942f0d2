// Lanes as lines that are driven along. SPDX-License-Identifier: MIT
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
    /// Where a point is beside a lane.
    struct Beside {
        double s = 0;       ///< along the lane, m; before its start negative, beyond its end more than its length
        double offset = 0;  ///< to the left, m
        double distance = 0;  ///< in plan, m
    };

    /// A closed lane goes on from its last point to its first. Throws Error.
    Course(std::string name, std::vector<glm::dvec3> points, double width, double speed, bool closed = false);
    /// `limits`: the speed allowed from each point to the next, m/s.
    Course(std::string name, std::vector<glm::dvec3> points, double width, const std::vector<double>& limits, bool closed = false);

    const std::string& name() const { return name_; }
    double width() const { return width_; }  ///< m
    double speed() const { return speed_; }  ///< allowed at its start, m/s
    bool closed() const { return closed_; }
    double length() const { return starts_.back(); }  ///< m
    /// Straight on before the start and beyond the end. Between the points the direction turns evenly.
    Place at(double s) const;
    Beside beside(glm::dvec2 point) const;
    /// How far ahead `to` is of `from`, m; on a closed lane at most once round, otherwise negative where it is behind.
    double ahead(double from, double to) const;
    /// The speed to have at a place, m/s: what is allowed, slower where the curve there takes more than kCurve across, and before
    /// either early enough to brake with kEase.
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

/// m/s^2 of a car at `s` of a lane that wants `speed_factor` times the speed to have there: idm_acceleration, and where that speed falls
/// ahead, no more than keeps to it. (Of a wanted speed that falls the model alone falls short: it brakes with kEase where it is a
/// quarter too fast.)
double follow_lane(const Course& lane, CarFollowing following, double s, double speed_factor, double speed, double gap, double closing);

}  // namespace vesper::traffic
