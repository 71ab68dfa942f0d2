// Shared parts of the OpenDRIVE reader. Not a public header. SPDX-License-Identifier: MIT
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
    std::set<std::string> said{};                          ///< kinds of notes made so far

    /// Counts an element. Throws Error if there are too many.
    void count(const XmlElement& element);
    /// Adds a note with its place.
    void note(const XmlElement& element, const std::string& what);
    /// Adds a note with its place, once per text.
    void note_once(const XmlElement& element, const std::string& what);
};

/// e_roadMarkColor of OpenDRIVE; others are white.
MarkColour mark_colour(const std::string& name);
void read_plan(OpenDriveReader&, const XmlElement& element, Road& road);
void read_profiles(OpenDriveReader&, const XmlElement& element, Road& road);
void read_lanes(OpenDriveReader&, const XmlElement& element, Road& road);
void read_objects(OpenDriveReader&, const XmlElement& element, Road& road);
void read_signals(OpenDriveReader&, const XmlElement& element, Road& road);
/// The controllers of the whole network.
void read_controllers(OpenDriveReader&, const XmlElement& root);
void read_links(OpenDriveReader&, const XmlElement& element, Road& road);
void read_junction(OpenDriveReader&, const XmlElement& element, Junction& junction);
/// Checks of the complete network: joints that do not meet, links to nowhere.
void check_network(OpenDriveReader&, const XmlFile& file);

/// Polynomials of the children `name`, with s from the attribute `s_name` plus `from`; sorted.
Profile profile_of(OpenDriveReader&, const XmlElement& element, std::string_view name, const char* s_name, double from);
/// The limit of a speed element from s on.
SpeedLimit limit_of(OpenDriveReader&, const XmlElement& element, double s);

}  // namespace vesper::roads
