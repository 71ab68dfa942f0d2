#include "traffic/vehicle.h"

#include <algorithm>
#include <cmath>

namespace vesper::traffic {
namespace {

constexpr double kGravity = 9.80665;                // m/s^2
constexpr double kRollsBelow = 3, kSlipsAbove = 5;  // m/s
constexpr int kSubsteps = 4;                        // tyres of a slow car are stiff: 70 /s at 3 m/s

// Pacejka's magic formula of one axle, of which the longitudinal force takes its part of the friction circle.
double lateral_force(const VehicleParameters& p, double stiffness, double load, double slip, double longitudinal) {
    const double most = p.friction * load;
    const double left = std::sqrt(std::max(0.0, 1 - longitudinal * longitudinal / (most * most)));
    const double b = stiffness / (p.tyre_shape * most);
    return left * most * std::sin(p.tyre_shape * std::atan(b * slip));
}

struct Forces {
    double front, rear;  // along the wheels, N
    double resistance;   // air and rolling, against the motion, N
    double engine;       // asked of the engine, N
    bool held;           // brakes are stronger than the engine
};

Forces longitudinal_forces(const VehicleState& s, const VehicleParameters& p, const VehicleControls& c,
                           double front_load, double rear_load) {
    const double weight = p.mass * kGravity, v = std::abs(s.speed);
    const double throttle = std::clamp(c.throttle, -1.0, 1.0);
    const double engine = throttle * std::min(p.drive_force, v > 0 ? p.power / v : p.drive_force);
    const double pedal = std::clamp(c.brake, 0.0, 1.0) * p.mass * p.brake_deceleration;
    // At rest brakes work against the engine, and as much as they have to.
    const double moves = s.speed != 0 ? s.speed : engine, against = moves > 0 ? -1 : moves < 0 ? 1 : 0;
    const auto grip = [&](double force, double load) {
        return std::clamp(force, -p.friction * load, p.friction * load);
    };
    Forces f{};
    f.front = grip(engine + against * pedal * front_load / weight, front_load);
    f.rear = grip(against * pedal * rear_load / weight, rear_load);
    f.resistance = p.rolling * weight + 0.5 * p.air_density * p.drag_area * v * v;
    f.engine = engine;
    f.held = pedal > 0 && pedal >= std::abs(engine);
    return f;
}

void substep(VehicleState& s, const VehicleParameters& p, const VehicleControls& c, double dt) {
    const double base = p.wheelbase(), weight = p.mass * kGravity;
    const double front_load = weight * p.rear_axle / base, rear_load = weight * p.front_axle / base;
    const double wanted = std::clamp(c.angle, -p.largest_angle, p.largest_angle);
    s.angle += std::clamp(wanted - s.angle, -p.steering_rate * dt, p.steering_rate * dt);

    const Forces f = longitudinal_forces(s, p, c, front_load, rear_load);
    const double before = kinetic_energy(s, p), was = s.speed;
    const double slipping = std::clamp((s.speed - kRollsBelow) / (kSlipsAbove - kRollsBelow), 0.0, 1.0);
    const double cosine = std::cos(s.angle), sine = std::sin(s.angle);
    double front = 0, rear = 0;
    if (slipping > 0) {
        front = lateral_force(p, p.front_stiffness, front_load,
                              s.angle - std::atan2(s.lateral + p.front_axle * s.yaw_rate, s.speed), f.front);
        rear = lateral_force(p, p.rear_stiffness, rear_load, -std::atan2(s.lateral - p.rear_axle * s.yaw_rate, s.speed),
                             f.rear);
    }
    const double driven =
        (f.front * cosine + f.rear) / p.mass + slipping * (s.lateral * s.yaw_rate - front * sine / p.mass);
    double speed = s.speed + driven * dt;
    // Brakes and resistances bring a car to rest, and keep it there against less force than they have.
    const double drop = f.resistance / p.mass * dt;
    if (f.held && (was == 0 || speed * was < 0)) speed = 0;
    speed = std::abs(speed) <= drop ? 0 : speed - std::copysign(drop, speed);

    const double lateral = s.lateral + ((front * cosine + f.front * sine + rear) / p.mass - s.speed * s.yaw_rate) * dt;
    const double yaw_rate =
        s.yaw_rate + (p.front_axle * (front * cosine + f.front * sine) - p.rear_axle * rear) / p.yaw_inertia * dt;
    const double turn = speed * std::tan(s.angle) / base;
    s.speed = speed;
    s.lateral = slipping * lateral + (1 - slipping) * p.rear_axle * turn;
    s.yaw_rate = slipping * yaw_rate + (1 - slipping) * turn;

    // Forces across rolling wheels do no work: what a turn takes, the motion ahead gives.
    const double after = kinetic_energy(s, p), allowed = before + std::max(0.0, f.engine * (was + speed) / 2 * dt);
    if (after > allowed) {
        const double scale = std::sqrt(allowed / after);
        s.speed *= scale, s.lateral *= scale, s.yaw_rate *= scale;
    }
    s.acceleration = (s.speed - was) / dt;

    const double middle = s.yaw + s.yaw_rate * dt / 2;
    const glm::dvec2 ahead(-std::sin(middle), -std::cos(middle)), across(-std::cos(middle), std::sin(middle));
    const glm::dvec2 moved = (s.speed * ahead + s.lateral * across) * dt;
    s.position += moved;
    s.odometer += glm::length(moved);
    s.yaw += s.yaw_rate * dt;

    const double follow = 1 - std::exp(-dt / p.body_seconds);
    s.pitch += follow * (p.pitch_gradient * s.acceleration / kGravity - s.pitch);
    s.roll += follow * (p.roll_gradient * s.speed * s.yaw_rate / kGravity - s.roll);
}

}  // namespace

glm::dvec2 VehicleState::forward() const { return {-std::sin(yaw), -std::cos(yaw)}; }
glm::dvec2 VehicleState::left() const { return {-std::cos(yaw), std::sin(yaw)}; }

double kinetic_energy(const VehicleState& s, const VehicleParameters& p) {
    return 0.5 * p.mass * (s.speed * s.speed + s.lateral * s.lateral) + 0.5 * p.yaw_inertia * s.yaw_rate * s.yaw_rate;
}

void advance(VehicleState& s, const VehicleParameters& p, const VehicleControls& c, double seconds) {
    for (int i = 0; i < kSubsteps; ++i) substep(s, p, c, seconds / kSubsteps);
}

double understeer_gradient(const VehicleParameters& p) {
    return p.mass / p.wheelbase() * (p.rear_axle / p.front_stiffness - p.front_axle / p.rear_stiffness);
}

double steady_yaw_gain(const VehicleParameters& p, double speed) {
    return speed / (p.wheelbase() + understeer_gradient(p) * speed * speed);
}

}  // namespace vesper::traffic
