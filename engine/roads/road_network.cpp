// Small questions to a road network. SPDX-License-Identifier: MIT
#include "roads/road_network.h"

#include <algorithm>

namespace vesper::roads {

const Cubic* Profile::part_at(double s) const {
    const auto after =
        std::upper_bound(parts.begin(), parts.end(), s, [](double at, const Cubic& part) { return at < part.s; });
    return after == parts.begin() ? nullptr : &*(after - 1);
}

double Profile::at(double s) const {
    const Cubic* part = part_at(s);
    return part ? part->at(s) : 0;
}

double Profile::slope(double s) const {
    const Cubic* part = part_at(s);
    return part ? part->slope(s) : 0;
}

const char* name_of(LaneType type) {
    switch (type) {
        case LaneType::None:
            return "none";
        case LaneType::Driving:
            return "driving";
        case LaneType::Stop:
            return "stop";
        case LaneType::Shoulder:
            return "shoulder";
        case LaneType::Biking:
            return "biking";
        case LaneType::Sidewalk:
            return "sidewalk";
        case LaneType::Border:
            return "border";
        case LaneType::Restricted:
            return "restricted";
        case LaneType::Parking:
            return "parking";
        case LaneType::Median:
            return "median";
        case LaneType::Curb:
            return "curb";
        case LaneType::Entry:
            return "entry";
        case LaneType::Exit:
            return "exit";
        case LaneType::Ramp:
            return "ramp";
        case LaneType::Bidirectional:
            return "bidirectional";
        case LaneType::Rail:
            return "rail";
        case LaneType::Other:
            break;
    }
    return "other";
}

bool is_driven(LaneType type) {
    return type == LaneType::Driving || type == LaneType::Entry || type == LaneType::Exit || type == LaneType::Ramp ||
           type == LaneType::Bidirectional;
}

bool is_level_with_road(LaneType type) {
    return is_driven(type) || type == LaneType::Stop || type == LaneType::Shoulder || type == LaneType::Border ||
           type == LaneType::Parking || type == LaneType::Biking || type == LaneType::Restricted ||
           type == LaneType::Rail;
}

const RoadLane* LaneSection::find(int id) const {
    // Ids descend without gaps in every file that follows the rules; others are searched.
    const auto guess = static_cast<size_t>(std::max(lanes.front().id - id, 0));
    if (guess < lanes.size() && lanes[guess].id == id) return &lanes[guess];
    const auto found = std::find_if(lanes.begin(), lanes.end(), [&](const RoadLane& lane) { return lane.id == id; });
    return found == lanes.end() ? nullptr : &*found;
}

size_t Road::section_at(double s) const {
    const auto after = std::upper_bound(sections.begin(), sections.end(), s,
                                        [](double at, const LaneSection& each) { return at < each.s; });
    return after == sections.begin() ? 0 : static_cast<size_t>(after - sections.begin()) - 1;
}

}  // namespace vesper::roads
