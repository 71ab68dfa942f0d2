// How long actions on the motion take, as esmini has it, judged by the recorded run. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "roads/lanes.h"
#include "roads/road_surface.h"
#include "roads/storyboard_actions.h"
#include "roads/storyboard_places.h"

namespace vesper::roads {
namespace {

constexpr double kStands = 1e-6;       // m/s
constexpr size_t kLaneQuestions = 50;  // a look for a lane takes so much longer than other questions

/// Where an entity is on its lane; t and offset to the left of the road.
struct OnLane {
    const Road* road;
    const LaneSection* section;
    int id;
    double s, offset;
    bool forwards;  ///< it looks along the road

    double centre(int lane) const {
        return (lane_border(*road, *section, lane, s) + lane_border(*road, *section, lane - (lane > 0 ? 1 : -1), s)) /
               2;
    }
    double t() const { return centre(id) + offset; }
};

/// What passes until something is done.
struct MotionTimes {
    StoryTime& story;

    Progress after(double end) const {
        return [end, &s = story](int step) { return s.at(step) >= end - 1e-6; };
    }
    static Progress never() {
        return [](int) { return false; };
    }
    /// Done when what `gain` adds over the steps is as much as wanted.
    Progress gathering(double wanted, int from, std::function<double(int step)> gain) const {
        return [wanted, gain, sum = 0.0, last = from](int step) mutable {
            while (last < step) sum += gain(++last);
            return sum >= wanted - 1e-6;
        };
    }
    Progress along_way(const RunEntity& actor, double length, int from) const {
        return gathering(length, from, [&actor, &s = story](int step) {
            return glm::distance(pose_at(actor, s.at(step)).position, pose_at(actor, s.at(step - 1)).position);
        });
    }
    Progress while_moving(const RunEntity& actor, double seconds, int from) const {
        return gathering(seconds, from, [&actor, &s = story](int step) {
            return std::abs(pose_at(actor, s.at(step)).speed) > kStands ? s.at(step) - s.at(step - 1) : 0.0;
        });
    }

    std::optional<OnLane> lane_of(const RunEntity& entity, double time) const {
        const RunPose pose = pose_at(entity, time);
        const glm::dvec3 ahead{std::cos(pose.heading), std::sin(pose.heading), 0};
        const auto place =
            story.lanes->nearest_along(story.roads->to_world(pose.position), RoadNetwork::direction_to_world(ahead));
        if (!place) return std::nullopt;
        const Lane& lane = story.lanes->lanes()[place->lane];
        const Road& road = story.roads->roads[lane.road];
        const LaneSection& section = road.sections[lane.section];
        const double part = std::clamp(place->along / lane.length, 0.0, 1.0) * (section.end - section.s);
        OnLane found{&road,
                     &section,
                     lane.id,
                     lane.forwards ? section.s + part : section.end - part,
                     lane.forwards ? place->offset : -place->offset,
                     true};
        found.forwards = glm::dot(reference_point(road, found.s).forward, ahead) > 0;
        return found;
    }
    Progress lost(const std::string& place) const {
        story.note(place + ": its lanes are not found, nor its end: it does not end");
        return never();
    }
};

struct MotionReader : MotionTimes {
    const Parameters& scope;
    using Each = decltype(StoryAction::each);

    Each unknown(const XmlElement& action) const {
        story.note(action.place() + ": its end is not known: it does not end");
        return [](RunEntity&, int) { return never(); };
    }

    /// How fast a transition is at its fastest, to how fast it is on average.
    static double peak_of(const std::string& shape) {
        return shape == "sinusoidal" ? std::numbers::pi / 2 : shape == "cubic" ? 1.5 : 1;
    }

