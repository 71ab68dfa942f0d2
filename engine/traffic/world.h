// The moving objects on a road: the driver's car, traffic, pedestrians. Fixed steps and a seed: every run is the same.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "traffic/autopilot.h"
#include "traffic/barrier.h"
#include "traffic/contact.h"
#include "traffic/course.h"
#include "traffic/driver.h"
#include "traffic/vehicle.h"

namespace vesper::traffic {

/// A car that keeps to lanes.
struct TrafficCar {
    std::string node;  ///< of the scene: its origin on the ground below the middle, front towards -Z
    size_t lane = 0;
    double s = 0;                      ///< of its middle along the lane at the start, m
    double speed = 0;                  ///< m/s
    double length = 4.4, width = 1.8;  ///< m
    double speed_factor = 0;           ///< desired speed over the limit; 0: random, 0.9 .. 1.05
    Beam beam = Beam::Low;
};

/// A pedestrian who walks to and fro over the road.
struct Walker {
    std::string node;
    size_t path = 0;  ///< index into WorldDescription::paths
    double wait = 5;  ///< before the first crossing, s; later waits are random
    double s = 0;     ///< position on the path at the start, m; above 0: under way
};

/// Initial state and rules of a world.
struct WorldDescription {
    std::vector<Course> lanes;
    std::vector<Course> paths;  ///< of walkers, beyond both kerbs; their speed is the walking speed
    std::vector<Barrier> barriers;
    std::vector<TrafficCar> cars;
    std::vector<Walker> walkers;
    std::vector<std::string> external_nodes;  ///< of the scene: what another program moves (World::place)
    VehicleParameters vehicle;                ///< of the driver
    std::string driver_node;
    size_t driver_lane = 0;
    double driver_s = 0, driver_speed = 0;  ///< m, m/s
    AutopilotSettings autopilot;
};

/// A moving object at the present time.
struct Actor {
    std::string node;
    glm::dvec3 position{0};               ///< of the node's origin, m
    double yaw = 0, pitch = 0, roll = 0;  ///< rad, in that order about Y, X and Z
    double speed = 0;                     ///< m/s
    VehicleLamps lamps;
    glm::dvec3 scale{1};  ///< of the node's meshes and of where its lamps are: along, across, up
};

/// An object that another program moves, as it is now.
struct ExternalActor {
    size_t index = 0;                  ///< of WorldDescription::external_nodes
    Actor actor;                       ///< `node` is not looked at
    double length = 4.4, width = 1.8;  ///< m; its middle is at the actor's position
    bool person = false;               ///< does not stop a car
};

/// A collision of the driver's car with a moving object.
struct Contact {
    double seconds = 0;  ///< time
    std::string node;    ///< node of the opponent
    double speed = 0;    ///< closing speed, m/s
    double impulse = 0;  ///< N s
};

class World {
public:
    World(std::shared_ptr<const WorldDescription>, uint64_t seed);

    /// Another program's objects from now on. Those that are not named are not there. `driver`: where it has the
    /// driver's car, which then drives no more by itself; the position is that of the car's middle on the ground.
    void place(std::vector<ExternalActor> actors, const std::optional<Actor>& driver = {});

    /// Advances by one step.
    void step(const DriverInput&, double seconds);

    double seconds() const { return seconds_; }
    uint64_t steps() const { return steps_; }
    const VehicleState& driver() const { return driver_; }
    const WorldDescription& description() const { return *description_; }
    size_t driver_lane() const { return driver_lane_; }  ///< lane of the autopilot
    bool touched() const { return touched_; }            ///< true if the car touched a barrier in the last step
    /// Collisions of the driver's car since the start, in order of time. Cars of traffic give way along their lane by
    /// their mass, external actors do not, pedestrians fall and stay.
    const std::vector<Contact>& contacts() const { return contacts_; }
    /// The driver's car first, then traffic, walkers and external actors, in the order of the description.
    std::vector<Actor> actors() const;

private:
    struct Car {
        double s = 0, speed = 0, acceleration = 0, speed_factor = 1;  // speed_factor: of the allowed speed
        size_t lane = 0, from = 0;                                    // from: the lane it is leaving
        double change = 1, offset = 0;  // 0 .. 1: progress of the change; offset to the left at
                                        // its start, m
        double patience = 0;            // s until the next lane change is considered
    };
    struct Walk {
        double s = 0, wait = 0;
        bool back = false, under_way = false, fallen = false;
        double speed = 0;
    };
    /// The next road user on a lane.
    struct Neighbour {
        double gap;    // bumper to bumper, m; infinite: none
        double speed;  // m/s
    };
    struct Occupant {  // a road user on a lane, in the last step
        size_t lane;
        double s, speed, half_length;
        int who;  // index of a car, or one of these
    };
    static constexpr int kDriver = -1, kWalker = -2, kExternal = -3;

    void occupy();
    Neighbour ahead(size_t lane, double s, double half_length, int self) const;
    Neighbour behind(size_t lane, double s, double half_length, int self) const;
    double follow(const Car&, size_t lane, double half_length, int self) const;
    void move_cars(double seconds);
    void consider_change(size_t index);
    void move_walkers(double seconds);
    void move_driver(const DriverInput&, double seconds);
    Course::Place ground() const;  // below the driver's car
    void meet_others(const VehicleState& before);
    glm::dvec2 meet(size_t who, const std::string& node, const GroundBox&, double height, const Opponent&, bool person);
    void find_crossings(const Course& path, size_t lane);
    bool way_is_free(size_t path) const;
    Course::Place place_of(size_t car) const;
    double draw(double low, double high);

    std::shared_ptr<const WorldDescription> description_;
    std::mt19937_64 random_;
    std::vector<Car> cars_;
    std::vector<Walk> walks_;
    std::vector<Course> back_;  // paths the other way
    struct Crossing {
        size_t lane;
        double s;  // of the lane
    };
    std::vector<std::vector<Crossing>> crossings_;  // of each path
    VehicleState driver_;
    DriverInput input_;
    bool braking_ = false, touched_ = false;
    size_t driver_lane_ = 0;
    double below_ = 0;  // m, under all ground: place of external actors that are not there
    std::vector<ExternalActor> external_actors_;
    std::optional<Actor> host_;  // the driver's car, where another program has it
    std::vector<Occupant> occupants_;
    std::vector<Contact> contacts_;
    std::vector<double> touched_at_;  // s, of each car, walker and external actor
    double seconds_ = 0;
    uint64_t steps_ = 0;
};

}  // namespace vesper::traffic
