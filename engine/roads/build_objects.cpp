// Objects beside and on roads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/budget.h"
#include "base/one_line.h"
#include "roads/lit_road_parts.h"
#include "roads/object_kind.h"
#include "roads/object_paint.h"
#include "roads/road_lamps.h"
#include "roads/signal_supports.h"
#include "roads/stencils.h"

namespace vesper::roads {
namespace {

constexpr double kFlatObject = 0.02;                  // m; what is lower lies on the road
constexpr double kLowestLamp = 5, kHighestLamp = 15;  // m, of street lamps
constexpr double kAtSignal = 1;                       // m from a pole to a signal that hangs on it

/// A body by its kind, where the file states no size; 0: none.
struct UsualBody {
    RoadMaterial stuff = RoadMaterial::Concrete;
    double height = 0, width = 0;  ///< m
};

UsualBody usual_body(ObjectKind kind) {
    switch (kind) {
        case ObjectKind::Pole:
            return {RoadMaterial::PoleSteel, 3, 0.1};
        case ObjectKind::Gantry:
        case ObjectKind::Railing:
            return {.stuff = RoadMaterial::PoleSteel};
        case ObjectKind::Building:
            return {RoadMaterial::Wall, 8, 0};
        default:
            return {};
    }
}

struct ObjectBuilder : ObjectPaint {
    size_t copies = 0;             ///< objects that were placed
    bool poles_are_lamps = false;  ///< those without a name, of the height of lamps

    /// Whether a pole has the height of a street lamp, no name that says something else, and no signal.
    bool is_lamp_by_height(const RoadObject& object, const Placed& at) const {
        if (!poles_are_lamps || kind != ObjectKind::Pole || !is_unnamed(object)) return false;
        if (at.height < kLowestLamp || at.height > kHighestLamp) return false;
        return std::ranges::none_of(road.signals, [&](const RoadSignal& signal) {
            check_time();
            return std::hypot(signal.s - at.s, signal.t - at.t) < kAtSignal;
        });
    }

    BodyFrame frame_of(const RoadObject& object, const Placed& at) const { return object_frame(road, object, at); }

    void tree(const BodyFrame& frame, const Placed& at, bool bush) {
        const double height = at.height > 0 ? at.height : bush ? 1.5 : 6;
        const double crown = at.radius > 0 ? at.radius : at.width > 0 ? at.width / 2 : height * (bush ? 0.5 : 0.3);
        if (bush) return add_ball(mesh, RoadMaterial::Leaves, frame.moved(0, 0, height / 2), crown, height / 2);
        add_cylinder(mesh, RoadMaterial::Bark, frame, std::max(0.08, height * 0.02), height * 0.5);
        add_ball(mesh, RoadMaterial::Leaves, frame.moved(0, 0, height * 0.65), crown, height * 0.35);
    }

    void guide_post(const BodyFrame& frame, const Placed& at) {
        const double height = at.height > 0 ? at.height : 1.05;
        add_box(mesh, RoadMaterial::Post, frame, 0.1, 0.12, height);
        add_box(mesh, RoadMaterial::PostBand, frame.moved(0, 0, height - 0.35), 0.104, 0.124, 0.2);
        add_box(mesh, RoadMaterial::PostReflector, frame.moved(0, 0, height - 0.34), 0.108, 0.05, 0.18);
    }

    /// A beam on two legs; none stands in a carriageway.
    void gantry(const Portal& portal) {
        add_tube(mesh, RoadMaterial::PoleSteel, portal.beam, kGantrySteel);
        for (const glm::dvec3& top : {portal.beam.from, portal.beam.to}) {
            const glm::dvec3 foot{top.x, top.y, portal.bottom};
            if (!is_on_road(build, foot, 0)) add_tube(mesh, RoadMaterial::PoleSteel, {foot, top}, kGantrySteel);
        }
    }