    Each speed(const XmlElement& action) const {
        const auto dynamics = action.child("SpeedActionDynamics"), target = action.child("SpeedActionTarget");
        const auto absolute = target ? target->child("AbsoluteTargetSpeed") : std::nullopt,
                   relative = target ? target->child("RelativeTargetSpeed") : std::nullopt;
        if (!dynamics || (!absolute && !relative)) return unknown(action);
        const std::string shape = resolved(*dynamics, "dynamicsShape", scope).value_or(""),
                          dimension = resolved(*dynamics, "dynamicsDimension", scope).value_or("time");
        const double value = std::abs(number_in(*dynamics, "value", scope, 0)),
                     stated = number_in(absolute ? *absolute : *relative, "value", scope, 0);
        const RunEntity* other = relative ? story.one_of(*relative, "entityRef", scope) : nullptr;
        if (relative && !other) return unknown(action);
        if (relative && flag_in(*relative, "continuous", scope)) return [](RunEntity&, int) { return never(); };
        const bool factor =
            relative && resolved(*relative, "speedTargetValueType", scope).value_or("delta") == "factor";
        return [=, times = MotionTimes(*this)](RunEntity& actor, int step) -> Progress {
            const double now = times.story.at(step), from = pose_at(actor, now).speed,
                         others = other ? pose_at(*other, now).speed : 0;
            const double to = factor ? others * stated : others + stated, change = std::abs(to - from);
            const double most = to > from ? actor.acceleration : actor.deceleration, peak = peak_of(shape);
            double seconds = 0;
            if (shape == "step" || (dimension == "distance" && change < kStands))
                seconds = 0;
            else if (dimension == "rate")
                seconds = value > 0 ? peak * change / value : 0;
            else if (dimension == "distance")  // speed is linear in time; one that changes its sign passes 0
                seconds = from * to < 0 ? 2 * value * (std::abs(from) + std::abs(to)) / (from * from + to * to)
                                        : 2 * value / std::abs(from + to);
            else
                seconds = value;
            // As esmini does: a vehicle takes as long as its strongest acceleration asks for.
            if (most > 0 && shape != "step") seconds = std::max(seconds, peak * change / most);
            return seconds > 0 ? times.after(now + seconds) : Progress{};
        };
    }
    Each profile(const XmlElement& action) const {
        std::vector<std::pair<double, double>> entries;  // s since the one before, m/s
        for (const XmlElement& each : action.children("SpeedProfileEntry")) {
            if (!each.attribute("time")) return unknown(action);
            entries.emplace_back(number_in(each, "time", scope, 0), number_in(each, "speed", scope, 0));
        }
        const auto limits = action.child("DynamicConstraints");
        const double most = limits ? number_in(*limits, "maxAcceleration", scope, 0) : 0,
                     least = limits ? number_in(*limits, "maxDeceleration", scope, 0) : 0;
        const bool relative = action.child("EntityRef").has_value();
        return [entries, most, least, relative, times = MotionTimes(*this)](RunEntity& actor, int step) -> Progress {
            const double now = times.story.at(step);
            double seconds = 0, speed = pose_at(actor, now).speed;
            const double up = most > 0 ? most : actor.acceleration, down = least > 0 ? least : actor.deceleration;
            for (const auto& [time, to] : entries) {
                const double limit = to > speed ? up : down;
                seconds += limit > 0 && !relative && time > 0 ? std::max(time, std::abs(to - speed) / limit) : time;
                speed = to;
            }
            return seconds > 0 ? times.after(now + seconds) : Progress{};
        };
    }

    Each distance(const XmlElement& action, bool lateral) const {
        const RunEntity* other = story.one_of(action, "entityRef", scope);
        const bool gap = action.attribute("timeGap").has_value();
        if (!other || (!gap && !action.attribute("distance"))) return unknown(action);
        if (flag_in(action, "continuous", scope)) return [](RunEntity&, int) { return never(); };
        const Measure measure =
            measure_of(action, scope, story, lateral ? Measure::Along::Lateral : Measure::Along::Longitudinal);
        const double wanted = std::abs(number_in(action, gap ? "timeGap" : "distance", scope, 0));
        const double close = lateral ? 0.01 : 0.1;  // m, esmini's
        return [=, &s = story](RunEntity& actor, int) -> Progress {
            return [=, &s, &actor](int step) {
                const StoryBox to = StoryBox::of(*other, s.at(step));
                const double apart = std::abs(measure.distance(StoryBox::of(actor, s.at(step)), to));
                return std::abs(apart - (gap ? wanted * std::abs(to.speed) : wanted)) < close;
            };
        };
    }

