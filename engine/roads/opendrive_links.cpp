// Links of OpenDRIVE roads, and whether what is linked meets. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "roads/opendrive_reader.h"
#include "roads/road_surface.h"

namespace vesper::roads {
namespace {

constexpr double kRoadGap = 0.1;  // m

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
    if (link.to == RoadLink::To::Road && !element.attribute("contactPoint"))
        reader.note(element, "contactPoint is missing: taken for start");
    link.contact = end_of(element.text_or("contactPoint", "start"));
    return link;
}

glm::dvec2 end_point(const Road& road, RoadEnd end) {
    const RoadPoint point = reference_point(road, end == RoadEnd::Start ? 0 : road.length);
    return {point.position.x, point.position.y};
}

void check_joint(OpenDriveReader& reader, const XmlElement& element, const Road& road, const RoadLink& link,
                 RoadEnd end) {
    if (link.to != RoadLink::To::Road) return;
    const Road& other = reader.network.roads[link.index];
    // Reference lines need not meet where lane offsets differ; centre lanes must.
    const auto centre = [](const Road& each, RoadEnd at) {
        const double s = at == RoadEnd::Start ? 0 : each.length;
        return glm::dvec2(surface_point(each, s, each.lane_offset.at(s)).position);
    };
    const double gap = std::min(glm::distance(end_point(road, end), end_point(other, link.contact)),
                                glm::distance(centre(road, end), centre(other, link.contact)));
    // In junctions roads branch off lanes of the side.
    if (gap > kRoadGap && road.junction == kNoRoad && other.junction == kNoRoad)
        reader.note(element, "road '" + road.id + "' and road '" + other.id + "' are linked but " +
                                 std::to_string(gap) + " m apart");
}

/// s of each part of a profile within [from, to]: its beginning, where the next one takes over, and between.
template <typename Visit>
void over_parts(const Profile& profile, double from, double to, const Visit& visit) {
    constexpr int kSteps = 8;
    for (size_t i = 0; i < profile.parts.size(); ++i) {
        const double begin = std::max(profile.parts[i].s, from),
                     end = i + 1 < profile.parts.size() ? std::min(profile.parts[i + 1].s, to) : to;
        for (int k = 0; k <= kSteps && begin < end; ++k)
            visit(std::min(begin + (end - begin) * k / kSteps, end - 1e-9));
    }
}

/// Widths and heights that no road has; lanes that turn inside out.
void check_extent(OpenDriveReader& reader, const XmlElement& element, const Road& road) {
    constexpr int kSamples = 16;
    for (int i = 0; i <= kSamples; ++i) {
        const double s = road.length * i / kSamples, z = surface_point(road, s, 0).position.z;
        if (!(std::abs(z) <= reader.limits.height))
            element.fail("road '" + road.id + "' is " + std::to_string(z) + " m high at s = " + std::to_string(s));
    }
    for (const LaneSection& section : road.sections) {
        for (int i = 0; i <= kSamples; ++i) {
            const double s = section.s + (section.end - section.s) * i / kSamples;
            const double left = lane_border(road, section, section.leftmost(), s),
                         right = lane_border(road, section, section.rightmost(), s);
            if (!(std::max(std::abs(left), std::abs(right)) <= reader.limits.lane_width))
                element.fail("road '" + road.id + "' reaches from t = " + std::to_string(right) + " m to " +
                             std::to_string(left) + " m");
        }
        for (const RoadLane& lane : section.lanes) {
            if (lane.id == 0) continue;
            double least = 0, most = 0;
            for (const Profile* profile : {&lane.width, &lane.border})
                over_parts(*profile, section.s, section.end, [&](double s) {
                    const double width = stated_width(section, lane, s);
                    least = std::min(least, width), most = std::max(most, width);
                });
            const std::string name = "road '" + road.id + "' lane " + std::to_string(lane.id);
            if (!(most <= reader.limits.lane_width)) element.fail(name + " is " + std::to_string(most) + " m wide");
            if (least < -0.01)
                reader.note(element, name + " is as little as " + std::to_string(least) + " m wide: taken for 0");
        }
    }
    over_parts(road.lane_offset, 0, road.length, [&](double s) {
        if (const double t = road.lane_offset.at(s); !(std::abs(t) <= reader.limits.lane_width))
            element.fail("road '" + road.id + "' has a lane offset of " + std::to_string(t) +
                         " m at s = " + std::to_string(s));
    });
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
    for (const XmlElement& each : element.children("controller")) {
        reader.count(each);
        junction.controllers.push_back(each.text_or("id", ""));
    }
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
        for (const XmlElement& link : each.children("laneLink"))
            connection.lanes.emplace_back(link.integer("from", -1000, 1000), link.integer("to", -1000, 1000));
        if (connection.incoming == kNoRoad || connection.connecting == kNoRoad) {
            if (each.text_or("type", "default") != "virtual")
                reader.note(each, "joins roads that are not there: left out");
            continue;
        }
        junction.connections.push_back(std::move(connection));
    }
}

void check_network(OpenDriveReader& reader, const XmlFile& file) {
    size_t index = 0;
    for (const XmlElement& each : file.root().children("road")) {
        const Road& road = reader.network.roads[index++];
        check_extent(reader, each, road);
        check_joint(reader, each, road, road.predecessor, RoadEnd::Start);
        check_joint(reader, each, road, road.successor, RoadEnd::End);
    }
}

}  // namespace vesper::roads
