// Where the objects come from that another program moves. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "osi/trace.h"

namespace vesper::drive {

/// Part of an object's box that its base.position is (--osi-z). Auto: as the ground below the objects tells.
enum class HeightReading : uint8_t { Auto, Middle, Ground };
inline constexpr std::array<const char*, 3> kHeightReadings{"auto", "middle", "ground"};  ///< in its order
/// Throws Error.
HeightReading height_reading_of(const std::string& name);

/// Of a recorded drive, too: its file says all of this.
struct MessageSource {
    std::filesystem::path file;    ///< an OSI trace (.osi), or a table of esmini (.csv); empty: none
    bool live = false;             ///< messages are not known beforehand; of a replay: they were not
    std::filesystem::path models;  ///< which meshes the objects are (docs/osi.md); empty: boxes with lamps
    std::string host;              ///< id of the object that is the driver's car; empty: as messages say; "none"
    glm::dvec4 origin{0};  ///< of the frame of the messages, in that of the roads: x, y, z (m) and yaw (rad). Of a
                           ///< scene the latter is X, -Z, Y
    HeightReading heights = HeightReading::Auto;

    bool any() const { return live || !file.empty(); }
};

/// The id of an object, as of MessageSource::host, in its usual digits; empty and "none" stay. Throws Error.
std::string host_of(const std::string& text);

/// What is said where messages state it.
inline constexpr char kWeather[] = "fog or rain, which is not rendered";

/// The trace of the source's file, with notes: at least one message if there is a file and it was not live. Throws
/// Error, naming file, place and reason.
osi::Trace read_messages(const MessageSource&);

}  // namespace vesper::drive