    Each lane_change(const XmlElement& action) const {
        const auto dynamics = action.child("LaneChangeActionDynamics"), target = action.child("LaneChangeTarget");
        if (!dynamics) return unknown(action);
        const std::string shape = resolved(*dynamics, "dynamicsShape", scope).value_or(""),
                          dimension = resolved(*dynamics, "dynamicsDimension", scope).value_or("time");
        const double value = std::abs(number_in(*dynamics, "value", scope, 0));
        if (shape == "step" || value == 0) return [](RunEntity&, int) { return Progress{}; };
        if (dimension == "distance")
            return [value, times = MotionTimes(*this)](RunEntity& actor, int step) {
                return times.along_way(actor, value, step);
            };
        if (dimension != "rate")
            return [value, times = MotionTimes(*this)](RunEntity& actor, int step) {
                return times.while_moving(actor, value, step);
            };
        const auto absolute = target ? target->child("AbsoluteTargetLane") : std::nullopt,
                   relative = target ? target->child("RelativeTargetLane") : std::nullopt;
        const RunEntity* other = relative ? story.one_of(*relative, "entityRef", scope) : nullptr;
        if (!look_for_lanes() || (!absolute && !other)) return unknown(action);
        const int stated = static_cast<int>(
            std::clamp(number_in(absolute ? *absolute : *relative, "value", scope, 0), -1000.0, 1000.0));
        const double offset = number_in(action, "targetLaneOffset", scope, 0), peak = peak_of(shape);
        return [=, place = action.place(), times = MotionTimes(*this)](RunEntity& actor, int step) -> Progress {
            const double now = times.story.at(step);
            const auto from = times.lane_of(actor, now);
            const auto base = other ? times.lane_of(*other, now) : std::nullopt;
            int lane = stated;
            if (base) {
                lane = base->id + stated * (base->forwards ? 1 : -1);
                // There is no lane 0.
                if (lane == 0 || (lane > 0) != (base->id > 0)) lane += lane > base->id ? 1 : -1;
            }
            if (!from || (other && !base) || lane == 0 || !from->section->find(lane)) return times.lost(place);
            const double change = std::abs(from->t() - from->centre(lane) - offset);
            return change > 1e-6 ? times.while_moving(actor, peak * change / value, step) : Progress{};
        };
    }

    Each lane_offset(const XmlElement& action) const {
        const auto dynamics = action.child("LaneOffsetActionDynamics"), target = action.child("LaneOffsetTarget");
        const std::string shape = dynamics ? resolved(*dynamics, "dynamicsShape", scope).value_or("") : "";
        if (shape == "step") return [](RunEntity&, int) { return Progress{}; };
        const auto absolute = target ? target->child("AbsoluteTargetLaneOffset") : std::nullopt,
                   relative = target ? target->child("RelativeTargetLaneOffset") : std::nullopt;
        const RunEntity* other = relative ? story.one_of(*relative, "entityRef", scope) : nullptr;
        if (!dynamics || !look_for_lanes() || (!absolute && !other)) return unknown(action);
        const double stated = number_in(absolute ? *absolute : *relative, "value", scope, 0);
        const double most =
            std::max(1e-6, number_in(*dynamics, "maxLateralAcc", scope, 0.5));  // m/s^2, esmini's default
        return [=, place = action.place(), times = MotionTimes(*this)](RunEntity& actor, int step) -> Progress {
            const double now = times.story.at(step);
            const auto from = times.lane_of(actor, now);
            const auto base = other ? times.lane_of(*other, now) : std::nullopt;
            if (!from || (other && (!base || base->road != from->road))) return times.lost(place);
            const double change =
                std::abs(base ? base->t() + stated * (base->forwards ? 1 : -1) - from->t() : stated - from->offset);
            const double seconds = shape == "sinusoidal" ? std::numbers::pi * std::sqrt(change / (2 * most))
                                                         : std::sqrt(6 * change / most);
            return change > 1e-6 ? times.after(now + seconds) : Progress{};
        };
    }
    bool look_for_lanes() const {
        if (!story.roads) return false;
        if (!story.lanes) story.lanes = std::make_shared<LaneGraph>(*story.roads);
        return true;
    }

    Each synchronize(const XmlElement& action) const {
        const auto at_master = action.child("TargetPositionMaster"), at_actor = action.child("TargetPosition");
        const RunEntity* master = story.one_of(action, "masterEntityRef", scope);
        const auto for_master = at_master ? position_of(*at_master, scope, story) : std::nullopt,
                   for_actor = at_actor ? position_of(*at_actor, scope, story) : std::nullopt;
        if (!master || !for_master || !for_actor) return unknown(action);
        const std::array tolerance{std::max(1e-6, number_in(action, "targetTolerance", scope, 0)),
                                   std::max(1e-6, number_in(action, "targetToleranceMaster", scope, 0))};  // m
        return [=, to = std::array{glm::dvec2(*for_actor), glm::dvec2(*for_master)}, &s = story](RunEntity& actor,
                                                                                                 int) -> Progress {
            return [=, &s, &actor, last = std::array{HUGE_VAL, HUGE_VAL}](int step) mutable {
                bool done = false;
                for (size_t i = 0; i < 2; ++i) {
                    const double now =
                        glm::distance(glm::dvec2(pose_at(i == 0 ? actor : *master, s.at(step)).position), to[i]);
                    done = done || now < tolerance[i] || now > last[i] + 1e-6;  // there, or past it
                    last[i] = now;
                }
                return done;
            };
        };
    }

