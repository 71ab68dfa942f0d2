// Links of OpenDRIVE roads, and whether what is linked meets. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "roads/opendrive_reader.h"
#include "roads/road_surface.h"

namespace vesper {
namespace {

constexpr double kJoint = 0.1;  // m

RoadEnd end_of(const std::string& contact) { return contact == "end" ? RoadEnd::End : RoadEnd::Start; }

RoadLink link_of(OpenDriveReader& reader, const XmlElement& element) {
    RoadLink link;
    const std::string type = element.text_or("elementType", "road"), id = element.text_or("elementId", "");
    const auto& ids = type == "junction" ? reader.junctions : reader.roads;
    const auto found = ids.find(id);
    if (found == ids.end()) {
        reader.note(element, "there is no " + type + " '" + id + "'");
        return link;
    }
    link.to = type == "junction" ? RoadLink::To::Junction : RoadLink::To::Road;
    link.index = found->second;
    if (link.to == RoadLink::To::Road && !element.attribute("contactPoint")) reader.note(element, "contactPoint is missing: taken for start");
    link.contact = end_of(element.text_or("contactPoint", "start"));
    return link;
}

glm::dvec2 end_point(const Road& road, RoadEnd end) {
    const RoadPoint point = reference_point(road, end == RoadEnd::Start ? 0 : road.length);
    return {point.position.x, point.position.y};
}

void check_joint(OpenDriveReader& reader, const XmlElement& element, const Road& road, const RoadLink& link, RoadEnd end) {
    if (link.to != RoadLink::To::Road) return;
    const Road& other = reader.network.roads[link.index];
    // Reference lines need not meet where lane offsets differ; centre lanes must.
    const auto centre = [](const Road& each, RoadEnd at) {
        const double s = at == RoadEnd::Start ? 0 : each.length;
        return glm::dvec2(surface_point(each, s, each.lane_offset.at(s)).position);
    };
    const double gap = std::min(glm::distance(end_point(road, end), end_point(other, link.contact)), glm::distance(centre(road, end), centre(other, link.contact)));
    // In junctions roads branch off lanes of the side.
    if (gap > kJoint && road.junction == kNoRoad && other.junction == kNoRoad)
        reader.note(element, "road '" + road.id + "' and road '" + other.id + "' are linked but " + std::to_string(gap) + " m apart");
}

}  // namespace

void read_links(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    const auto holder = element.child("link");
    if (!holder) return;
    if (const auto each = holder->child("predecessor")) road.predecessor = link_of(reader, *each);
    if (const auto each = holder->child("successor")) road.successor = link_of(reader, *each);
}

void read_junction(OpenDriveReader& reader, const XmlElement& element, Junction& junction) {
    junction.direct = element.text_or("type", "default") == "direct";
    for (const XmlElement& each : element.children("connection")) {
        reader.count(each);
        JunctionConnection connection;
        const auto road = [&](const char* attribute) {
            const auto found = reader.roads.find(each.text_or(attribute, ""));
            return found == reader.roads.end() ? kNoRoad : found->second;
        };
        connection.incoming = road("incomingRoad");
        connection.connecting = road("connectingRoad");
        if (connection.connecting == kNoRoad) connection.connecting = road("linkedRoad");
        connection.contact = end_of(each.text_or("contactPoint", "start"));
        for (const XmlElement& link : each.children("laneLink")) connection.lanes.emplace_back(link.integer("from", -1000, 1000), link.integer("to", -1000, 1000));
        if (connection.incoming == kNoRoad || connection.connecting == kNoRoad) {
            if (each.text_or("type", "default") != "virtual") reader.note(each, "joins roads that are not there: left out");
            continue;
        }
        junction.connections.push_back(std::move(connection));
    }
}

void check_network(OpenDriveReader& reader, const XmlFile& file) {
    size_t index = 0;
    for (const XmlElement& each : file.root().children("road")) {
        const Road& road = reader.network.roads[index++];
        check_joint(reader, each, road, road.predecessor, RoadEnd::Start);
        check_joint(reader, each, road, road.successor, RoadEnd::End);
        for (const LaneSection& section : road.sections)
            for (const RoadLane& lane : section.lanes) {
                double least = 0;
                for (int i = 0; i <= 16 && lane.id != 0; ++i)
                    least = std::min(least, stated_width(section, lane, section.s + (section.end - section.s) * (i / 16.0)));
                if (least < -0.01)
                    reader.note(each, "road '" + road.id + "' lane " + std::to_string(lane.id) + " is as little as " + std::to_string(least) + " m wide: taken for 0");
            }
    }
}

}  // namespace vesper
