// Runs of OpenSCENARIO files recorded by esmini: poses and lamps of entities over time. SPDX-License-Identifier: MIT
// Times s from the beginning of the run; positions m and angles rad in the frame of the OpenDRIVE file
// (RoadNetwork::to_world).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "roads/road_network.h"

namespace vesper::roads {

enum class RunLamp : uint8_t {
    LowBeam,
    HighBeam,
    DaytimeRunning,
    FogFront,
    FogRear,
    Brake,
    Reversing,
    IndicatorLeft,
    IndicatorRight,
    LicencePlate,
    SpecialPurpose,
    Count
};
const char* name_of(RunLamp);

/// Pose of an entity's reference point; of vehicles, the point on the road under the middle of the rear axle.
struct RunPose {
    double time = 0;
    glm::dvec3 position{0};
    double heading = 0, pitch = 0,
           roll = 0;            ///< counter-clockwise from x; nose down positive; right side down positive
    double speed = 0;           ///< m/s, negative backwards
    double wheel_angle = 0;     ///< of the front wheels, to the left
    double wheel_rotation = 0;  ///< of all wheels about their axles, modulo 2 pi
};

/// Setting of a lamp. A flashing lamp depends on the time since.
struct LampEvent {
    enum class Mode : uint8_t { Off, On, Flashing };
    double time = 0;
    Mode mode = Mode::Off;
    double transition = 0;                 ///< s until the setting is reached
    double on_time = 0.5, off_time = 0.5;  ///< s, Flashing (the defaults of OpenSCENARIO)
    double intensity = 0;                  ///< cd as stated; 0: not stated
    std::optional<glm::dvec3> colour;      ///< linear, as stated
};

/// State of a lamp at a time.
struct LampState {
    double level = 0;      ///< [0, 1] of its intensity
    double intensity = 0;  ///< cd stated, 0: none
    std::optional<glm::dvec3> colour;
};

struct RunEntity {
    enum class Kind : uint8_t { Car, Truck, Bus, Motorcycle, Bicycle, Trailer, Pedestrian, Animal, Object };
    std::string name;
    int id = 0;
    Kind kind = Kind::Car;
    double length = 0, width = 0, height = 0;   ///< m, of the bounding box; 0: not known
    glm::dvec3 centre{0};                       ///< of that box from the reference point: ahead, left, up
    double acceleration = 0, deceleration = 0;  ///< m/s^2, limits; 0: not known
    std::vector<RunPose> poses;  ///< times ascending, at least one; the entity exists from the first to the last
    std::array<std::vector<LampEvent>, static_cast<size_t>(RunLamp::Count)> lamps;  ///< times ascending
    std::array<bool, static_cast<size_t>(RunLamp::Count)> stated{};                 ///< the scenario sets this lamp
};

/// Setting of a traffic light; the signal defines the meaning of the state ("green", "on;off;off", ...).
struct SignalEvent {
    double time = 0;
    std::string signal, state;
    std::string place = {};  ///< file and line of the scenario
};

struct EsminiRun {
    std::string road_file;  ///< LogicFile of the scenario, as stated
    std::vector<RunEntity> entities;
    std::vector<SignalEvent> signals;      ///< times ascending
    std::vector<SignalEvent> time_of_day;  ///< state: the date and time as stated
    double duration = 0;                   ///< s
    std::vector<std::string> notes;        ///< omitted parts, one line each
};

/// Reads the table that esmini's dat2csv writes (columns by their names: time, id, name, x, y, z, h, p, r, speed,
/// wheel_angle, wheel_rot; others are ignored), or that of its CSV logger (`--csv_logger`: all entities in a row, with
/// their sizes). Missing speeds follow from the places. `scenario`: the .xosc file of the run, for sizes and kinds of
/// its catalogs and for the lamps and traffic lights of its storyboard. The storyboard is played at the time steps of
/// the run with recorded poses, so events lie within two steps of esmini's. Without a setting of the scenario: low
/// beams are on; brake lamps are on while a vehicle slows down by more than 0.7 m/s^2 or stands; reversing lamps while
/// it goes backwards. `roads` is needed for conditions on road positions. Throws Error naming file, line and reason.
EsminiRun read_esmini_run(const std::filesystem::path& table,
                          const std::optional<std::filesystem::path>& scenario = std::nullopt,
                          const RoadNetwork* roads = nullptr);

/// The pose at a time, interpolated (angles the short way); constant before the first and after the last.
RunPose pose_at(const RunEntity& entity, double time);
bool is_there(const RunEntity& entity, double time);
LampState lamp_at(const RunEntity& entity, RunLamp lamp, double time);
/// The state of a traffic light; empty if not set yet.
std::string signal_at(const EsminiRun& run, const std::string& signal, double time);

}  // namespace vesper::roads
