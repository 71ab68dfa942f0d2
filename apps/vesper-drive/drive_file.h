// Drives as files: what was done, step by step, to be driven again (docs/simulator.md). SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "io/growing_file.h"
#include "settings.h"
#include "simulation/driver.h"

namespace vesper {

/// What happened, in the order in which it did.
struct DriveEvent {
    enum class Kind : uint8_t { Step, Frame, Set, Restart };
    Kind kind = Kind::Step;
    DriverInput input;              ///< Step
    std::optional<glm::dvec4> pose; ///< Step: X, Z (m), yaw (rad) and speed (m/s) of the driver's car after it, where that is known
    std::string name, value;        ///< Set
};

/// How a drive begins.
struct DriveStart {
    std::filesystem::path scene;          ///< a world (.json), roads (.xodr) or a scene (.gltf, .glb)
    std::filesystem::path run, scenario;  ///< as of Scenery
    uint64_t seed = 1;
    double time_step = 1.0 / 60;          ///< s
    DriveSettings::Values settings;       ///< what differs from the defaults
};

struct Drive {
    DriveStart start;
    std::vector<DriveEvent> events;
    bool complete = true;  ///< false: its program ended before it did
};

/// Reads a drive, also one that breaks off. Throws Error, naming file, place and reason.
Drive read_drive(const std::filesystem::path&);

/// Remembers a drive as the lines of its file, and keeps that file up to date once there is one (GrowingFile: read_drive also takes
/// the part of it that a broken drive leaves).
class DriveRecorder {
public:
    explicit DriveRecorder(DriveStart);

    void add(const DriveEvent&);
    /// Writes all there is; from now on every event follows at once. Throws Error.
    void open(const std::filesystem::path&);
    /// Completes the file. Throws Error.
    void close();
    bool is_open() const { return file_ != nullptr; }

private:
    void write(const std::string&);

    DriveStart start_;
    std::string lines_;  // of the events so far
    bool first_ = true;
    DriverInput last_;
    std::unique_ptr<GrowingFile> file_;
};

}  // namespace vesper
