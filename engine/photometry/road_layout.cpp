// Where the luminaires of a road stand, and where it is looked at. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "photometry/road.h"

namespace vesper {
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

}  // namespace

void check_road(const RoadLayout& road) {
    const auto require = [&](bool holds, const char* reason) {
        if (!holds) throw Error((road.name.empty() ? "road" : road.name) + ": " + reason);
    };
    const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
    require(within(road.width, 1, 100), "the width must be from 1 to 100 m");
    require(within(road.lanes, 1, 12), "there must be 1 to 12 lanes");
    require(within(road.spacing, 5, 500), "the spacing must be from 5 to 500 m");
    require(within(road.height, 2, 40), "the height must be from 2 to 40 m");
    require(within(road.overhang, -50, 50), "the overhang must be from -50 to 50 m");
    require(within(road.reservation, 0, 100), "the reservation must be from 0 to 100 m");
    for (const double angle : {road.orientation, road.tilt, road.roll})
        require(within(angle, -180, 180), "angles must be from -180 to 180 degrees");
    require(within(road.maintenance_factor, 0.01, 1), "the maintenance factor must be from 0.01 to 1");
    require(within(road.flux_factor, 0, 1000), "the flux factor must be from 0 to 1000");
    require(within(road.age, 1, 120), "the age must be from 1 to 120 years");
    require(road.arrangement != Arrangement::List || (!road.list.empty() && road.list.size() <= 32),
            "a list of luminaires must have 1 to 32 of them");
    for (const RoadMount& mount : road.list)
        require(within(mount.position.x, -1000, 1000) && within(mount.position.y, -200, 200) &&
                    within(mount.position.z, 2, 40) && within(mount.facing, -360, 360),
                "a luminaire of the list is out of reach: |x| to 1000 m, |y| to 200 m, height 2 to 40 m");
    require(!road.distribution.candela.empty(), "there is no distribution of intensity");
    check_reflection_table(road.surface, road.surface.name);
}

std::vector<RoadMount> road_mounts(const RoadLayout& road) {
    const double h = road.height;
    const RoadMount right{{0, road.overhang, h}, 90}, left{{0, road.width - road.overhang, h}, -90};
    switch (road.arrangement) {
        case Arrangement::Right:
            return {right};
        case Arrangement::Left:
            return {left};
        case Arrangement::Opposite:
            return {right, left};
        case Arrangement::Staggered:
            return {right, {left.position + glm::dvec3(road.spacing / 2, 0, 0), left.facing}};
        case Arrangement::Central: {
            const double beyond = road.reservation + road.overhang;  // over the other carriageway
            if (road.left_hand_traffic) return {right, {{0, -beyond, h}, -90}};
            return {left, {{0, road.width + beyond, h}, 90}};
        }
        case Arrangement::List:
            return road.list;
    }
    return {};
}

std::vector<RoadLuminaire> road_luminaires(const RoadLayout& road, double low, double high) {
    std::vector<RoadLuminaire> made;
    const glm::dmat3 in_place = turn(kX, road.tilt) * turn(kY, road.roll) * turn(kZ, road.c0_street_side ? 90 : 0);
    for (const RoadMount& mount : road_mounts(road)) {
        const glm::dmat3 axes = turn(kZ, mount.facing - 90 + road.orientation) * in_place;
        const double first = std::ceil((low - mount.position.x) / road.spacing);
        for (double k = first; mount.position.x + k * road.spacing <= high; ++k)
            made.push_back({mount.position + glm::dvec3(k * road.spacing, 0, 0), axes});
    }
    return made;
}

RoadField road_field(const RoadLayout& road) {
    RoadField field;
    const int count = road.spacing <= 30 ? 10 : static_cast<int>(std::ceil(road.spacing / 3 - 1e-9));
    field.step = road.spacing / count;
    for (int i = 0; i < count; ++i) field.x.push_back((i + 0.5) * field.step);
    const int across = 3 * road.lanes;
    for (int j = 0; j < across; ++j) field.y.push_back((j + 0.5) * road.width / across);
    return field;
}

double road_height(const RoadLayout& road) {
    double height = 0;
    for (const RoadMount& mount : road_mounts(road)) height = std::max(height, mount.position.z);
    return height;
}

std::vector<RoadObserver> road_observers(const RoadLayout& road) {
    std::vector<RoadObserver> observers;
    for (int i = 0; i < road.lanes; ++i) {
        const double y = (i + 0.5) * road.width / road.lanes;
        RoadObserver observer;
        observer.lane = i + 1;
        observer.eye = {-60, road.left_hand_traffic ? road.width - y : y, 1.5};
        observers.push_back(observer);
    }
    return observers;
}

}  // namespace vesper
