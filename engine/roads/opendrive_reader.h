// What the parts of the OpenDRIVE reader share. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>

#include "roads/opendrive.h"
#include "roads/xml.h"

namespace vesper::roads {

struct OpenDriveReader {
    RoadNetwork& network;
    const RoadLimits& limits;
    size_t elements = 0;                                   ///< read so far
    std::map<std::string, uint32_t> roads{}, junctions{};  ///< by id
    std::set<std::string> said{};                          ///< kinds of notes that were made already

    /// Counts an element; throws when there are too many.
    void count(const XmlElement& element);
    /// Notes something, with its place.
    void note(const XmlElement& element, const std::string& what);
    /// Notes it where it happens first.
    void note_once(const XmlElement& element, const std::string& what);
};

/// e_roadMarkColor of OpenDRIVE; others are white.
MarkColour mark_colour(const std::string& name);
void read_plan(OpenDriveReader&, const XmlElement& element, Road& road);
void read_profiles(OpenDriveReader&, const XmlElement& element, Road& road);
void read_lanes(OpenDriveReader&, const XmlElement& element, Road& road);
void read_objects(OpenDriveReader&, const XmlElement& element, Road& road);
void read_signals(OpenDriveReader&, const XmlElement& element, Road& road);
void read_links(OpenDriveReader&, const XmlElement& element, Road& road);
void read_junction(OpenDriveReader&, const XmlElement& element, Junction& junction);
/// What only shows once everything is read: joints that do not meet, links to nowhere.
void check_network(OpenDriveReader&, const XmlFile& file);

/// Polynomials of the children `name`, with s from the attribute `s_name` plus `from`; sorted.
Profile profile_of(OpenDriveReader&, const XmlElement& element, std::string_view name, const char* s_name, double from);
/// What a speed element states from s on.
SpeedLimit limit_of(OpenDriveReader&, const XmlElement& element, double s);

}  // namespace vesper::roads
