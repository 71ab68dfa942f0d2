// Positions and distances of a storyboard. SPDX-License-Identifier: MIT
#include "roads/storyboard_places.h"

#include <algorithm>
#include <cmath>

#include "roads/road_surface.h"

namespace vesper::roads {
namespace {

/// m between two boxes along a direction, 0 where they overlap; negative where `to` lies against it.
double gap_along(glm::dvec2 direction, const StoryBox& from, const StoryBox& to) {
    const auto reach = [&](const StoryBox& box) {
        return box.half.x * std::abs(glm::dot(box.ahead, direction)) +
               box.half.y * std::abs(glm::dot(box.left(), direction));
    };
    const double apart = glm::dot(to.centre - from.centre, direction);
    return std::copysign(std::max(0.0, std::abs(apart) - reach(from) - reach(to)), apart);
}

/// m from the corners of one box to another.
double from_corners(const StoryBox& corners, const StoryBox& box) {
    double least = HUGE_VAL;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) {
            const glm::dvec2 corner =
                corners.centre + corners.ahead * (x * corners.half.x) + corners.left() * (y * corners.half.y);
            const glm::dvec2 from = corner - box.centre;
            least = std::min(least, std::hypot(std::max(0.0, std::abs(glm::dot(from, box.ahead)) - box.half.x),
                                               std::max(0.0, std::abs(glm::dot(from, box.left())) - box.half.y)));
        }
    return least;
}

double free_distance(const StoryBox& a, const StoryBox& b) {
    for (const glm::dvec2 axis : {a.ahead, a.left(), b.ahead, b.left()})
        if (gap_along(axis, a, b) != 0) return std::min(from_corners(a, b), from_corners(b, a));
    return 0;
}

}  // namespace

StoryBox StoryBox::of(const RunEntity& entity, double time) {
    const RunPose pose = pose_at(entity, time);
    StoryBox made;
    made.reference = glm::dvec2(pose.position);
    made.ahead = {std::cos(pose.heading), std::sin(pose.heading)};
    made.centre = made.reference + made.ahead * entity.centre.x + made.left() * entity.centre.y;
    made.half = {entity.length / 2, entity.width / 2};
    made.speed = pose.speed;
    return made;
}

StoryBox StoryBox::of(glm::dvec3 point) {
    StoryBox made;
    made.reference = made.centre = glm::dvec2(point);
    return made;
}

double Measure::distance(const StoryBox& from, const StoryBox& to) const {
    const auto part = [&](glm::dvec2 direction) {
        return free_space ? gap_along(direction, from, to) : glm::dot(to.reference - from.reference, direction);
    };
    if (along == Along::Lateral) return part(from.left());
    const double ahead = part(from.ahead);
    if (along == Along::Longitudinal) return ahead;
    return std::copysign(free_space ? free_distance(from, to) : glm::distance(from.reference, to.reference), ahead);
}

Measure measure_of(const XmlElement& element, const Parameters& scope, StoryTime& story,
                   std::optional<Measure::Along> fixed) {
    Measure measure{.free_space = flag_in(element, "freespace", scope)};
    const std::string type = resolved(element, "relativeDistanceType", scope).value_or("euclidianDistance"),
                      frame = resolved(element, "coordinateSystem", scope).value_or("entity");
    if (fixed)
        measure.along = *fixed;
    else if (type == "longitudinal")
        measure.along = Measure::Along::Longitudinal;
    else if (type == "lateral")
        measure.along = Measure::Along::Lateral;
    else if (type != "euclidianDistance" && type != "cartesianDistance")
        story.note(element.place() + ": relativeDistanceType '" + type + "' is none: the straight distance counts");
    // Ways over the roads are not known; a straight line is nearer to them than how far ahead something is.
    const bool over_roads = frame == "road" || frame == "lane";
    if (over_roads && measure.along == Measure::Along::Longitudinal && !fixed) measure.along = Measure::Along::Straight;
    if (frame != "entity" && type != "euclidianDistance" && type != "cartesianDistance")
        story.note(element.place() + ": a distance in the " + frame + " is measured " +
                   (measure.along == Measure::Along::Straight ? "straight" : "by the entity's heading"));
    return measure;
}

std::optional<glm::dvec3> position_of(const XmlElement& element, const Parameters& scope, const StoryTime& story) {
    const auto inside = element.child("Position");
    const XmlElement& holder = inside ? *inside : element;
    if (const auto world = holder.child("WorldPosition"))
        return glm::dvec3{number_in(*world, "x", scope, 0), number_in(*world, "y", scope, 0),
                          number_in(*world, "z", scope, 0)};
    const auto lane = holder.child("LanePosition"), on_road = holder.child("RoadPosition");
    const auto& place = lane ? lane : on_road;
    if (!place) return std::nullopt;
    const auto found = story.road_by_id.find(resolved(*place, "roadId", scope).value_or(""));
    if (found == story.road_by_id.end() || found->second->sections.empty()) return std::nullopt;
    const Road& road = *found->second;
    const double s = std::clamp(number_in(*place, "s", scope, 0), 0.0, road.length);
    if (!lane) return surface_point(road, s, number_in(*place, "t", scope, 0)).position;
    const LaneSection& section = road.sections[road.section_at(s)];
    const int number = static_cast<int>(number_in(*place, "laneId", scope, 0));
    if (!section.find(number)) return std::nullopt;
    const RoadPoint point = lane_point(road, section, number, s, 0.5);
    return point.position + point.left * number_in(*place, "offset", scope, 0);
}

}  // namespace vesper::roads
