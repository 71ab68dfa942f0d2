// Paint of objects. SPDX-License-Identifier: MIT
#include "roads/object_paint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "roads/stencils.h"

namespace vesper::roads {

glm::dvec3 ObjectPaint::on_surface(double s, double t, double over) const {
    const RoadPoint p = surface_point(road, s, t);
    // Pavements and the like are higher than the surface.
    const LaneSection& section = road.sections[road.section_at(std::clamp(s, 0.0, road.length - 1e-6))];
    double inner = lane_border(road, section, 0, s), lift = 0;
    for (int id = t > inner ? 1 : -1; section.find(id); id += id > 0 ? 1 : -1) {
        const double outer = lane_border(road, section, id, s);
        if (std::abs(t - road.lane_offset.at(s)) <= std::abs(outer - road.lane_offset.at(s)) + 1e-9) {
            const double width = outer - inner;
            lift = lane_height(*section.find(id), s, std::abs(width) > 1e-9 ? (t - inner) / width : 0);
            break;
        }
        inner = outer;
    }
    return p.position + p.up * (lift + kMarkHeight + 0.003 + over);
}

glm::dvec2 ObjectPaint::road_place(const RoadObject& object, const Placed& at, double u, double v) const {
    const double turn = object.heading;
    const double ds = u * std::cos(turn) - v * std::sin(turn), dt = u * std::sin(turn) + v * std::cos(turn);
    // On a bend, a metre along the object is not one along the reference line.
    const double curvature = reference_point(road, at.s).curvature, stretch = 1 - curvature * (at.t + dt);
    return {at.s + ds / (std::abs(stretch) > 0.1 ? stretch : 1), at.t + dt};
}

bool ObjectPaint::stencil(const RoadObject& object, const Placed& at, glm::dvec2 low, glm::dvec2 high) {
    if (kind != ObjectKind::RoadMark) return false;
    const std::optional<ArrowShape> arrow = arrow_of(object);
    if (!arrow) {
        const bool unknown = is_shapeless(object);
        if (unknown) ++build.shapeless[object.name.empty() ? object.subtype : object.name];
        return unknown;
    }
    // It points as its lane leads.
    const double ahead = (at.t > road.lane_offset.at(at.s)) == road.right_hand ? -1 : 1;
    const double turn = std::cos(object.heading) * ahead < -0.5 ? -1 : 1;
    const glm::dvec2 middle = (low + high) / 2.0, size = high - low;
    const glm::dvec3 up = surface_point(road, at.s, at.t).up;
    for (const std::vector<glm::dvec2>& part : arrow_parts(*arrow, size.x, size.y)) {
        std::vector<glm::dvec3> corners;
        for (const glm::dvec2& p : part) {
            const glm::dvec2 place = road_place(object, at, middle.x + turn * p.x, middle.y + turn * p.y);
            corners.push_back(on_surface(place.x, place.y, 0));
        }
        mesh.any_polygon(RoadMaterial::MarkWhite, corners, up);
    }
    return true;
}

bool ObjectPaint::framed_stencil(const RoadObject& object, const Placed& at, const ObjectOutline& outline) {
    if (outline.corners.size() != 4 || (!arrow_of(object) && !is_shapeless(object))) return false;
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const ObjectCorner& corner : outline.corners) {
        if (!corner.local) return false;
        low = glm::min(low, {corner.u, corner.v}), high = glm::max(high, {corner.u, corner.v});
    }
    return stencil(object, at, low, high);
}

void ObjectPaint::flat_rectangle(const RoadObject& object, const Placed& at) {
    std::array<glm::dvec2, 4> places;  // rear right, front right, front left, rear left
    for (size_t i = 0; i < 4; ++i)
        places[i] =
            road_place(object, at, (i == 1 || i == 2 ? 1 : -1) * at.length / 2, (i < 2 ? -1 : 1) * at.width / 2);
    if (kind == ObjectKind::Crosswalk && object.markings.empty()) return zebra({places.begin(), places.end()});
    if (kind == ObjectKind::ParkingSpace && object.markings.empty()) return boundary({places.begin(), places.end()});
    constexpr std::array<const char*, 4> kSides{"right", "front", "left", "rear"};
    for (const ObjectMarking& marking : object.markings)
        for (size_t i = 0; i < 4; ++i)
            if (marking.side == kSides[i]) painted(places[i], places[(i + 1) % 4], marking);
    if (!object.markings.empty()) return;
    if (stencil(object, at, {-at.length / 2, -at.width / 2}, {at.length / 2, at.width / 2})) return;
    const auto corner = [&](size_t i) { return on_surface(places[i].x, places[i].y, 0); };
    mesh.quad(kind == ObjectKind::RoadMark ? RoadMaterial::MarkWhite : RoadMaterial::Shoulder, corner(0), corner(1),
              corner(2), corner(3));
}

