#include "transport/cut_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vesper::transport {
namespace {

constexpr double kOfPlaces = 0.75;  // so many must meet what cuts a cell
constexpr double kThick = 0.2;      // of a cube: half of what that is at most

// A place of a cell, and what is met from there along an axis before the cube ends; in cubes.
struct Probe {
    double at = 0;
    std::optional<double> below, above;

    std::optional<double> towards(double plane) const { return plane < at ? below : above; }
};

std::optional<double> met(glm::dvec3 from, double at, double end, int axis, double size, const rays::RayCaster& rays) {
    glm::dvec3 to = from;
    to[axis] += (end - at) * size;
    const std::optional<rays::Hit> hit = rays.nearest(from, to);
    return hit ? std::optional(glm::mix(at, end, hit->share)) : std::nullopt;
}

// Where most probes meet something.
std::optional<double> plane_of(std::span<const Probe> probes) {
    std::optional<double> plane;
    size_t most = 0;
    for (const Probe& probe : probes)
        for (const std::optional<double> wanted : {probe.below, probe.above}) {
            if (!wanted) continue;
            size_t count = 0;
            double low = 1, high = 0;
            for (const Probe& other : probes) {
                const std::optional<double> hit = other.towards(*wanted);
                if (!hit || std::abs(*hit - *wanted) > kThick) continue;
                ++count, low = std::min(low, *hit), high = std::max(high, *hit);
            }
            if (count > most) most = count, plane = 0.5 * (low + high);
        }
    return double(most) >= kOfPlaces * double(probes.size()) ? plane : std::nullopt;
}

}  // namespace

glm::dvec3 before(const CellGrid& grid, uint32_t number, glm::dvec3 point) {
    return point + 0.25 * grid.size * direction_of(grid.side(number));
}

void cut(CellPlaces& cell, uint32_t number, const CellGrid& grid, const rays::RayCaster& rays) {
    if (grid.is_air(number)) return;
    CellPlaces least = cell;  // of both axes, the cut that leaves less
    for (uint32_t across = 1; across <= 2; ++across) {
        const int axis = int(grid.side(number) / 2 + across) % 3;
        std::array<Probe, CellPlaces::kMost> probes;
        for (uint32_t i = 0; i < cell.count(); ++i) {
            const glm::dvec3 from = before(grid, number, grid.middle(number) + glm::dvec3(cell.places[i].point));
            const double at = double(cell.places[i].point[axis]) / grid.size + 0.5;
            probes[i] = {at, met(from, at, 0, axis, grid.size, rays), met(from, at, 1, axis, grid.size, rays)};
        }
        const std::optional<double> plane = plane_of(std::span(probes).first(cell.count()));
        if (!plane) continue;
        const bool below = *plane >= 0.5;
        CellPlaces left = cell;
        left.seen = 0, left.cut = CellCut::across(across, *plane, below);
        for (uint32_t i = 0; i < cell.count(); ++i)
            if ((probes[i].at < *plane) == below) left.places[left.seen++] = cell.places[i];
        if (left.seen > 0 && (!least.cut.any() || left.seen < least.count())) least = left;
    }
    cell = least;
}

}  // namespace vesper::transport
