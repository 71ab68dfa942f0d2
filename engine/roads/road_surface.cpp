// Points on roads. SPDX-License-Identifier: MIT
#include "roads/road_surface.h"

#include <algorithm>
#include <cmath>

#include "base/budget.h"

namespace vesper::roads {
namespace {

const PlanGeometry& geometry_at(const Road& road, double s) {
    const auto after = std::upper_bound(road.plan.begin(), road.plan.end(), s,
                                        [](double at, const PlanGeometry& g) { return at < g.s; });
    return after == road.plan.begin() ? road.plan.front() : *(after - 1);
}

double over(const std::vector<Cubic>& parts, double t) {
    const auto after =
        std::upper_bound(parts.begin(), parts.end(), t, [](double at, const Cubic& part) { return at < part.s; });
    return after == parts.begin() ? parts.front().at(parts.front().s) : (after - 1)->at(t);
}

double strip_height(const Road& road, double s, double t) {
    const double from_middle = t - road.strips_offset.at(s), side = from_middle < 0 ? -1 : 1;
    double left = std::abs(from_middle), height = 0;
    for (const SurfaceStrip& strip : road.strips) {
        if ((strip.id > 0) != (side > 0)) continue;
        const double width = strip.width.parts.empty() ? left : std::clamp(strip.width.at(s), 0.0, left),
                     u = side * width;
        height = (strip.relative ? height : 0) + strip.constant.at(s) +
                 u * (strip.linear.at(s) + u * (strip.quadratic.at(s) + u * strip.cubic.at(s)));
        left -= width;
        if (left <= 0) break;
    }
    return height;
}

bool is_curved_across(const Road& road) {
    return !road.shapes.empty() || !road.strips.empty() || !road.crossfall_left.parts.empty() ||
           !road.crossfall_right.parts.empty();
}

/// Height of crossfall, strips and shape above the tilted plane.
double lateral_height(const Road& road, double s, double t) {
    double height = road.strips.empty() ? 0 : strip_height(road, s, t);
    if (t > 0 && !road.crossfall_left.parts.empty()) height -= t * std::tan(road.crossfall_left.at(s));
    if (t < 0 && !road.crossfall_right.parts.empty()) height += t * std::tan(road.crossfall_right.at(s));
    if (road.shapes.empty()) return height;
    const auto after = std::upper_bound(road.shapes.begin(), road.shapes.end(), s,
                                        [](double at, const RoadShape& shape) { return at < shape.s; });
    if (after == road.shapes.begin()) return height + over(after->parts, t);
    const RoadShape& before = *(after - 1);
    if (after == road.shapes.end()) return height + over(before.parts, t);
    const double f = (s - before.s) / (after->s - before.s);
    return height + over(before.parts, t) * (1 - f) + over(after->parts, t) * f;
}

void turn_across(RoadPoint& point, double angle) {
    const glm::dvec3 left = point.left * std::cos(angle) + point.up * std::sin(angle);
    point.left = left;
    point.up = glm::cross(point.forward, left);
}

double clamped_width(const LaneSection& section, const RoadLane& lane, double s, double inner) {
    // A border is where it is, unless an inner lane's lies further out.
    const double sign = lane.id > 0 ? 1 : -1;
    if (!lane.border.parts.empty()) return std::max(0.0, sign * (lane.border.at(s) - inner));
    return std::max(0.0, stated_width(section, lane, s));
}

void add_breaks(std::vector<double>& breaks, const Profile& profile) {
    for (const Cubic& part : profile.parts) breaks.push_back(part.s);
}

}  // namespace

RoadPoint reference_point(const Road& road, double s) {
    check_time();
    const PlanGeometry& g = geometry_at(road, s);
    const PlanPoint plan = plan_point(g, s - g.s);
    RoadPoint point;
    point.position = {plan.x, plan.y, road.elevation.at(s)};
    point.heading = plan.heading;
    point.curvature = plan.curvature;
    const double climb = road.elevation.slope(s);
    point.forward = glm::normalize(glm::dvec3(std::cos(plan.heading), std::sin(plan.heading), climb));
    point.left = {-std::sin(plan.heading), std::cos(plan.heading), 0};
    point.up = glm::cross(point.forward, point.left);
    return point;
}

RoadPoint surface_point(const Road& road, double s, double t, double height) {
    RoadPoint point = reference_point(road, s);
    turn_across(point, road.superelevation.at(s));
    point.position += point.left * t + point.up * (height + lateral_height(road, s, t));
    if (is_curved_across(road)) {
        constexpr double kStep = 0.05;
        turn_across(point,
                    std::atan((lateral_height(road, s, t + kStep) - lateral_height(road, s, t - kStep)) / (2 * kStep)));
    }
    return point;
}

double stated_width(const LaneSection& section, const RoadLane& lane, double s) {
    if (lane.border.parts.empty()) return lane.width.at(s);
    const double sign = lane.id > 0 ? 1 : -1;
    const RoadLane* inner = std::abs(lane.id) > 1 ? section.find(lane.id - static_cast<int>(sign)) : nullptr;
    return sign * (lane.border.at(s) - (inner && !inner->border.parts.empty() ? inner->border.at(s) : 0));
}

double lane_border(const Road& road, const LaneSection& section, int id, double s) {
    const double sign = id > 0 ? 1 : -1;
    double t = 0;
    for (int each = 1; each <= std::abs(id); ++each)
        if (const RoadLane* lane = section.find(static_cast<int>(sign) * each))
            t += sign * clamped_width(section, *lane, s, t);
    // A step of the offset where the next section begins is not this one's.
    return road.lane_offset.at(std::min(s, section.end - 1e-9)) + t;
}

double lane_height(const RoadLane& lane, double s, double fraction) {
    const auto after = std::upper_bound(lane.heights.begin(), lane.heights.end(), s,
                                        [](double at, const LaneHeight& each) { return at < each.s; });
    if (after == lane.heights.begin()) return 0;
    const LaneHeight& height = *(after - 1);
    return height.inner + (height.outer - height.inner) * fraction;
}

RoadPoint lane_point(const Road& road, const LaneSection& section, int id, double s, double fraction) {
    if (id == 0) return surface_point(road, s, lane_border(road, section, 0, s));
    const double outer = lane_border(road, section, id, s),
                 inner = lane_border(road, section, id > 0 ? id - 1 : id + 1, s);
    const double t = inner + (outer - inner) * fraction;
    const RoadLane& lane = *section.find(id);
    const double height = lane_height(lane, s, fraction);
    if (!lane.level) return surface_point(road, s, t, height);
    // Level from the outermost tilted border on: z stays.
    int edge = id;
    while (edge != 0 && section.find(edge) && section.find(edge)->level) edge += id > 0 ? -1 : 1;
    const double from = lane_border(road, section, edge, s);
    RoadPoint point = surface_point(road, s, from);
    point.left = glm::normalize(glm::dvec3(point.left.x, point.left.y, 0));
    point.up = glm::normalize(glm::cross(point.forward, point.left));
    point.position += point.left * (t - from) + glm::dvec3(0, 0, height);
    return point;
}

std::vector<double> road_stations(const Road& road, const LaneSection& section, double chord, double longest) {
    std::vector<double> breaks{section.s, section.end};
    for (const PlanGeometry& g : road.plan) breaks.push_back(g.s);
    for (const Profile* profile :
         {&road.elevation, &road.superelevation, &road.lane_offset, &road.crossfall_left, &road.crossfall_right})
        add_breaks(breaks, *profile);
    for (const RoadShape& shape : road.shapes) breaks.push_back(shape.s);
    for (const SurfaceStrip& strip : road.strips)
        for (const Profile* profile : {&strip.width, &strip.constant, &strip.linear, &strip.quadratic, &strip.cubic})
            add_breaks(breaks, *profile);
    for (const RoadLane& lane : section.lanes) {
        add_breaks(breaks, lane.width);
        add_breaks(breaks, lane.border);
        for (const LaneHeight& height : lane.heights) breaks.push_back(height.s);
        for (const RoadMark& mark : lane.marks) breaks.push_back(mark.s);
    }
    std::erase_if(breaks, [&](double s) { return s < section.s || s > section.end; });
    std::sort(breaks.begin(), breaks.end());

    // The borders of all lanes, from the middle outwards on either side.
    const auto lines = [&](double s) {
        const double middle = lane_border(road, section, 0, s);
        std::vector<glm::dvec3> points{surface_point(road, s, middle).position};
        for (const int side : {1, -1}) {
            double t = 0;
            for (int id = side; const RoadLane* lane = section.find(id); id += side) {
                t += side * clamped_width(section, *lane, s, t);
                points.push_back(surface_point(road, s, middle + t).position);
            }
        }
        return points;
    };
    const auto leaves_chord = [&](double a, double b) {
        const auto first = lines(a), last = lines(b);
        for (const double f : {0.25, 0.5, 0.75}) {
            const auto middle = lines(a + (b - a) * f);
            for (size_t i = 0; i < middle.size(); ++i) {
                // From the chord, not from the point at f: what lies unevenly along a line does not matter.
                const glm::dvec3 along = last[i] - first[i], to = middle[i] - first[i];
                const double length = glm::dot(along, along);
                if (glm::distance(to, length > 0 ? along * (glm::dot(to, along) / length) : glm::dvec3(0)) > chord)
                    return true;
            }
        }
        return false;
    };
    std::vector<double> stations{section.s};
    const auto divide = [&](const auto& self, double a, double b, int depth) -> void {
        if (b - a > longest || (depth < 16 && b - a > 0.05 && leaves_chord(a, b))) {
            self(self, a, (a + b) / 2, depth + 1);
            self(self, (a + b) / 2, b, depth + 1);
        } else {
            stations.push_back(b);
        }
    };
    for (size_t i = 1; i < breaks.size(); ++i) {
        // Two stations closer than this would make slivers; the later one is moved.
        if (breaks[i] - stations.back() > 1e-6) divide(divide, stations.back(), breaks[i], 0);
    }
    stations.back() = section.end;
    return stations;
}

}  // namespace vesper::roads
