#include "roads/road_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"

namespace vesper::roads {
namespace {

enum Axis { kX, kY, kZ };

/// A counter-clockwise turn about an axis.
glm::dmat3 turn(Axis axis, double degrees) {
    const double a = degrees * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    glm::dmat3 m(1);
    m[u][u] = c, m[u][v] = s;
    m[v][u] = -s, m[v][v] = c;
    return m;
}

[[noreturn]] void fail(const RoadLayout& layout, const std::string& reason) {
    throw Error((layout.name.empty() ? "road" : layout.name) + ": " + reason);
}

}  // namespace

void check_layout(const RoadLayout& layout) {
    const auto require = [&](bool holds, const char* reason) {
        if (!holds) fail(layout, reason);
    };
    const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
    require(within(layout.width, 1, 100), "the width must be from 1 to 100 m");
    require(within(layout.lanes, 1, 12), "there must be 1 to 12 lanes");
    require(within(layout.spacing, 5, 500), "the spacing must be from 5 to 500 m");
    require(within(layout.height, 2, 40), "the height must be from 2 to 40 m");
    require(within(layout.overhang, -50, 50), "the overhang must be from -50 to 50 m");
    require(within(layout.reservation, 0, 100), "the reservation must be from 0 to 100 m");
    for (const double angle : {layout.orientation_deg, layout.tilt_deg, layout.roll_deg})
        require(within(angle, -180, 180), "angles must be from -180 to 180 degrees");
    require(within(layout.maintenance_factor, 0.01, 1), "the maintenance factor must be from 0.01 to 1");
    require(within(layout.flux_factor, 0, 1000), "the flux factor must be from 0 to 1000");
    require(within(layout.observer_age, 1, 120), "the age must be from 1 to 120 years");
    require(layout.arrangement != Arrangement::List || (!layout.mounts.empty() && layout.mounts.size() <= 32),
            "a list of luminaires must have 1 to 32 of them");
    for (const LuminaireMount& mount : layout.mounts)
        require(within(mount.position.x, -1000, 1000) && within(mount.position.y, -200, 200) &&
                    within(mount.position.z, 2, 40) && within(mount.facing_deg, -360, 360),
                "a luminaire of the list is out of reach: |x| to 1000 m, |y| to 200 m, height 2 to 40 m");
    require(layout.q0 == 0 || within(layout.q0, 0.001, 10), "Q0 must be from 0.001 to 10 1/sr");
}

void check_layout(const LoadedLayout& layout) {
    check_layout(static_cast<const RoadLayout&>(layout));
    if (layout.distribution.candela.empty()) fail(layout, "there is no distribution of intensity");
    photometry::check_reflection_table(layout.surface, layout.surface.name);
}

std::vector<LuminaireMount> luminaire_mounts(const RoadLayout& layout) {
    const double h = layout.height;
    const LuminaireMount right{{0, layout.overhang, h}, 90}, left{{0, layout.width - layout.overhang, h}, -90};
    switch (layout.arrangement) {
        case Arrangement::Right:
            return {right};
        case Arrangement::Left:
            return {left};
        case Arrangement::Opposite:
            return {right, left};
        case Arrangement::Staggered:
            return {right, {{layout.spacing / 2, left.position.y, h}, left.facing_deg}};
        case Arrangement::Central: {
            const double beyond = layout.reservation + layout.overhang;  // over the other carriageway
            if (layout.left_hand_traffic) return {right, {{0, -beyond, h}, -90}};
            return {left, {{0, layout.width + beyond, h}, 90}};
        }
        case Arrangement::List:
            return layout.mounts;
    }
    return {};
}

std::vector<PlacedLuminaire> placed_luminaires(const RoadLayout& layout, double low, double high) {
    std::vector<PlacedLuminaire> made;
    const glm::dmat3 in_place =
        turn(kX, layout.tilt_deg) * turn(kY, layout.roll_deg) * turn(kZ, layout.c0_street_side ? 90 : 0);
    for (const LuminaireMount& mount : luminaire_mounts(layout)) {
        const glm::dmat3 axes = turn(kZ, mount.facing_deg - 90 + layout.orientation_deg) * in_place;
        const double first = std::ceil((low - mount.position.x) / layout.spacing);
        for (double k = first; mount.position.x + k * layout.spacing <= high; ++k)
            made.push_back({vector_of(mount.position) + glm::dvec3(k * layout.spacing, 0, 0), axes});
    }
    return made;
}

CalculationField calculation_field(const RoadLayout& layout) {
    CalculationField field;
    const int count = layout.spacing <= 30 ? 10 : static_cast<int>(std::ceil(layout.spacing / 3 - 1e-9));
    field.step = layout.spacing / count;
    for (int i = 0; i < count; ++i) field.x.push_back((i + 0.5) * field.step);
    const int across = 3 * layout.lanes;
    for (int j = 0; j < across; ++j) field.y.push_back((j + 0.5) * layout.width / across);
    return field;
}

double mounting_height(const RoadLayout& layout) {
    double height = 0;
    for (const LuminaireMount& mount : luminaire_mounts(layout)) height = std::max(height, mount.position.z);
    return height;
}

std::vector<LaneObserver> lane_observers(const RoadLayout& layout) {
    std::vector<LaneObserver> observers;
    for (int i = 0; i < layout.lanes; ++i) {
        const double y = (i + 0.5) * layout.width / layout.lanes;
        LaneObserver observer;
        observer.lane = i + 1;
        observer.eye = {-60, layout.left_hand_traffic ? layout.width - y : y, 1.5};
        observers.push_back(observer);
    }
    return observers;
}

}  // namespace vesper::roads
