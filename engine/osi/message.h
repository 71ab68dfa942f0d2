// What a simulator says of one moment, by ASAM Open Simulation Interface (OSI) 3. SPDX-License-Identifier: MIT
// Lengths m, angles rad, in the frame of the messages: z up, yaw counter-clockwise from x.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::osi {

constexpr uint64_t kMostMessageBytes = uint64_t{16} << 20;
constexpr int64_t kMostNanoseconds = 4'000'000'000'000'000'000;  ///< of times, before and after 0: 126 years
constexpr int kMostObjects = 10'000;                             ///< of a message, and as many traffic lights

/// What is stated of a lamp.
enum class LampState : uint8_t { Unknown, Off, On, Flashing };

/// LightState of a vehicle, a lamp each.
struct LightStates {
    LampState low = LampState::Unknown, high = LampState::Unknown, tail = LampState::Unknown,
              brake = LampState::Unknown, left = LampState::Unknown, right = LampState::Unknown,
              front_fog = LampState::Unknown, rear_fog = LampState::Unknown, reversing = LampState::Unknown;
    bool operator==(const LightStates&) const = default;
};

struct MovingObject {
    enum class Kind : uint8_t { Car, Truck, Bus, Motorcycle, Bicycle, Trailer, Pedestrian, Animal, Object };
    uint64_t id = 0;
    Kind kind = Kind::Object;
    std::string model;                    ///< model_reference
    glm::dvec3 size{0};                   ///< length, width, height of the bounding box; 0: not stated
    glm::dvec3 centre{0};                 ///< middle of that box
    double yaw = 0, pitch = 0, roll = 0;  ///< turned in that order; nose down and right side down positive
    std::optional<glm::dvec3> velocity;   ///< m/s
    LightStates lights;
};

/// Length, width and height where none are stated, m.
glm::dvec3 usual_size(MovingObject::Kind);

/// Ahead, left and up of an object that is turned by yaw, then pitch, then roll: columns, of length 1.
glm::dmat3 axes_of(double yaw, double pitch, double roll);

/// One lens of a traffic light.
struct TrafficLight {
    enum class Colour : uint8_t { Other, Red, Yellow, Green };
    uint64_t id = 0;
    std::string signal;  ///< its signal's id in the OpenDRIVE file (source_reference); empty: not stated
    glm::dvec3 position{0};
    Colour colour = Colour::Other;
    LampState state = LampState::Unknown;
};

/// A thing that stands, or a plate of a traffic sign.
struct StationaryObject {
    /// In the order of OSI's types, and a sign.
    enum class Kind : uint8_t {
        Unknown,
        Other,
        Bridge,
        Building,
        Pole,
        Pylon,
        Delineator,
        Tree,
        Barrier,
        Vegetation,
        Curbstone,
        Wall,
        Vertical,
        Rectangular,
        Overhead,
        Reflective,
        Construction,
        SpeedBump,
        Emitting,
        Sign
    };
    uint64_t id = 0;
    uint32_t plate = 0;  ///< of a sign: 0 is the main one
    Kind kind = Kind::Unknown;
    glm::dvec3 size{0};                   ///< length, width, height; 0: not stated
    glm::dvec3 centre{0};                 ///< middle of its box
    double yaw = 0, pitch = 0, roll = 0;  ///< as of moving objects; signs face ahead
};
/// Two with one key are the same thing: by their ids, without ids by their places.
using StationaryKey = std::tuple<bool, uint32_t, uint64_t, double, double, double>;
StationaryKey key_of(const StationaryObject&);

/// What is stated of sky and weather.
struct Environment {
    std::optional<double> sun_elevation;  ///< rad
    std::optional<double> time_of_day;    ///< s since midnight, local
    int ambient_level = 0;                ///< AmbientIllumination: 1 .. 9, LEVEL1 .. LEVEL9; 0: not stated
    bool fog = false;                     ///< visibility below 1000 m
    bool precipitation = false;
    bool operator==(const Environment&) const = default;
};

struct Message {
    int64_t nanoseconds = 0;  ///< timestamp
    std::optional<uint64_t> host;
    std::vector<MovingObject> objects;
    std::vector<TrafficLight> traffic_lights;
    std::optional<Environment> environment;
    std::vector<StationaryObject> stationary;  ///< at most kMostObjects
    uint64_t stationary_left_out = 0;          ///< beyond that, without a place, or with a pose that is no number
};

/// Reads a GroundTruth, or that of a SensorView. Objects without a place or with a pose that is no number are left out,
/// and sizes that cannot be count as not stated. Throws Error with the reason, which names other messages of OSI that
/// are told.
Message parse_message(std::span<const uint8_t> bytes);

/// What it takes, bytes.
uint64_t memory_of(const Message&);

/// The message as a GroundTruth: parse_message() gives it back, apart from what it leaves out. Without things that
/// stand.
std::string bytes_of(const Message&);

}  // namespace vesper::osi
