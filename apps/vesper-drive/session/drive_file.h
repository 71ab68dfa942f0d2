// Drives as files: what was done, step by step, to be driven again (docs/drives.md). SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "external/message_source.h"
#include "io/growing_file.h"
#include "session/drive_events.h"
#include "session/settings.h"

namespace vesper::drive {

/// How a drive begins.
struct DriveStart {
    std::filesystem::path scene;  ///< a world (.json), roads (.xodr) or a scene (.gltf, .glb)
    MessageSource messages;       ///< of objects that another program moves
    uint64_t seed = 1;
    double time_step = 1.0 / 60;                          ///< s
    DriveSettings::Values settings;                       ///< what differs from the defaults
    render::Quality quality = render::Quality::Standard;  ///< where settings name none; no recording has it
    std::optional<glm::uvec2>
        size;  ///< px, of its pictures when its recording began; none of channels, and where none were made
};

struct Drive {
    std::filesystem::path file;
    DriveStart start;
    DriveEvents events;
    bool complete = true;  ///< false: its program ended before it did
};

/// Reads a drive, also one that breaks off. Throws Error, naming file, place and reason.
Drive read_drive(const std::filesystem::path&);

/// Asks `possible` of all settings that a drive comes to have, and `shown` of those that its frames show (its steps
/// where it has no frames); what was given beside it (`kept`) wins over what it sets. Where one throws Error, this
/// does, naming file and place of what the drive has set.
using SettingsCheck = std::function<void(const DriveSettings&)>;
void check_settings(const Drive&, const DriveSettings::Values& kept, const SettingsCheck& possible,
                    const SettingsCheck& shown);

/// The trace beside a recording that has the messages of a live source.
std::filesystem::path messages_of(const std::filesystem::path& recording);

/// Remembers a drive, and keeps that file up to date once there is one (GrowingFile: read_drive also takes
/// the part of it that a broken drive leaves).
class DriveRecorder {
public:
    explicit DriveRecorder(DriveStart);

    void add(const DriveEvent&);
    /// Writes all there is; from now on every event follows at once. `size`: as of DriveStart. Throws Error.
    void open(const std::filesystem::path&, std::optional<glm::uvec2> size = {});
    /// Completes the file. Throws Error.
    void close();
    bool is_open() const { return file_ != nullptr; }

private:
    std::string line(const DriveEvent&);
    void write(const std::string&);

    DriveStart start_;
    DriveEvents events_;
    bool first_ = true;          // the next line
    traffic::DriverInput last_;  // of the lines so far
    std::unique_ptr<io::GrowingFile> file_;
};

}  // namespace vesper::drive
