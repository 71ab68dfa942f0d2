// Objects and signals of OpenDRIVE roads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/one_line.h"
#include "roads/opendrive_reader.h"

namespace vesper::roads {
namespace {

constexpr double kMaxSize = 1e4;                            // m, of one object
constexpr double kBeyond = 0.01;                            // m beyond the ends of a road: rounding
constexpr double kMarkingWidth = 0.1, kBoldMarking = 0.25;  // m, of lines whose width is not stated
constexpr size_t kMaxCorners = 1000;

char orientation_of(const XmlElement& element) {
    const std::string text = element.text_or("orientation", "none");
    return text == "+" || text == "-" ? text[0] : '0';
}

/// Sizes below 0 or as if not stated are 0.
double size_of(const XmlElement& element, const char* name) {
    return std::max(0.0, element.number_or(name, 0, -kMaxNumber, kMaxSize));
}

ObjectCorner corner_of(const XmlElement& element, int index) {
    ObjectCorner corner;
    corner.local = element.name() == "cornerLocal";
    corner.id = element.attribute("id") ? element.integer("id", -1'000'000'000, 1'000'000'000) : index;
    corner.u = element.number(corner.local ? "u" : "s"), corner.v = element.number(corner.local ? "v" : "t");
    corner.z = element.number_or(corner.local ? "z" : "dz", 0, -kMaxSize, kMaxSize);
    corner.height = size_of(element, "height");
    return corner;
}

void read_outline(OpenDriveReader& reader, const XmlElement& element, RoadObject& object) {
    ObjectOutline outline;
    outline.closed = element.text_or("closed", "true") != "false";
    for (const XmlElement& each : element.children()) {
        if (each.name() != "cornerLocal" && each.name() != "cornerRoad") continue;
        reader.count(each);
        outline.corners.push_back(corner_of(each, static_cast<int>(outline.corners.size())));
    }
    if (outline.corners.size() > kMaxCorners)
        element.fail("an outline of more than " + std::to_string(kMaxCorners) + " corners");
    if (outline.corners.size() < 2) return reader.note(element, "an outline of fewer than two corners: left out");
    object.outlines.push_back(std::move(outline));
}

void read_markings(OpenDriveReader& reader, const XmlElement& element, RoadObject& object) {
    for (const XmlElement& each : element.children_of("markings", "marking")) {
        reader.count(each);
        ObjectMarking marking;
        marking.width = each.number_or("width", kMarkingWidth, -100, 100);
        if (marking.width <= 0) {
            marking.width = each.text_or("weight", "") == "bold" ? kBoldMarking : kMarkingWidth;
            reader.note_once(each, "a marking of width 0 has the usual width: 0.1 m, bold 0.25 m");
        }
        marking.z_offset = each.number_or("zOffset", 0.005, -10, 10);
        marking.line_length = each.number_or("lineLength", 0, 0, kMaxSize),
        marking.space_length = each.number_or("spaceLength", 0, 0, kMaxSize);
        marking.start_offset = each.number_or("startOffset", 0, -kMaxSize, kMaxSize),
        marking.stop_offset = each.number_or("stopOffset", 0, -kMaxSize, kMaxSize);
        marking.colour = mark_colour(each.text_or("color", "white"));
        marking.side = each.text_or("side", "");
        for (const XmlElement& corner : each.children("cornerReference"))
            marking.corners.push_back(corner.integer("id", -1'000'000'000, 1'000'000'000));
        object.markings.push_back(std::move(marking));
    }
}

ObjectRepeat repeat_of(const XmlElement& element, const RoadObject& object) {
    ObjectRepeat repeat;
    repeat.s = element.number_or("s", object.s);
    repeat.length = element.number_or("length", 0, 0, 1e6);
    repeat.distance = element.number_or("distance", 0, 0);
    repeat.t_start = element.number_or("tStart", object.t), repeat.t_end = element.number_or("tEnd", repeat.t_start);
    repeat.z_start = element.number_or("zOffsetStart", object.z_offset, -kMaxSize, kMaxSize);
    repeat.z_end = element.number_or("zOffsetEnd", repeat.z_start, -kMaxSize, kMaxSize);
    const auto optional = [&](const char* name) {
        return element.attribute(name) ? std::optional(size_of(element, name)) : std::nullopt;
    };
    repeat.height_start = optional("heightStart"), repeat.height_end = optional("heightEnd");
    repeat.width_start = optional("widthStart"), repeat.width_end = optional("widthEnd");
    repeat.length_start = optional("lengthStart"), repeat.length_end = optional("lengthEnd");
    repeat.radius_start = optional("radiusStart"), repeat.radius_end = optional("radiusEnd");
    return repeat;
}

bool has_place(OpenDriveReader& reader, const XmlElement& element) {
    if (element.attribute("s") && element.attribute("t")) return true;
    reader.note(element, "has no s and t: left out");
    return false;
}

void check_on_road(OpenDriveReader& reader, const XmlElement& element, const Road& road) {
    if (const double s = element.number("s"); s < -kBeyond || s > road.length + kBeyond)
        reader.note(element, "s = " + std::to_string(s) + " is not on road '" + road.id + "', which is " +
                                 std::to_string(road.length) + " m long: put where it would go on straight");
}

/// Where a signal stands, if that is not where it counts: the road, and what gives the signal's place along it.
std::pair<Road*, XmlElement> place_of(OpenDriveReader& reader, const XmlElement& element, Road& road,
                                      RoadSignal& signal) {
    if (const auto each = element.child("positionInertial"))
        reader.note(*each, "is not read: the signal is put at its s and t");
    const auto each = element.child("positionRoad");
    if (!each) return {&road, element};
    const auto found = reader.roads.find(each->text_or("roadId", ""));
    if (found == reader.roads.end()) {
        reader.note(*each, "there is no road '" + each->text_or("roadId", "") + "': the signal is put at its s and t");
        return {&road, element};
    }
    Road& other = reader.network.roads[found->second];
    if (!each->attribute("s") || !each->attribute("t")) {
        reader.note(*each, "has no s and t: the signal is put at its own");
        return {&road, element};
    }
    signal.s = each->number("s"), signal.t = each->number("t");
    signal.z_offset = each->number_or("zOffset", 0, -kMaxSize, kMaxSize);
    signal.heading = each->number_or("hOffset", 0), signal.pitch = each->number_or("pitch", 0),
    signal.roll = each->number_or("roll", 0);
    return {&other, *each};
}

/// Speed limit signs state theirs in value and unit; countries without a unit mean km/h, some write it into the
/// subtype.
void read_value(const XmlElement& element, RoadSignal& signal) {
    if (!element.attribute("value")) return;
    const std::string text = element.text("value");
    if (text.find_first_not_of("+-.0123456789eE") != text.npos) {
        signal.text = signal.text.empty() ? text : signal.text;
        return;
    }
    signal.value = element.number("value");
    signal.unit = element.text_or("unit", "");
}

}  // namespace

void read_objects(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    for (const XmlElement& each : element.children_of("objects", "object")) {
        reader.count(each);
        if (!has_place(reader, each)) continue;
        check_on_road(reader, each, road);
        RoadObject object;
        object.id = each.text_or("id", ""), object.name = one_line(each.text_or("name", ""), 80);
        object.type = each.text_or("type", "none"), object.subtype = each.text_or("subtype", "");
        object.s = each.number("s"), object.t = each.number("t");
        object.z_offset = each.number_or("zOffset", 0, -kMaxSize, kMaxSize);
        object.heading = each.number_or("hdg", 0), object.pitch = each.number_or("pitch", 0),
        object.roll = each.number_or("roll", 0);
        object.orientation = orientation_of(each);
        object.length = size_of(each, "length"), object.width = size_of(each, "width");
        object.height = size_of(each, "height"), object.radius = size_of(each, "radius");
        for (const XmlElement& repeat : each.children("repeat")) {
            reader.count(repeat);
            object.repeats.push_back(repeat_of(repeat, object));
        }
        for (const XmlElement& outline : each.children("outline")) read_outline(reader, outline, object);
        for (const XmlElement& outline : each.children_of("outlines", "outline")) read_outline(reader, outline, object);
        read_markings(reader, each, object);
        road.objects.push_back(std::move(object));
    }
    // Bridges and tunnels say what a stretch is; what they look like is in other files.
    if (const auto objects = element.child("objects"))
        for (const char* name : {"tunnel", "bridge"})
            if (const auto each = objects->child(name)) reader.note_once(*each, std::string(name) + "s are not built");
}

void read_controllers(OpenDriveReader& reader, const XmlElement& root) {
    for (const XmlElement& each : root.children("controller")) {
        reader.count(each);
        SignalController controller{each.text_or("id", ""), {}};
        for (const XmlElement& control : each.children("control")) {
            reader.count(control);
            controller.signals.push_back(control.text_or("signalId", ""));
        }
        reader.network.controllers.push_back(std::move(controller));
    }
}

void read_signals(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    for (const XmlElement& each : element.children_of("signals", "signalReference")) {
        reader.count(each);
        road.signal_references.push_back(each.text_or("id", ""));
    }
    for (const XmlElement& each : element.children_of("signals", "signal")) {
        reader.count(each);
        if (!has_place(reader, each)) continue;
        RoadSignal signal;
        signal.id = each.text_or("id", ""), signal.name = one_line(each.text_or("name", ""), 80);
        signal.type = each.text_or("type", "-1"), signal.subtype = each.text_or("subtype", "-1");
        signal.country = each.text_or("country", ""), signal.text = one_line(each.text_or("text", ""), 80);
        read_value(each, signal);
        signal.dynamic = each.flag("dynamic");
        signal.s = each.number("s"), signal.t = each.number("t");
        signal.z_offset = each.number_or("zOffset", 0, -kMaxSize, kMaxSize);
        signal.heading = each.number_or("hOffset", 0), signal.pitch = each.number_or("pitch", 0),
        signal.roll = each.number_or("roll", 0);
        signal.orientation = orientation_of(each);
        signal.width = size_of(each, "width"), signal.height = size_of(each, "height");
        const double counts_at = signal.s;
        const auto [stands_on, where] = place_of(reader, each, road, signal);
        check_on_road(reader, where, *stands_on);
        if (stands_on != &road) {
            signal.counts_on = static_cast<uint32_t>(&road - reader.network.roads.data());
            signal.counts_at = counts_at;
        }
        stands_on->signals.push_back(std::move(signal));
    }
}

}  // namespace vesper::roads