glm::dvec2 ObjectPaint::corner_place(const RoadObject& object, const Placed& at, const ObjectCorner& corner) const {
    if (corner.local) return road_place(object, at, corner.u, corner.v);
    // Corners on the road move with the copies of a repeated object.
    return {corner.u + at.s - object.s, corner.v + at.t - object.t};
}

void ObjectPaint::painted(glm::dvec2 from, glm::dvec2 to, const ObjectMarking& marking) {
    const glm::dvec3 a = on_surface(from.x, from.y, 0), b = on_surface(to.x, to.y, 0);
    const double length = glm::distance(a, b);
    if (length < 1e-3 || length > 1e4) return;
    const double dash = marking.space_length > 0 && marking.line_length > 0 ? marking.line_length : length;
    const double period = std::max(dash + (marking.space_length > 0 ? marking.space_length : 0), 0.05);
    for (double at = marking.start_offset; at < length - marking.stop_offset && pieces <= kMaxCopies;
         at += period, ++pieces) {
        const double end = std::min(at + dash, length - marking.stop_offset);
        // Pieces short enough to follow a bend.
        const int parts = std::max(1, static_cast<int>(std::ceil((end - at) / 2)));
        for (int p = 0; p < parts; ++p) {
            const glm::dvec2 first = glm::mix(from, to, (at + (end - at) * p / parts) / length),
                             last = glm::mix(from, to, (at + (end - at) * (p + 1) / parts) / length);
            const RoadPoint up = surface_point(road, first.x, first.y);
            const glm::dvec3 c = on_surface(first.x, first.y, 0.001), d = on_surface(last.x, last.y, 0.001);
            const glm::dvec3 side = glm::normalize(glm::cross(up.up, d - c)) * (marking.width / 2);
            const RoadMaterial stuff = marking.colour == MarkColour::Yellow ? RoadMaterial::MarkYellow
                                       : marking.colour == MarkColour::Blue ? RoadMaterial::MarkBlue
                                                                            : RoadMaterial::MarkWhite;
            mesh.quad(stuff, RoadMesh::Corner{c - side, up.up}, {d - side, up.up}, {d + side, up.up},
                      {c + side, up.up});
        }
    }
}

void ObjectPaint::markings(const RoadObject& object, const Placed& at, const ObjectOutline& outline) {
    for (const ObjectMarking& marking : object.markings)
        for (size_t i = 0; i + 1 < marking.corners.size(); ++i) {
            const auto find = [&](int id) {
                return std::find_if(outline.corners.begin(), outline.corners.end(),
                                    [&](const ObjectCorner& c) { return c.id == id; });
            };
            const auto a = find(marking.corners[i]), b = find(marking.corners[i + 1]);
            if (a != outline.corners.end() && b != outline.corners.end())
                painted(corner_place(object, at, *a), corner_place(object, at, *b), marking);
        }
}

void ObjectPaint::zebra(const std::vector<glm::dvec2>& places) {
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const glm::dvec2& p : places) low = glm::min(low, p), high = glm::max(high, p);
    ObjectMarking bar;
    bar.width = 0.5;
    const double middle = (low.y + high.y) / 2, half = std::min((high.y - low.y) / 2, 50.0);
    for (double t = middle - half + 0.5; t + 0.25 <= middle + half; t += 1) painted({low.x, t}, {high.x, t}, bar);
}

void ObjectPaint::boundary(const std::vector<glm::dvec2>& places) {
    for (size_t i = 0; i < places.size(); ++i) painted(places[i], places[(i + 1) % places.size()], {});
}

}  // namespace vesper::roads