    Each trajectory(const XmlElement& action) const {
        const auto held = action.child("TrajectoryRef");
        const XmlElement& holder = held ? *held : action;
        const auto inside = holder.child("Trajectory"), reference = holder.child("CatalogReference");
        const auto entry = !inside && reference ? story.scenario.find(*reference, scope) : std::nullopt;
        if (!inside && !entry) return unknown(action);
        const XmlElement& found = inside ? *inside : entry->element;
        const Parameters inner = declared(found, inside ? scope : entry->parameters);
        const auto shape = found.child("Shape");
        const auto line = shape ? shape->child("Polyline") : std::nullopt,
                   clothoid = shape ? shape->child("Clothoid") : std::nullopt;
        const std::vector<XmlElement> points = line ? line->children("Vertex") : std::vector<XmlElement>{};
        const auto reference_of_time = action.child("TimeReference");
        if (const auto timing = reference_of_time ? reference_of_time->child("Timing") : std::nullopt) {
            const double scale = number_in(*timing, "scale", scope, 1), offset = number_in(*timing, "offset", scope, 0);
            const bool from_start =
                resolved(*timing, "domainAbsoluteRelative", scope).value_or("relative") == "relative";
            const XmlElement* last = clothoid ? &*clothoid : points.empty() ? nullptr : &points.back();
            if (!last || !last->attribute(clothoid ? "stopTime" : "time") || scale <= 0) return unknown(action);
            const double end = number_in(*last, clothoid ? "stopTime" : "time", inner, 0),
                         begin = number_in(clothoid ? *clothoid : points.front(), clothoid ? "startTime" : "time",
                                           inner, 0);
            const double until = (end - offset - (from_start ? begin : 0)) / scale;
            return [=, times = MotionTimes(*this)](RunEntity&, int step) {
                return times.after(until + (from_start ? times.story.at(step) : 0));
            };
        }
        if (flag_in(found, "closed", inner)) return [](RunEntity&, int) { return never(); };
        double length = clothoid ? number_in(*clothoid, "length", inner, 0) : 0;
        std::optional<glm::dvec3> before;
        for (const XmlElement& each : points) {
            const auto point = position_of(each, inner, story);
            if (!point) return unknown(action);
            if (before) length += glm::distance(*before, *point);
            before = point;
        }
        length -= number_in(action, "initialDistanceOffset", scope, 0);
        if (!clothoid && points.empty()) return unknown(action);
        return [length, times = MotionTimes(*this)](RunEntity& actor, int step) {
            return times.along_way(actor, length, step);
        };
    }
};

}  // namespace

StoryAction motion_of(const XmlElement& action, const Parameters& scope, StoryTime& story) {
    const MotionReader reader{{story}, scope};
    const auto name = action.name();
    constexpr uint32_t kAlong = StoryAction::kLongitudinal, kAcross = StoryAction::kLateral;
    if (name == "SpeedAction") return {{}, reader.speed(action), kAlong};
    if (name == "SpeedProfileAction") return {{}, reader.profile(action), kAlong};
    if (name == "LongitudinalDistanceAction") return {{}, reader.distance(action, false), kAlong};
    if (name == "SynchronizeAction") return {{}, reader.synchronize(action), kAlong};
    if (name == "LaneChangeAction") return {{}, reader.lane_change(action), kAcross, kLaneQuestions};
    if (name == "LaneOffsetAction") return {{}, reader.lane_offset(action), kAcross, kLaneQuestions};
    if (name == "LateralDistanceAction") return {{}, reader.distance(action, true), kAcross};
    if (name == "FollowTrajectoryAction") return {{}, reader.trajectory(action), kAlong | kAcross};
    story.note(action.place() + ": is no action that is known: left out");
    return {};
}

}  // namespace vesper::roads