    void body(const RoadObject& object, const Placed& at) {
        const BodyFrame frame = frame_of(object, at);
        const bool by_height = is_lamp_by_height(object, at);
        build.lamps_by_height += by_height;
        if (kind == ObjectKind::StreetLamp || by_height)
            return add_street_lamp(build, frame, at.height > 0 ? at.height : 8, at.t > 0 ? -1 : 1);
        if (kind == ObjectKind::GuidePost) return guide_post(frame, at);
        if (kind == ObjectKind::Tree || kind == ObjectKind::Bush) return tree(frame, at, kind == ObjectKind::Bush);
        if (const std::optional<Portal> portal = portal_of(road, object, at, kind)) return gantry(*portal);
        if (kind == ObjectKind::Pole) ++build.dark_poles[object.name.empty() ? object.type : object.name];
        const UsualBody usual = usual_body(kind);
        const RoadMaterial stuff = usual.stuff;
        const double height = at.height > 0 ? at.height : usual.height;
        if (at.radius > 0) return height > kFlatObject ? add_cylinder(mesh, stuff, frame, at.radius, height) : void();
        if (const std::optional<ArrowShape> arrow = arrow_of(object); kind == ObjectKind::RoadMark && arrow) {
            Placed sized = at;
            if (sized.length <= 0) sized.length = kArrowLength;
            if (sized.width <= 0) sized.width = usual_width(*arrow);
            return flat_rectangle(object, sized);
        }
        const double width = at.width > 0 ? at.width : usual.width, length = at.length > 0 ? at.length : usual.width;
        if (width <= 0 || length <= 0) return;
        if (height > kFlatObject && !is_flat(kind)) return add_box(mesh, stuff, frame, length, width, height);
        flat_rectangle(object, at);
    }

    void outlined(const RoadObject& object, const Placed& at, const ObjectOutline& outline) {
        std::vector<glm::dvec2> places;
        std::vector<glm::dvec3> bottoms, tops;
        double highest = 0;
        const bool flat = is_flat(kind);
        const BodyFrame frame = frame_of(object, at);
        for (const ObjectCorner& corner : outline.corners) {
            places.push_back(corner_place(object, at, corner));
            const glm::dvec3 base = corner.local ? frame.at(corner.u, corner.v, corner.z)
                                                 : surface_point(road, places.back().x, places.back().y).position +
                                                       glm::dvec3(0, 0, corner.z);
            const double height = flat ? 0 : corner.height > 0 ? corner.height : object.height;
            bottoms.push_back(base), tops.push_back(base + glm::dvec3(0, 0, height));
            highest = std::max(highest, height);
        }
        if (!object.markings.empty()) markings(object, at, outline);
        if (highest > kFlatObject) {
            const RoadMaterial stuff = kind == ObjectKind::Building                           ? RoadMaterial::Wall
                                       : kind == ObjectKind::Tree || kind == ObjectKind::Bush ? RoadMaterial::Leaves
                                                                                              : RoadMaterial::Concrete;
            if (outline.closed && bottoms.size() > 2) return add_prism(mesh, stuff, bottoms, tops);
            // Open: walls without thickness, seen from either side.
            for (size_t i = 1; i < bottoms.size() && !outline.closed; ++i)
                mesh.quad(stuff, bottoms[i - 1], bottoms[i], tops[i], tops[i - 1]),
                    mesh.quad(stuff, bottoms[i], bottoms[i - 1], tops[i - 1], tops[i]);
            return;
        }
        if (!object.markings.empty() || places.size() < 3) return;
        if (kind == ObjectKind::Crosswalk) return zebra(places);
        if (kind == ObjectKind::ParkingSpace) return boundary(places);
        if (framed_stencil(object, at, outline)) return;
        if (!outline.closed) return;  // a line on the ground without paint
        std::vector<glm::dvec3> corners;
        for (const glm::dvec2& p : places) corners.push_back(on_surface(p.x, p.y, 0));
        mesh.any_polygon(kind == ObjectKind::RoadMark ? RoadMaterial::MarkWhite
                         : kind == ObjectKind::Island ? RoadMaterial::Concrete
                                                      : RoadMaterial::Shoulder,
                         corners, surface_point(road, at.s, at.t).up);
    }

    void one(const RoadObject& object, const Placed& at) {
        if (++pieces > kMaxCopies) return;
        ++copies;
        if (object.outlines.empty()) return body(object, at);
        for (const ObjectOutline& outline : object.outlines) outlined(object, at, outline);
    }

