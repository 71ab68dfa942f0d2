// Reading OpenDRIVE: the table of contents. SPDX-License-Identifier: MIT
#include "roads/opendrive.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "roads/opendrive_reader.h"

namespace vesper::roads {
namespace {

constexpr size_t kMaxRoadNotes = 100;
constexpr double kNear = 4096;  // m: floats are exact to 0.25 mm there

void read_header(OpenDriveReader& reader, const XmlElement& root) {
    const auto header = root.child("header");
    if (!header) return reader.note(root, "has no header: read as OpenDRIVE 1.4");
    const auto number = [&](const char* name) {
        const std::string text = header->text_or(name, "");
        return !text.empty() && text.size() < 4 && text.find_first_not_of("0123456789") == text.npos ? std::stoi(text)
                                                                                                     : -1;
    };
    reader.network.name = header->text_or("name", "");
    reader.network.major = number("revMajor"), reader.network.minor = number("revMinor");
    if (reader.network.major != 1 || reader.network.minor < 1 || reader.network.minor > 9)
        reader.note(*header, "revision '" + one_line(header->text_or("revMajor", "")) + "." +
                                 one_line(header->text_or("revMinor", "")) + "' is none of 1.4 to 1.8: read as such");
}

void enter(OpenDriveReader& reader, std::map<std::string, uint32_t>& ids, const XmlElement& element,
           const std::string& id, size_t index) {
    if (!ids.emplace(id, static_cast<uint32_t>(index)).second)
        reader.note(element, "the id '" + one_line(id) + "' is there twice: the first is meant by links");
}

void read_traffic(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    for (const XmlElement& each : element.children("type")) {
        reader.count(each);
        if (road.type.empty()) road.type = each.text_or("type", "unknown");
        const auto speed = each.child("speed");
        const double s = each.number_or("s", 0, 0);
        road.speeds.push_back(speed ? limit_of(reader, *speed, s) : SpeedLimit{s, 0});
    }
    std::stable_sort(road.speeds.begin(), road.speeds.end(),
                     [](const SpeedLimit& a, const SpeedLimit& b) { return a.s < b.s; });
}

void read_road(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    road.length = element.number_or("length", 0, 0, reader.limits.road_length);
    const std::string rule = element.text_or("rule", "RHT");
    road.right_hand = rule != "LHT";
    if (road.right_hand && rule != "RHT")
        reader.note(element, "the rule '" + rule + "' is neither RHT nor LHT: taken for RHT");
    const std::string junction = element.text_or("junction", "-1");
    if (junction != "-1") {
        const auto found = reader.junctions.find(junction);
        if (found == reader.junctions.end())
            reader.note(element, "there is no junction '" + junction + "'");
        else
            road.junction = found->second;
    }
    read_plan(reader, element, road);
    read_profiles(reader, element, road);
    read_lanes(reader, element, road);
    read_traffic(reader, element, road);
    read_objects(reader, element, road);
}

/// The world begins near the roads where the file's frame does not.
glm::dvec3 origin_of(const RoadNetwork& network) {
    glm::dvec2 low(1e300), high(-1e300);
    for (const Road& road : network.roads)
        for (const PlanGeometry& g : road.plan) low = glm::min(low, {g.x, g.y}), high = glm::max(high, {g.x, g.y});
    const glm::dvec2 far = glm::max(glm::abs(low), glm::abs(high));
    if (network.roads.empty() || std::max(far.x, far.y) < kNear) return glm::dvec3(0);
    return {glm::round((low + high) / 2000.0) * 1000.0, 0};
}

RoadNetwork read_checked(const XmlFile& file, const RoadLimits& limits) {
    const XmlElement root = file.root();
    if (root.name() != "OpenDRIVE") root.fail("the root of an OpenDRIVE file must be OpenDRIVE");
    RoadNetwork network;
    OpenDriveReader reader{network, limits};
    read_header(reader, root);

    const auto roads = root.children("road"), junctions = root.children("junction");
    if (const auto included = root.child("include"))
        reader.note(*included, "'" + included->text_or("file", "") + "' is not read: give files without includes");
    if (roads.empty())
        root.fail(root.child("include") ? "has no road of its own, and includes are not read" : "has no road");
    if (roads.size() > limits.roads || junctions.size() > limits.roads)
        root.fail("has more than " + std::to_string(limits.roads) + " roads or junctions");
    for (const XmlElement& each : junctions) {
        Junction junction{each.text_or("id", ""), each.text_or("name", "")};
        enter(reader, reader.junctions, each, junction.id, network.junctions.size());
        network.junctions.push_back(std::move(junction));
    }
    for (const XmlElement& each : roads) {
        Road road{each.text_or("id", ""), each.text_or("name", ""), each.line()};
        enter(reader, reader.roads, each, road.id, network.roads.size());
        network.roads.push_back(std::move(road));
    }
    double total = 0;
    for (size_t i = 0; i < roads.size(); ++i) {
        read_road(reader, roads[i], network.roads[i]);
        total += network.roads[i].length;
        if (total > limits.total_length)
            roads[i].fail("roads of more than " + std::to_string(limits.total_length / 1000) + " km");
    }
    // Signals may stand on any of them.
    for (size_t i = 0; i < roads.size(); ++i) read_signals(reader, roads[i], network.roads[i]);
    for (size_t i = 0; i < roads.size(); ++i) read_links(reader, roads[i], network.roads[i]);
    read_controllers(reader, root);
    for (size_t i = 0; i < junctions.size(); ++i) read_junction(reader, junctions[i], network.junctions[i]);
    check_network(reader, file);
    if (std::none_of(network.roads.begin(), network.roads.end(),
                     [](const Road& road) { return road.length > 0 && !road.sections.empty(); }))
        root.fail("none of its roads has lanes");
    network.origin = origin_of(network);
    network.unread = file.unread();
    return network;
}

}  // namespace

void OpenDriveReader::count(const XmlElement& element) {
    if (++elements > limits.elements)
        element.fail("the file has more than " + std::to_string(limits.elements) + " elements");
}

void OpenDriveReader::note(const XmlElement& element, const std::string& what) {
    if (network.notes.size() < kMaxRoadNotes)
        network.notes.push_back(element.place() + ": " + one_line(what));
    else if (network.notes.size() == kMaxRoadNotes)
        network.notes.push_back(element.place() + ": and more of the kind");
}

void OpenDriveReader::note_once(const XmlElement& element, const std::string& what) {
    if (said.insert(what).second) note(element, what);
}

RoadNetwork parse_opendrive(std::string_view text, const std::string& name, const RoadLimits& limits) {
    try {
        return read_checked(XmlFile(text, name), limits);
    } catch (const std::bad_alloc&) {
        throw OutOfHostMemory(one_line(name) + ": not enough memory");
    }
}

RoadNetwork read_opendrive(const std::filesystem::path& path, const RoadLimits& limits) {
    const Budget budget("reading " + one_line(path.string()));
    const std::vector<uint8_t> bytes = io::read_file(path, limits.file_bytes);
    return parse_opendrive({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string(), limits);
}

}  // namespace vesper::roads
