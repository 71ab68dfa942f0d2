// Supports of signals. SPDX-License-Identifier: MIT
#include "roads/signal_supports.h"

#include <algorithm>
#include <cmath>

namespace vesper::roads {
namespace {

constexpr double kSamePlace = 0.6;                         // m; a post within this of a signal is the signal's
constexpr double kArmReach = 20;                           // m; the longest usual mast arms
constexpr double kBelowSign = 0.3;                         // m from a signal down to the top of its post
constexpr double kShortestMast = 2.5;                      // m; lower posts are bollards and railings
constexpr double kBesideBeam = 1.5;                        // m in plan between a signal and the axis of its beam
constexpr double kBelowBeam = 3;                           // m between a signal and a beam or a wire over it
constexpr double kLowestPortal = 3, kNarrowestPortal = 3;  // m; about a lane
constexpr double kArm = 0.14, kHanger = 0.06;              // m, widths of steel
constexpr double kOverHead = 0.15;                         // m from a signal to the arm over it
constexpr double kSameArm = 0.3;                           // m; a signal this near to the line of an arm hangs on it
constexpr double kBoard = 2;                               // m; wider signs stand on two poles
constexpr size_t kMaxBeams = 20'000;

double distance_in_plan(glm::dvec3 a, glm::dvec3 b) { return std::hypot(a.x - b.x, a.y - b.y); }

glm::dvec3 nearest_in_plan(const Segment& line, glm::dvec3 p) {
    const glm::dvec2 way(line.to - line.from);
    const double square = glm::dot(way, way);
    const double f = square > 0 ? std::clamp(glm::dot(glm::dvec2(p - line.from), way) / square, 0.0, 1.0) : 0;
    return glm::mix(line.from, line.to, f);
}

/// The back of a signal's upper edge.
glm::dvec3 top_of(const Hanging& body) { return body.frame.at(-0.05, 0, body.height); }

}  // namespace

bool is_lane_below(const RoadBuild& build, const Road& road, double s, double t) {
    const RoadPoint point = surface_point(road, s, t);
    if (is_on_road(build, point.position, 0)) return true;
    if (s < 0 || s > road.length) return false;
    const LaneSection& section = road.sections[road.section_at(std::min(s, road.length - 1e-6))];
    return std::any_of(section.lanes.begin(), section.lanes.end(), [&](const RoadLane& lane) {
        if (lane.id == 0 || !is_driven(lane.type)) return false;
        const double outer = lane_border(road, section, lane.id, s),
                     inner = lane_border(road, section, lane.id + (lane.id > 0 ? -1 : 1), s);
        return t > std::min(inner, outer) && t < std::max(inner, outer);
    });
}

std::optional<Portal> portal_of(const Road& road, const RoadObject& object, const Placed& at, ObjectKind kind) {
    if (kind != ObjectKind::Gantry && kind != ObjectKind::Pole) return std::nullopt;
    const double span = std::max(at.length, at.width);
    if (at.height < kLowestPortal || span < kNarrowestPortal || at.radius > 0) return std::nullopt;
    const BodyFrame frame = object_frame(road, object, at);
    const glm::dvec3 half = (at.width >= at.length ? frame.y : frame.x) * (span / 2 - kGantrySteel / 2),
                     middle = frame.at(0, 0, at.height - kGantrySteel / 2);
    return Portal{{middle - half, middle + half}, frame.origin.z};
}

SignalSupports::SignalSupports(RoadBuild& build) : build_(build) {
    for (const Road& road : build.network.roads) {
        if (road.sections.empty() || posts_.size() >= kMaxCopies) continue;
        for (const RoadObject& object : road.objects) {
            const ObjectKind kind = kind_of(object);
            if (kind != ObjectKind::Pole && kind != ObjectKind::Gantry && kind != ObjectKind::StreetLamp) continue;
            if (!object.outlines.empty()) continue;  // built as a wall
            if (object.repeats.empty()) find(road, object, whole_object(object), kind);
            for (const ObjectRepeat& repeat : object.repeats)
                if (repeat.distance > 0)
                    visit_copies(road, object, repeat, [&](const Placed& at) {
                        find(road, object, at, kind);
                        return posts_.size() < kMaxCopies;
                    });
        }
    }
    std::sort(posts_.begin(), posts_.end(), [](const Post& a, const Post& b) { return a.foot.x < b.foot.x; });
}

void SignalSupports::find(const Road& road, const RoadObject& object, const Placed& at, ObjectKind kind) {
    if (const std::optional<Portal> portal = portal_of(road, object, at, kind)) {
        if (beams_.size() < kMaxBeams) beams_.push_back(portal->beam);
        return;
    }
    const BodyFrame frame = object_frame(road, object, at);
    const double across = 2 * at.radius, length = std::max(at.length, across), width = std::max(at.width, across);
    double height = at.height;
    if (height <= 0) height = kind == ObjectKind::StreetLamp ? 8 : 3;  // m, as built
    // The longest side says in which direction it goes.
    glm::dvec3 axis = frame.z * height, begin = frame.origin;
    if (length > height && length >= width)
        axis = frame.x * length, begin = frame.at(-length / 2, 0, height / 2);
    else if (width > height)
        axis = frame.y * width, begin = frame.at(0, -width / 2, height / 2);
    const bool upright = std::hypot(axis.x, axis.y) < std::abs(axis.z);
    if (!upright) {
        if (beams_.size() < kMaxBeams) beams_.push_back({begin, begin + axis});
        return;
    }
    if (kind != ObjectKind::Gantry) posts_.push_back({begin, begin.z + axis.z});
}

size_t SignalSupports::first_within(double x) const {
    return static_cast<size_t>(std::lower_bound(posts_.begin(), posts_.end(), x,
                                                [](const Post& post, double at) { return post.foot.x < at; }) -
                               posts_.begin());
}

const Segment* SignalSupports::beam_at(const Hanging& body) const {
    const Segment* best = nullptr;
    const double bottom = body.frame.origin.z, top = bottom + body.height;
    double nearest = kBesideBeam + std::max(0.0, body.width / 2 - kBesideBeam);
    for (const Segment& beam : beams_) {
        const glm::dvec3 at = nearest_in_plan(beam, body.frame.origin);
        const double distance = distance_in_plan(at, body.frame.origin);
        if (distance >= nearest || at.z < bottom - kOverHead || at.z > top + kBelowBeam) continue;
        nearest = distance, best = &beam;
    }
    return best;
}

bool SignalSupports::has_post(const Hanging& body) const {
    const glm::dvec3 place = body.frame.origin;
    for (size_t i = first_within(place.x - kSamePlace); i < posts_.size() && posts_[i].foot.x < place.x + kSamePlace;
         ++i)
        if (distance_in_plan(posts_[i].foot, place) < kSamePlace && posts_[i].top >= place.z - kBelowSign &&
            std::abs(posts_[i].foot.z - body.ground) < kBelowBeam)
            return true;
    return false;
}

SignalSupports::Post* SignalSupports::nearest_post(const Hanging& body) {
    const glm::dvec3 place = body.frame.origin;
    Post* best = nullptr;
    double nearest = kArmReach;
    for (size_t i = first_within(place.x - kArmReach); i < posts_.size() && posts_[i].foot.x < place.x + kArmReach;
         ++i) {
        Post& post = posts_[i];
        const double distance = distance_in_plan(post.foot, place);
        // On the same level, tall, and not in a carriageway itself.
        if (distance >= nearest || post.top - post.foot.z < kShortestMast || post.foot.z > place.z ||
            std::abs(post.foot.z - body.ground) > kBelowBeam || is_on_road(build_, post.foot, 0))
            continue;
        nearest = distance, best = &post;
    }
    return best;
}

void SignalSupports::stand(RoadMesh& mesh, const Hanging& body, double beside) const {
    const BodyFrame frame = body.frame.moved(0, beside, 0);
    const double ground = std::min(build_.ground.height(glm::dvec2(frame.origin)), frame.origin.z) - 0.2;
    BodyFrame foot;
    foot.origin = {frame.origin.x - frame.x.x * 0.06, frame.origin.y - frame.x.y * 0.06, ground};
    add_cylinder(mesh, RoadMaterial::PoleSteel, foot, body.height > 1.5 ? 0.06 : 0.035,
                 frame.origin.z + body.height - ground);
}

bool SignalSupports::stands(RoadMesh& mesh, const Road& road, const RoadSignal& signal, const Hanging& body) const {
    if (body.width < kBoard) {
        if (!body.over_lane) stand(mesh, body, 0);
        return !body.over_lane;
    }
    const double heading = reference_point(road, signal.s).heading;
    const glm::dvec2 way(std::cos(heading), std::sin(heading)), left(-way.y, way.x);
    bool any = false;
    for (const double beside : {-0.35 * body.width, 0.35 * body.width}) {
        const glm::dvec2 moved = glm::dvec2(body.frame.y) * beside;
        if (is_lane_below(build_, road, signal.s + glm::dot(moved, way), signal.t + glm::dot(moved, left))) continue;
        stand(mesh, body, beside);
        any = true;
    }
    return any;
}

void SignalSupports::carry(RoadMesh& mesh, const Road& road, const RoadSignal& signal, const Hanging& body) {
    if (const Segment* beam = beam_at(body)) {
        ++on_beams_;
        const glm::dvec3 at = nearest_in_plan(*beam, body.frame.origin), top = top_of(body);
        // On the beam, or below it.
        const double z = std::min(top.z, at.z);
        return add_tube(mesh, RoadMaterial::PoleSteel, {at, {top.x, top.y, z}}, kHanger);
    }
    if (has_post(body)) return;
    if (stands(mesh, road, signal, body)) return;
    Post* post = nearest_post(body);
    ++(post ? on_arms_ : free_);
    if (post) post->load.push_back(body);
}

void SignalSupports::add_arms(RoadMesh& mesh) {
    for (Post& post : posts_) {
        if (post.load.empty()) continue;
        double height = post.foot.z;
        for (const Hanging& body : post.load) height = std::max(height, top_of(body).z + kOverHead);
        if (post.top < height + kArm / 2)
            add_tube(mesh, RoadMaterial::PoleSteel,
                     {{post.foot.x, post.foot.y, post.top}, {post.foot.x, post.foot.y, height}}, kArm);
        const glm::dvec3 root{post.foot.x, post.foot.y, height};
        std::sort(post.load.begin(), post.load.end(), [&](const Hanging& a, const Hanging& b) {
            return distance_in_plan(root, top_of(a)) > distance_in_plan(root, top_of(b));
        });
        std::vector<Segment> arms;  // the longest first
        for (const Hanging& body : post.load) {
            const glm::dvec3 top = top_of(body), over{top.x, top.y, height};
            glm::dvec3 hook = over;
            const bool shared = std::any_of(arms.begin(), arms.end(), [&](const Segment& arm) {
                hook = nearest_in_plan(arm, over);
                return distance_in_plan(hook, over) < kSameArm;
            });
            if (!shared) {
                arms.push_back({root, over});
                add_tube(mesh, RoadMaterial::PoleSteel, arms.back(), kArm);
                hook = over;
            }
            add_tube(mesh, RoadMaterial::PoleSteel, {hook, top}, kHanger);
        }
    }
    const auto note = [&](size_t count, const char* how) {
        if (count > 0) build_.notes.push_back("signals over lanes: " + std::to_string(count) + how);
    };
    note(on_beams_, " on masts, gantries or wires of the file");
    note(on_arms_, " on arms that are added to the nearest post of the file");
    note(free_, " without a support: the file has no post within 20 m; no pole stands in a carriageway");
}

}  // namespace vesper::roads