    /// A body without end along the road: a rail, a wall, a fence.
    void continuous(const RoadObject& object, const ObjectRepeat& repeat) {
        const RoadMaterial stuff = kind == ObjectKind::Railing || kind == ObjectKind::Barrier ? RoadMaterial::Steel
                                   : kind == ObjectKind::Tree || kind == ObjectKind::Bush     ? RoadMaterial::Leaves
                                                                                              : RoadMaterial::Concrete;
        const double end = std::min(repeat.s + repeat.length, road.length);
        if (!(end > repeat.s)) return;
        const auto steps = static_cast<int>(std::clamp(std::ceil((end - repeat.s) / 4), 1.0, 100'000.0));
        pieces += static_cast<size_t>(steps);
        if (pieces > kMaxCopies) return;
        ++copies;
        const auto section = [&](int i) {
            Placed at = copy_of(object, repeat, repeat.length > 0 ? (end - repeat.s) * i / steps / repeat.length : 0);
            const double width = at.width > 0    ? at.width
                                 : at.radius > 0 ? 2 * at.radius
                                                 : 0.08,
                         height = at.height > 0 ? at.height : 0.3;
            const BodyFrame f = frame_at(road, at.s, at.t, at.z);
            return std::array{f.at(0, -width / 2, 0), f.at(0, width / 2, 0), f.at(0, width / 2, height),
                              f.at(0, -width / 2, height)};
        };
        auto before = section(0);
        mesh.quad(stuff, before[1], before[0], before[3], before[2]);
        for (int i = 1; i <= steps; ++i) {
            const auto after = section(i);
            mesh.quad(stuff, before[0], after[0], after[3], before[3]);  // the right side
            mesh.quad(stuff, after[1], before[1], before[2], after[2]);  // the left
            mesh.quad(stuff, before[3], after[3], after[2], before[2]);  // the top
            mesh.quad(stuff, before[1], after[1], after[0], before[0]);  // and what is seen from below
            before = after;
            if (i % 16 == 0) mesh.place(build.scene, build.materials, "object " + object.name);
        }
        mesh.quad(stuff, before[0], before[1], before[2], before[3]);
    }

    void object(const RoadObject& each) {
        kind = kind_of(each);
        if (each.repeats.empty()) one(each, whole_object(each));
        for (const ObjectRepeat& repeat : each.repeats) {
            if (repeat.distance <= 0 && each.outlines.empty()) {
                continuous(each, repeat);
                continue;
            }
            if (repeat.distance <= 0) {
                one(each, copy_of(each, repeat, 0));
                continue;
            }
            int placed = 0;
            visit_copies(road, each, repeat, [&](const Placed& at) {
                one(each, at);
                if (++placed % 16 == 0) mesh.place(build.scene, build.materials, "object " + each.name);
                return pieces <= kMaxCopies;
            });
        }
    }
};

}  // namespace

void build_objects(RoadBuild& build) {
    RoadMesh mesh(build.network);
    size_t copies = 0, pieces = 0;
    const bool names_lamps = std::ranges::any_of(build.network.roads, [](const Road& road) {
        return std::ranges::any_of(road.objects,
                                   [](const RoadObject& o) { return kind_of(o) == ObjectKind::StreetLamp; });
    });
    const bool wants_lamps = build.options.lamps.spacing.value_or(1) > 0;
    for (const Road& road : build.network.roads) {
        if (road.sections.empty()) continue;
        ObjectBuilder builder{{build, road, mesh, pieces}, copies, wants_lamps && !names_lamps};
        for (const RoadObject& object : road.objects) {
            builder.object(object);
            mesh.place(build.scene, build.materials, "object " + object.name);
        }
        copies = builder.copies, pieces = builder.pieces;
    }
    if (build.lamps_by_height > 0)
        build.notes.push_back("the file names no street lamp: " + std::to_string(build.lamps_by_height) +
                              " poles of 5 to 15 m without a name are taken for them (--lamp-spacing 0: none is)");
    if (!build.dark_poles.empty()) build.notes.push_back("poles without light: " + listed(build.dark_poles));
    if (!build.shapeless.empty())
        build.notes.push_back("stencils left out, whose shape is not known: " + listed(build.shapeless));
    if (copies > 0)
        build.notes.push_back("objects: " + std::to_string(copies) +
                              (pieces > kMaxCopies ? ", more are left out" : ""));
}

}  // namespace vesper::roads
