// Lane sections, lanes and road marks of OpenDRIVE roads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "roads/opendrive_reader.h"

namespace vesper::roads {
namespace {

constexpr int kMaxLaneId = 128;             // either side; motorways have ten
constexpr double kMaxWidth = 1e4;           // m
constexpr double kShortestSection = 0.001;  // m, of a lane section

// What a broken line is painted like where the file does not say: 3 m and 6 m of gap, as on country roads.
constexpr double kDash = 3, kGap = 6;
constexpr double kWidth = 0.12, kBoldWidth = 0.25;  // m

LaneType lane_type_of(OpenDriveReader& reader, const XmlElement& element) {
    static const std::map<std::string, LaneType> kTypes{{"none", LaneType::None},
                                                        {"driving", LaneType::Driving},
                                                        {"stop", LaneType::Stop},
                                                        {"shoulder", LaneType::Shoulder},
                                                        {"biking", LaneType::Biking},
                                                        {"sidewalk", LaneType::Sidewalk},
                                                        {"walking", LaneType::Sidewalk},
                                                        {"border", LaneType::Border},
                                                        {"restricted", LaneType::Restricted},
                                                        {"roadWorks", LaneType::Restricted},
                                                        {"parking", LaneType::Parking},
                                                        {"median", LaneType::Median},
                                                        {"curb", LaneType::Curb},
                                                        {"entry", LaneType::Entry},
                                                        {"mwyEntry", LaneType::Entry},
                                                        {"exit", LaneType::Exit},
                                                        {"mwyExit", LaneType::Exit},
                                                        {"onRamp", LaneType::Ramp},
                                                        {"offRamp", LaneType::Ramp},
                                                        {"connectingRamp", LaneType::Ramp},
                                                        {"slipLane", LaneType::Ramp},
                                                        {"bidirectional", LaneType::Bidirectional},
                                                        {"bus", LaneType::Driving},
                                                        {"taxi", LaneType::Driving},
                                                        {"HOV", LaneType::Driving},
                                                        {"hov", LaneType::Driving},
                                                        {"shared", LaneType::Driving},
                                                        {"tram", LaneType::Rail},
                                                        {"rail", LaneType::Rail}};
    const std::string name = element.text_or("type", "none");
    const auto found = kTypes.find(name);
    if (found != kTypes.end()) return found->second;
    reader.note_once(element, "the lane type '" + name.substr(0, 40) + "' is not known: nobody drives there");
    return LaneType::Other;
}

void read_patterns(const XmlElement& element, RoadMark& mark, const MarkLine& like) {
    for (const char* holder : {"type", "explicit"})
        for (const XmlElement& each : element.children_of(holder, "line")) {
            MarkLine line = like;
            line.width = each.number_or("width", like.width, -100, 100);
            if (line.width <= 0) line.width = like.width;
            line.t_offset = each.number_or("tOffset", 0, -kMaxWidth, kMaxWidth);
            line.s_offset = each.number_or("sOffset", 0);
            line.length = each.number_or("length", 0, 0);
            line.space = each.number_or("space", 0, 0);
            if (each.attribute("color")) line.colour = mark_colour(each.text("color"));
            if (holder[0] == 'e') line.once = line.length;
            if (line.space <= 0) line.length = 0;  // solid, however it is cut into pieces
            mark.lines.push_back(line);
        }
}

/// The lines that the type's name means: "solid broken" from the inside outwards, of the centre lane from the left to
/// the right.
void add_named_lines(RoadMark& mark, const MarkLine& like, int lane) {
    std::vector<bool> broken;
    for (size_t at = 0; at < mark.type.size();) {
        const size_t end = std::min(mark.type.find_first_of(" _", at), mark.type.size());
        const std::string word = mark.type.substr(at, end - at);
        if (word == "solid" || word == "edge" || word == "custom" || word == "curb") broken.push_back(false);
        if (word == "broken") broken.push_back(true);
        at = end + 1;
    }
    if (mark.botts_dots) {
        MarkLine dots = like;
        dots.width = 0.1, dots.length = 0.1, dots.space = 0.9;
        mark.lines.push_back(dots);
    }
    for (size_t i = 0; i < broken.size() && i < 2; ++i) {
        MarkLine line = like;
        if (broken[i]) line.length = kDash, line.space = kGap;
        if (broken.size() > 1)
            line.t_offset = ((i == 0) != (lane > 0) ? 1 : -1) * like.width;  // a gap of one width between them
        mark.lines.push_back(line);
    }
}

RoadMark mark_of(OpenDriveReader& reader, const XmlElement& element, double from, int lane) {
    reader.count(element);
    RoadMark mark;
    mark.s = from + element.number_or("sOffset", 0);
    mark.type = element.text_or("type", "none");
    mark.curb = mark.type == "curb";
    mark.botts_dots = mark.type == "botts dots";
    if (mark.type == "none" || mark.type == "grass") return mark;
    MarkLine like;
    like.colour = mark_colour(element.text_or("color", "standard"));
    like.width = element.number_or("width", 0, -100, 100);  // some write -1 where they know none
    if (like.width == 0 && element.attribute("width"))
        reader.note_once(element, "a mark of width 0 has the usual width: 0.12 m, bold 0.25 m");
    if (like.width <= 0) like.width = element.text_or("weight", "") == "bold" ? kBoldWidth : kWidth;
    read_patterns(element, mark, like);
    if (mark.lines.empty() && !mark.curb) add_named_lines(mark, like, lane);
    return mark;
}

void read_heights(OpenDriveReader& reader, const XmlElement& element, RoadLane& lane, double from) {
    for (const XmlElement& each : element.children("height")) {
        reader.count(each);
        lane.heights.push_back({from + each.number_or("sOffset", 0), each.number_or("inner", 0, -100, 100),
                                each.number_or("outer", 0, -100, 100)});
    }
    std::stable_sort(lane.heights.begin(), lane.heights.end(),
                     [](const LaneHeight& a, const LaneHeight& b) { return a.s < b.s; });
}

void read_lane_links(const XmlElement& element, RoadLane& lane) {
    for (const XmlElement& each : element.children_of("link", "predecessor"))
        lane.predecessors.push_back(each.integer("id", -kMaxLaneId, kMaxLaneId));
    for (const XmlElement& each : element.children_of("link", "successor"))
        lane.successors.push_back(each.integer("id", -kMaxLaneId, kMaxLaneId));
}

RoadLane lane_of(OpenDriveReader& reader, const XmlElement& element, double from) {
    reader.count(element);
    RoadLane lane;
    lane.id = element.integer("id", -kMaxLaneId, kMaxLaneId);
    lane.type = lane_type_of(reader, element);
    lane.level = element.flag("level");
    const std::string direction = element.text_or("direction", "standard");
    lane.direction = direction == "reversed" ? LaneDirection::Reversed
                     : direction == "both"   ? LaneDirection::Both
                                             : LaneDirection::Standard;
    if (lane.type == LaneType::Bidirectional) lane.direction = LaneDirection::Both;
    lane.width = profile_of(reader, element, "width", "sOffset", from);
    lane.border = profile_of(reader, element, "border", "sOffset", from);
    if (!lane.width.parts.empty()) lane.border.parts.clear();  // width counts where both are given
    read_heights(reader, element, lane, from);
    read_lane_links(element, lane);
    for (const XmlElement& each : element.children("roadMark"))
        lane.marks.push_back(mark_of(reader, each, from, lane.id));
    std::stable_sort(lane.marks.begin(), lane.marks.end(),
                     [](const RoadMark& a, const RoadMark& b) { return a.s < b.s; });
    for (const XmlElement& each : element.children("speed")) {
        reader.count(each);
        lane.speeds.push_back(limit_of(reader, each, from + each.number_or("sOffset", 0)));
    }
    std::stable_sort(lane.speeds.begin(), lane.speeds.end(),
                     [](const SpeedLimit& a, const SpeedLimit& b) { return a.s < b.s; });
    if (lane.id == 0) lane.width = lane.border = {};
    if (lane.id != 0 && lane.width.parts.empty() && lane.border.parts.empty())
        reader.note(element, "lane " + std::to_string(lane.id) + " has neither width nor border: it has no width");
    return lane;
}

void check_side(const XmlElement& element, const char* side, const RoadLane& lane) {
    const bool fits = side[0] == 'l' ? lane.id > 0 : side[0] == 'r' ? lane.id < 0 : lane.id == 0;
    if (!fits) element.fail("lane " + std::to_string(lane.id) + " cannot be under " + side);
}

/// Ids that are left out, as 2 is in 3, 1, 0: lanes without width are put there, so that every lane lies beside the
/// next.
void fill_gaps(OpenDriveReader& reader, const XmlElement& element, LaneSection& section) {
    for (size_t i = 1; i < section.lanes.size(); ++i) {
        const int gap = section.lanes[i - 1].id - 1;
        if (section.lanes[i].id == gap) continue;
        reader.note_once(element, "lane ids have a gap: lanes of no width are taken to be there");
        reader.count(element);
        const RoadLane &inner = section.lanes[gap > 0 ? i : i - 1], &outer = section.lanes[gap > 0 ? i - 1 : i];
        RoadLane filler;
        filler.id = gap, filler.type = inner.id == 0 ? outer.type : inner.type;
        filler.level = inner.level, filler.border = inner.border, filler.missing = true;
        for (const LaneHeight& each : inner.heights) filler.heights.push_back({each.s, each.outer, each.outer});
        section.lanes.insert(section.lanes.begin() + static_cast<ptrdiff_t>(i), std::move(filler));
    }
}

LaneSection section_of(OpenDriveReader& reader, const XmlElement& element) {
    reader.count(element);
    LaneSection section;
    section.s = element.number_or("s", 0, 0);
    for (const char* side : {"left", "center", "right"})
        for (const XmlElement& each : element.children_of(side, "lane")) {
            section.lanes.push_back(lane_of(reader, each, section.s));
            check_side(each, side, section.lanes.back());
        }
    if (std::none_of(section.lanes.begin(), section.lanes.end(), [](const RoadLane& lane) { return lane.id == 0; }))
        section.lanes.push_back({});
    std::stable_sort(section.lanes.begin(), section.lanes.end(),
                     [](const RoadLane& a, const RoadLane& b) { return a.id > b.id; });
    for (size_t i = 1; i < section.lanes.size(); ++i)
        if (section.lanes[i].id == section.lanes[i - 1].id)
            element.fail("has lane " + std::to_string(section.lanes[i].id) + " twice");
    fill_gaps(reader, element, section);
    return section;
}

/// A section for one side only: the other side goes on as it was.
void keep_other_side(const XmlElement& element, const LaneSection& before, LaneSection& section) {
    if (!element.flag("singleSide")) return;
    const bool left = section.leftmost() > 0, right = section.rightmost() < 0;
    if (left == right) return;
    for (const RoadLane& lane : before.lanes)
        if (left ? lane.id < 0 : lane.id > 0) section.lanes.push_back(lane);
    std::stable_sort(section.lanes.begin(), section.lanes.end(),
                     [](const RoadLane& a, const RoadLane& b) { return a.id > b.id; });
}

/// Links that led to a lane section that is taken away lead on to where its own do.
void link_past(std::vector<RoadLane>& lanes, const LaneSection& gone, std::vector<int> RoadLane::*links) {
    for (RoadLane& lane : lanes) {
        std::set<int> past;
        for (const int id : lane.*links)
            if (const RoadLane* over = gone.find(id)) past.insert((over->*links).begin(), (over->*links).end());
        (lane.*links).assign(past.begin(), past.end());
    }
}

/// Sections too short to build go, and those before and behind them are linked across.
void drop_short_sections(Road& road) {
    std::vector<LaneSection> kept;
    for (size_t i = 0; i < road.sections.size(); ++i) {
        LaneSection& section = road.sections[i];
        const bool last = i + 1 == road.sections.size();
        if (section.end - section.s >= kShortestSection || (last && kept.empty())) {
            kept.push_back(std::move(section));
            continue;
        }
        if (!kept.empty()) link_past(kept.back().lanes, section, &RoadLane::successors), kept.back().end = section.end;
        if (!last) link_past(road.sections[i + 1].lanes, section, &RoadLane::predecessors);
    }
    if (kept.size() == 1 && kept[0].end - kept[0].s < kShortestSection) kept[0].s = 0;
    road.sections = std::move(kept);
}

}  // namespace

MarkColour mark_colour(const std::string& name) {
    static const std::map<std::string, MarkColour> kColours{
        {"yellow", MarkColour::Yellow}, {"red", MarkColour::Red},       {"blue", MarkColour::Blue},
        {"green", MarkColour::Green},   {"orange", MarkColour::Orange}, {"black", MarkColour::Black}};
    const auto found = kColours.find(name);
    return found == kColours.end() ? MarkColour::White : found->second;
}

SpeedLimit limit_of(OpenDriveReader& reader, const XmlElement& element, double s) {
    const std::string value = element.text_or("max", "undefined");
    if (value == "undefined") return {s, 0};
    if (value == "no limit") return {s, INFINITY};
    const std::string units = element.text_or("unit", "m/s");
    const double factor = units == "km/h" ? 1 / 3.6 : units == "mph" ? 0.44704 : units == "m/s" ? 1 : 0;
    if (factor == 0)
        reader.note(element, "the unit '" + units + "' is none of m/s, km/h and mph: the limit is left out");
    return {s, factor * std::max(0.0, element.number("max", -1000, 1000))};  // some write -1 for none
}

void read_lanes(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    const auto holder = element.child("lanes");
    if (!holder || holder->children("laneSection").empty()) {
        reader.note(element, "road '" + road.id + "' has no lanes");
        return;
    }
    road.lane_offset = profile_of(reader, *holder, "laneOffset", "s", 0);
    std::vector<XmlElement> elements = holder->children("laneSection");
    const auto before = [](const XmlElement& a, const XmlElement& b) {
        return a.number_or("s", 0, 0) < b.number_or("s", 0, 0);
    };
    if (!std::is_sorted(elements.begin(), elements.end(), before)) {
        reader.note(*holder, "lane sections are not in ascending order of s: sorted");
        std::stable_sort(elements.begin(), elements.end(), before);
    }
    for (const XmlElement& each : elements) {
        LaneSection section = section_of(reader, each);
        if (section.s >= road.length && !road.sections.empty()) {
            reader.note(each, "begins behind the end of road '" + road.id + "': left out");
            continue;
        }
        if (!road.sections.empty() && section.s - road.sections.back().s < kShortestSection)
            reader.note(each, "begins where the lane section before it does: that one is left out");
        if (!road.sections.empty()) keep_other_side(each, road.sections.back(), section);
        road.sections.push_back(std::move(section));
    }
    if (road.sections.front().s > 0) {
        reader.note(*holder, "the first lane section of road '" + road.id +
                                 "' begins at s = " + std::to_string(road.sections.front().s) + ": it is taken from 0");
        road.sections.front().s = 0;
    }
    for (size_t i = 0; i < road.sections.size(); ++i)
        road.sections[i].end = i + 1 < road.sections.size() ? road.sections[i + 1].s : road.length;
    drop_short_sections(road);
}

}  // namespace vesper::roads
