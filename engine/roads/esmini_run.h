// Runs of OpenSCENARIO files recorded by esmini: poses of entities over time. SPDX-License-Identifier: MIT
// Times s from the beginning of the run; positions m and angles rad in the frame of the OpenDRIVE file
// (RoadNetwork::to_world).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::roads {

/// Pose of an entity's reference point; of vehicles, the point on the road under the middle of the rear axle.
struct RunPose {
    double time = 0;
    glm::dvec3 position{0};
    double heading = 0, pitch = 0,
           roll = 0;   ///< counter-clockwise from x; nose down positive; right side down positive
    double speed = 0;  ///< m/s, negative backwards
};

struct RunEntity {
    enum class Kind : uint8_t { Car, Truck, Bus, Motorcycle, Bicycle, Trailer, Pedestrian, Animal, Object };
    std::string name;
    int id = 0;
    Kind kind = Kind::Car;
    double length = 0, width = 0, height = 0;  ///< m, of the bounding box; 0: not known
    glm::dvec3 centre{0};                      ///< of that box from the reference point: ahead, left, up
    std::vector<RunPose> poses;  ///< times ascending, at least one; the entity exists from the first to the last
};

struct EsminiRun {
    std::vector<RunEntity> entities;
    double duration = 0;  ///< s
};

/// Reads the table that esmini's dat2csv writes (columns by their names: time, id, name, x, y, z, h, p, r, speed;
/// others are ignored), or that of its CSV logger (`--csv_logger`: all entities in a row, with
/// their sizes). Missing speeds follow from the places. Throws Error naming file, line and reason.
EsminiRun read_esmini_run(const std::filesystem::path& table);

/// The pose at a time, interpolated (angles the short way); constant before the first and after the last.
RunPose pose_at(const RunEntity& entity, double time);

}  // namespace vesper::roads
