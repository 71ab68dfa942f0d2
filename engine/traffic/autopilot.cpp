#include "traffic/autopilot.h"

#include <algorithm>
#include <cmath>

namespace vesper::traffic {

VehicleControls steer_along(const Course& lane, const VehicleState& s, const VehicleParameters& p,
                            const AutopilotSettings& a, double gap, double closing) {
    const glm::dvec2 rear = s.position - p.rear_axle * s.forward();
    const Course::Beside here = lane.beside(rear);
    const double ahead = std::max(a.least_preview, a.preview * std::abs(s.speed));
    const glm::dvec3 aim = lane.at(here.s + ahead).position;
    const glm::dvec2 to = glm::dvec2(aim.x, aim.z) - rear;
    const double distance = std::max(glm::length(to), 1e-3), sideways = glm::dot(to, s.left()) / distance;

    VehicleControls c;
    c.angle = std::atan2(2 * p.wheelbase() * sideways, distance);
    const double wanted = follow_lane(lane, a.following, here.s, 1, s.speed, gap, closing);
    const double drag = p.rolling * p.mass * 9.81 + 0.5 * p.air_density * p.drag_area * s.speed * s.speed;
    const double force = p.mass * wanted + drag,
                 most = std::min(p.drive_force, p.power / std::max(std::abs(s.speed), 1.0));
    if (force > 0)
        c.throttle = std::min(1.0, force / most);
    else
        c.brake = std::min(1.0, -force / (p.mass * p.brake_deceleration));
    if (s.speed < 0.3 && wanted < 0) c.throttle = 0, c.brake = 0.5;  // stands
    return c;
}

}  // namespace vesper::traffic
