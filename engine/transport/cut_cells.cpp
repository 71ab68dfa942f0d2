#include "transport/cut_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace vesper::transport {
namespace {

constexpr uint32_t kLeastPlaces = 3;  // of a cell that is cut
constexpr double kOfPlaces = 0.75;    // so many must meet what cuts a cell
constexpr double kThick = 0.3;        // of a cube, from the plane of a cut to where it is met

// A place of a cell along a way, and what is met from there before the way ends, in cubes; on diagonals that may be
// beyond the cube.
struct Probe {
    double at = 0;
    std::optional<double> below, above;

    // From a plane to what is met on the way there; at most kThick.
    double off(double plane) const {
        const std::optional<double>& towards = plane < at ? below : above;
        return towards ? std::min(std::abs(*towards - plane), kThick) : kThick;
    }
};

std::optional<double> met(glm::dvec3 from, double at, double end, glm::dvec3 way, const rays::RayCaster& rays) {
    const std::optional<rays::Hit> hit = rays.nearest(from, from + (end - at) * way);
    return hit ? std::optional(glm::mix(at, end, hit->share)) : std::nullopt;
}

// A plane across a way.
struct Plane {
    uint32_t way;
    double at;   // cubes
    double off;  // from there to what probes meet, the sum over all
};

// Across a side; from the middle of the cube, in cubes.
bool is_in_cube(glm::dvec3 point, uint32_t facing) {
    const int axis = axis_of(facing);
    return std::abs(point[(axis + 1) % 3]) < 0.5 && std::abs(point[(axis + 2) % 3]) < 0.5;
}

// The one that probes meet best, in the middle between any two hits: of a wall its faces on both sides, of one that is
// turned its ends. `hits`: those in the cube.
std::optional<Plane> plane_of(uint32_t way, std::span<const Probe> probes, std::span<const double> hits) {
    std::optional<Plane> best;
    for (size_t a = 0; a < hits.size(); ++a)
        for (size_t b = 0; b <= a; ++b) {
            Plane plane{way, 0.5 * (hits[a] + hits[b]), 0};
            if (!(plane.at > 0 && plane.at < 1)) continue;  // by a corner of the cube
            double met = 0;
            for (const Probe& probe : probes) {
                const double off = probe.off(plane.at);
                plane.off += off, met += off < kThick ? 1 : 0;
            }
            if (met >= kOfPlaces * double(probes.size()) && (!best || plane.off < best->off)) best = plane;
        }
    return best;
}

}  // namespace

glm::dvec3 before(const CellGrid& grid, uint32_t number, glm::dvec3 point) {
    return point + 0.25 * grid.size * direction_of(grid.facing(number));
}

void cut(CellPlaces& cell, uint32_t number, const CellGrid& grid, const rays::RayCaster& rays) {
    if (grid.is_air(number) || cell.count() < kLeastPlaces) return;
    const uint32_t facing = grid.facing(number);
    const auto at = [&](uint32_t way, uint32_t i) {
        return CellCut::along(way, glm::dvec3(cell.places[i].point) / grid.size + 0.5, facing);
    };
    std::optional<Plane> best;
    for (uint32_t way = 0; way < CellCut::kWays; ++way) {
        const glm::dvec3 direction = CellCut::direction(way, facing), across = grid.size * direction;
        const double end = CellCut::along(way, 0.5 + 0.5 * glm::sign(direction), facing);  // of the cube
        std::array<Probe, CellPlaces::kMost> probes;
        std::vector<double> hits;
        for (uint32_t i = 0; i < cell.count(); ++i) {
            const glm::dvec3 from = before(grid, number, grid.middle(number) + glm::dvec3(cell.places[i].point));
            probes[i] = {at(way, i), met(from, at(way, i), 1 - end, across, rays),
                         met(from, at(way, i), end, across, rays)};
            const glm::dvec3 place = glm::dvec3(cell.places[i].point) / grid.size;
            for (const std::optional<double>& hit : {probes[i].below, probes[i].above})
                if (hit && is_in_cube(place + (*hit - probes[i].at) * direction, facing)) hits.push_back(*hit);
        }
        const std::optional<Plane> plane = plane_of(way, std::span(probes).first(cell.count()), hits);
        if (plane && (!best || plane->off < best->off)) best = plane;
    }
    if (!best) return;
    uint32_t places[2] = {0, 0};  // above and below it, a bit each
    for (uint32_t i = 0; i < cell.count(); ++i) places[at(best->way, i) < best->at ? 1 : 0] |= 1u << i;
    // On the side of the middle, if some are there.
    const bool middle_below = best->at >= 0.5, below = places[middle_below ? 1 : 0] != 0 ? middle_below : !middle_below;
    cell.keep(places[below ? 1 : 0]), cell.cut = CellCut::across(best->way, best->at, below);
}

bool is_split(const CellPlaces& cell, uint32_t number, const CellGrid& grid, const rays::RayCaster& rays) {
    if (grid.is_air(number)) return false;
    const auto start = [&](uint32_t i) {
        return before(grid, number, grid.middle(number) + glm::dvec3(cell.places[i].point));
    };
    uint32_t pairs = 0, apart = 0;
    for (uint32_t a = 1; a < cell.count(); ++a)
        for (uint32_t b = 0; b < a; ++b, ++pairs) apart += rays.blocked(start(a), start(b)) ? 1 : 0;
    return pairs > 0 && 2 * apart >= pairs;
}

}  // namespace vesper::transport
