// Reference lines, elevation and lateral profile of OpenDRIVE roads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "roads/opendrive_reader.h"

namespace vesper::roads {
namespace {

constexpr double kPlanGap = 0.01;        // m; files are written with more digits than this
constexpr double kKink = 0.02;           // rad, as much as is not seen
constexpr double kTorn = 1000;           // m; no road
constexpr double kShortestRoad = 0.001;  // m: roads that join others in one point are as long as this

std::array<double, 4> coefficients(const XmlElement& element, const char* of) {
    const std::string name(of);
    std::array<double, 4> c{};
    for (int i = 0; i < 4; ++i) c[i] = element.number_or(std::string(1, "abcd"[i]) + name, 0);
    return c;
}

PlanGeometry geometry_of(OpenDriveReader& reader, const XmlElement& element) {
    PlanGeometry g;
    g.s = element.number("s", 0);
    g.x = element.number("x"), g.y = element.number("y");
    g.heading = element.number_or("hdg", 0);
    g.length = element.number("length", 0, reader.limits.road_length);
    size_t shapes = 0;
    for (const char* shape : {"arc", "spiral", "poly3", "paramPoly3", "line"}) shapes += element.children(shape).size();
    if (shapes > 1)
        reader.note(element, "has " + std::to_string(shapes) +
                                 " shapes: one is read, of arc, spiral, poly3, paramPoly3 and line the first");
    if (const auto arc = element.child("arc")) {
        g.kind = PlanGeometry::Kind::Arc;
        g.curvature = g.curvature_end = arc->number("curvature", -1e4, 1e4);
    } else if (const auto spiral = element.child("spiral")) {
        g.kind = PlanGeometry::Kind::Spiral;
        g.curvature = spiral->number("curvStart", -1e4, 1e4), g.curvature_end = spiral->number("curvEnd", -1e4, 1e4);
    } else if (const auto poly = element.child("poly3")) {
        g.kind = PlanGeometry::Kind::Poly3;
        g.v = coefficients(*poly, "");
    } else if (const auto parametric = element.child("paramPoly3")) {
        g.kind = PlanGeometry::Kind::ParamPoly3;
        g.u = coefficients(*parametric, "U"), g.v = coefficients(*parametric, "V");
        const std::string range = parametric->text_or("pRange", "normalized");
        if (range != "arcLength" && range != "normalized") parametric->fail("pRange must be arcLength or normalized");
        g.p_end = range == "arcLength" ? g.length : 1;
    } else if (!element.child("line")) {
        element.fail("has no line, arc, spiral, poly3 or paramPoly3");
    }
    const bool is_spiral = g.kind == PlanGeometry::Kind::Spiral;
    const double most = is_spiral ? reader.limits.spiral_turns : reader.limits.turns;
    if (std::max(std::abs(g.curvature), std::abs(g.curvature_end)) * g.length > most)
        element.fail("turns round more often than roads do");
    return g;
}

void measure_checked(OpenDriveReader& reader, const XmlElement& element, PlanGeometry& g) {
    const double arc = measure(g);
    if (!std::isfinite(arc)) element.fail("the polynomial leaves all bounds");
    if (g.kind == PlanGeometry::Kind::ParamPoly3 && g.length > 0) {
        if (!(arc > 1e-6 * g.length)) element.fail("the polynomial does not move");
        if (arc > 100 * g.length) element.fail("the polynomial is more than a hundred times as long as stated");
        if (std::abs(arc - g.length) > std::max(0.02, 1e-3 * g.length))
            reader.note(element, "the curve is " + std::to_string(arc) + " m long, not " + std::to_string(g.length) +
                                     ": s is stretched along it");
    }
}

/// Between one geometry and the next, and at the end.
void check_joints(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    for (size_t i = 1; i < road.plan.size(); ++i) {
        const PlanGeometry &before = road.plan[i - 1], &g = road.plan[i];
        const PlanPoint end = plan_point(before, g.s - before.s), begin = plan_point(g, 0);
        const double gap = std::hypot(end.x - begin.x, end.y - begin.y);
        if (!(gap <= kTorn))
            element.fail("road '" + road.id + "': the reference line jumps by " + std::to_string(gap) +
                         " m at s = " + std::to_string(g.s));
        if (gap > kPlanGap)
            reader.note(element, "road '" + road.id + "': the reference line jumps by " + std::to_string(gap) +
                                     " m at s = " + std::to_string(g.s));
        if (const double turn = std::remainder(begin.heading - end.heading, 2 * std::numbers::pi);
            std::abs(turn) > kKink)
            reader.note(element, "road '" + road.id + "': the reference line has a kink of " +
                                     std::to_string(turn * 180 / std::numbers::pi) +
                                     " degrees at s = " + std::to_string(g.s));
        const double end_s = before.s + before.length;
        if (std::abs(g.s - end_s) > kPlanGap)
            reader.note(element, "road '" + road.id + "': a geometry ends at s = " + std::to_string(end_s) +
                                     ", the next begins at " + std::to_string(g.s));
    }
    const double end = road.plan.back().s + road.plan.back().length;
    if (std::abs(end - road.length) > kPlanGap)
        reader.note(element, "road '" + road.id + "': its geometry is " + std::to_string(end) + " m long, not " +
                                 std::to_string(road.length));
    if (end < road.length - kPlanGap || road.length < kShortestRoad)
        road.length = end;  // what has no geometry is no road
}

/// Exporters write connecting roads without length where roads meet in a point. As a road of next to none, it still
/// says which lane leads to which.
void read_point(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    reader.count(element);
    reader.note(element, "road '" + road.id + "' has no length: taken for a millimetre");
    PlanGeometry g;
    g.x = element.number("x"), g.y = element.number("y"), g.heading = element.number_or("hdg", 0);
    g.length = road.length = kShortestRoad;
    road.plan.push_back(std::move(g));
}

void read_crossfall(OpenDriveReader& reader, const XmlElement& holder, Road& road) {
    for (const XmlElement& each : holder.children("crossfall")) {
        reader.count(each);
        const Cubic part{each.number("s", 0), each.number_or("a", 0), each.number_or("b", 0), each.number_or("c", 0),
                         each.number_or("d", 0)};
        const std::string side = each.text_or("side", "both");
        if (side != "right") road.crossfall_left.parts.push_back(part);
        if (side != "left") road.crossfall_right.parts.push_back(part);
    }
    for (Profile* profile : {&road.crossfall_left, &road.crossfall_right})
        std::stable_sort(profile->parts.begin(), profile->parts.end(),
                         [](const Cubic& a, const Cubic& b) { return a.s < b.s; });
}

void read_shapes(OpenDriveReader& reader, const XmlElement& holder, Road& road) {
    std::map<double, std::vector<Cubic>> shapes;
    for (const XmlElement& each : holder.children("shape")) {
        reader.count(each);
        shapes[each.number("s", 0)].push_back({each.number("t"), each.number_or("a", 0), each.number_or("b", 0),
                                               each.number_or("c", 0), each.number_or("d", 0)});
    }
    for (auto& [s, parts] : shapes) {
        std::stable_sort(parts.begin(), parts.end(), [](const Cubic& a, const Cubic& b) { return a.s < b.s; });
        road.shapes.push_back({s, std::move(parts)});
    }
}

void read_strips(OpenDriveReader& reader, const XmlElement& surface, Road& road) {
    const auto profile = [&](const XmlElement& holder, const char* name) {
        const auto each = holder.child(name);
        return each ? profile_of(reader, *each, "coefficients", "s", 0) : Profile{};
    };
    road.strips_offset = profile(surface, "tOffset");
    for (const XmlElement& each : surface.children_of("surfaceStrips", "strip")) {
        reader.count(each);
        SurfaceStrip strip;
        strip.id = each.integer("id", -1000, 1000);
        if (strip.id == 0) each.fail("strips are numbered from 1 and -1 outwards");
        strip.width = profile(each, "width"), strip.constant = profile(each, "constant"),
        strip.linear = profile(each, "linear");
        strip.quadratic = profile(each, "quadratic"), strip.cubic = profile(each, "cubic");
        // Strips that say no height of their own go on from the one inside.
        const std::string mode = each.text_or("mode", strip.constant.parts.empty() ? "relative" : "independent");
        strip.relative = mode == "relative";
        road.strips.push_back(std::move(strip));
    }
    std::stable_sort(road.strips.begin(), road.strips.end(),
                     [](const SurfaceStrip& a, const SurfaceStrip& b) { return std::abs(a.id) < std::abs(b.id); });
}

// At the ends of every part and between.
void check_heights(const OpenDriveReader& reader, const XmlElement& element, const Road& road) {
    const std::vector<Cubic>& parts = road.elevation.parts;
    for (size_t i = 0; i < parts.size(); ++i) {
        const double end = i + 1 < parts.size() ? std::min(parts[i + 1].s, road.length) : road.length;
        for (int k = 0; k <= 8; ++k)
            if (const double z = parts[i].at(parts[i].s + std::max(0.0, end - parts[i].s) * k / 8);
                !(std::abs(z) <= reader.limits.height))
                element.fail("road '" + road.id + "' is " + std::to_string(z) + " m high");
    }
}

}  // namespace

Profile profile_of(OpenDriveReader& reader, const XmlElement& element, std::string_view name, const char* s_name,
                   double from) {
    Profile profile;
    for (const XmlElement& each : element.children(name)) {
        reader.count(each);
        profile.parts.push_back({from + each.number_or(s_name, 0), each.number_or("a", 0), each.number_or("b", 0),
                                 each.number_or("c", 0), each.number_or("d", 0)});
    }
    const auto before = [](const Cubic& a, const Cubic& b) { return a.s < b.s; };
    if (!std::is_sorted(profile.parts.begin(), profile.parts.end(), before)) {
        reader.note(element, std::string(name) + " is not in ascending order: sorted");
        std::stable_sort(profile.parts.begin(), profile.parts.end(), before);
    }
    return profile;
}

void read_plan(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    const auto view = element.child("planView");
    if (!view) element.fail("road '" + road.id + "' has no planView");
    const std::vector<XmlElement> geometries = view->children("geometry");
    if (geometries.empty()) view->fail("road '" + road.id + "' has no geometry");
    double longest = 0;
    for (const XmlElement& each : geometries) longest = std::max(longest, each.number("length", 0));
    if (longest < kShortestRoad) return read_point(reader, geometries.front(), road);
    for (const XmlElement& each : geometries) {
        reader.count(each);
        PlanGeometry g = geometry_of(reader, each);
        if (g.length <= 0) {
            reader.note(each, "has no length: left out");
            continue;
        }
        measure_checked(reader, each, g);
        road.plan.push_back(std::move(g));
    }
    const auto before = [](const PlanGeometry& a, const PlanGeometry& b) { return a.s < b.s; };
    if (!std::is_sorted(road.plan.begin(), road.plan.end(), before)) {
        reader.note(*view, "geometries are not in ascending order of s: sorted");
        std::stable_sort(road.plan.begin(), road.plan.end(), before);
    }
    check_joints(reader, *view, road);
}

void read_profiles(OpenDriveReader& reader, const XmlElement& element, Road& road) {
    if (const auto holder = element.child("elevationProfile"))
        road.elevation = profile_of(reader, *holder, "elevation", "s", 0), check_heights(reader, *holder, road);
    if (const auto holder = element.child("lateralProfile")) {
        road.superelevation = profile_of(reader, *holder, "superelevation", "s", 0);
        read_crossfall(reader, *holder, road);
        read_shapes(reader, *holder, road);
        if (const auto surface = holder->child("crossSectionSurface")) read_strips(reader, *surface, road);
    }
}

}  // namespace vesper::roads
