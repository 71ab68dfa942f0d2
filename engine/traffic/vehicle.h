// A car as a bicycle: two axles, tyres that slip and saturate. SPDX-License-Identifier: MIT
// The ground plane is that of the scene (Y up). Yaw 0 looks along -Z and grows to the left, seen from above; lateral
// velocity, yaw rate and steering angle are positive to the left. SI units, rad.
#pragma once

#include <glm/glm.hpp>

namespace vesper::traffic {

/// Rajamani, Vehicle Dynamics and Control (2nd ed., 2012), chapters 2 and 4; defaults: the sedan of his chapter 3.
struct VehicleParameters {
    double mass = 1573;                                        ///< kg
    double yaw_inertia = 2873;                                 ///< kg m^2
    double front_axle = 1.10, rear_axle = 1.58;                ///< from the centre of mass, m
    double front_stiffness = 160000, rear_stiffness = 160000;  ///< of both tyres of an axle at small slip, N/rad
    double friction = 0.9;                                     ///< between tyre and dry road
    double tyre_shape = 1.3;                   ///< C of Pacejka's magic formula for lateral force (Bakker, Nyborg and
                                               ///< Pacejka 1987)
    double drive_force = 5000, power = 85000;  ///< of the engine at the front wheels, at most: N, W
    double brake_deceleration = 8;             ///< with the pedal pressed down, m/s^2; tyres may give less
    double rolling = 0.012;                    ///< resistance over weight (Rajamani, 4.1.3: 0.01 to 0.015)
    double drag_area = 0.66;                   ///< C_d A, m^2: C_d 0.30
    double air_density = 1.225;                ///< kg/m^3
    double largest_angle = 0.6;                ///< of the front wheels, rad
    double steering_rate = 0.7;                ///< of the front wheels, rad/s
    double length = 4.4, width = 1.8;          ///< of the body, m
    double pitch_gradient = 0.044, roll_gradient = 0.087;  ///< of the body, rad per g: 2.5 and 5 deg (Gillespie 1992: 3
                                                           ///< to 7 in roll)
    double body_seconds = 0.15;                            ///< time constant of the body, s

    double wheelbase() const { return front_axle + rear_axle; }
};

struct VehicleState {
    glm::dvec2 position{0};  ///< of the centre of mass: X and Z of the scene, m
    double yaw = 0;
    double speed = 0;    ///< along the body, m/s; negative backwards
    double lateral = 0;  ///< velocity to the left, m/s
    double yaw_rate = 0;
    double angle = 0;            ///< of the front wheels
    double acceleration = 0;     ///< of the last step, along the body, m/s^2
    double pitch = 0, roll = 0;  ///< of the body: nose up, left side up
    double odometer = 0;         ///< m

    glm::dvec2 forward() const;
    glm::dvec2 left() const;
    glm::dvec2 velocity() const { return speed * forward() + lateral * left(); }
};

/// Demands of pedals and wheel.
struct VehicleControls {
    double angle = 0;     ///< desired angle of the front wheels, rad
    double throttle = 0;  ///< -1 .. 1, of the engine's force; negative backwards
    double brake = 0;     ///< 0 .. 1
};

/// Advances a vehicle by one step. Below 3 m/s wheels roll without slip (slip angles have no meaning there), above 5
/// m/s tyres slip; between, both are mixed (Kabzan et al. 2019, AMZ Driverless). Only the engine adds energy.
void advance(VehicleState&, const VehicleParameters&, const VehicleControls&, double seconds);

/// Kinetic energy of motion in the plane, J.
double kinetic_energy(const VehicleState&, const VehicleParameters&);

/// Yaw rate over steering angle in a steady turn of little lateral acceleration, 1/s (Rajamani, 3.3), and the
/// understeer gradient K in rad s^2/m it follows from: v / (L + K v^2).
double steady_yaw_gain(const VehicleParameters&, double speed);
double understeer_gradient(const VehicleParameters&);

}  // namespace vesper::traffic
