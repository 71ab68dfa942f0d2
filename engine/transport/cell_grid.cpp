#include "transport/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vesper::transport {

uint32_t side_of(glm::dvec3 direction) {
    const glm::dvec3 a = kSideFactors * glm::abs(direction);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return uint32_t(2 * axis + (direction[axis] < 0 ? 1 : 0));
}

uint32_t facing_of(glm::dvec3 direction) {
    const glm::dvec3 a = kSideFactors * glm::abs(direction);
    int least = 2;
    for (const int axis : {1, 0})
        if (a[axis] < a[least]) least = axis;
    const int first = (least + 1) % 3, second = (least + 2) % 3;
    const auto [less, more] = std::minmax(a[first], a[second]);
    if (!(less > kBetween * more)) return side_of(direction);
    return kSides + uint32_t(4 * least + (direction[first] < 0 ? 2 : 0) + (direction[second] < 0 ? 1 : 0));
}

glm::dvec3 direction_of(uint32_t facing) {
    glm::dvec3 direction(0);
    const int axis = axis_of(facing);
    if (facing < kSides) {
        direction[axis] = facing % 2 ? -1 : 1;
        return direction;
    }
    constexpr double kHalf = 0.5 * std::numbers::sqrt2;
    const uint32_t signs = (facing - kSides) % 4;
    direction[axis] = signs & 2 ? -kHalf : kHalf, direction[(axis + 1) % 3] = signs & 1 ? -kHalf : kHalf;
    return direction;
}

int axis_of(uint32_t facing) { return int(facing < kSides ? facing / 2 : (facing - kSides) / 4 + 1) % 3; }

CellCut CellCut::across(uint32_t way, double at, bool below) {
    const double step = at * kSteps - 0.5;
    const auto beyond = uint32_t(std::clamp(below ? std::ceil(step) : std::floor(step), 0.0, kSteps - 1.0));
    const uint32_t bits = way << 6u | (below ? kSteps : 0) | beyond;
    return {uint8_t(std::max(bits, 1u))};  // 0 is none
}

glm::dvec3 CellCut::direction(uint32_t way, uint32_t facing) {
    constexpr double kHalf = 0.5 * std::numbers::sqrt2;
    constexpr double kOf[kWays][2]{{1, 0}, {0, 1}, {kHalf, kHalf}, {kHalf, -kHalf}};
    glm::dvec3 direction(0);
    const int axis = axis_of(facing);
    direction[(axis + 1) % 3] = kOf[way][0], direction[(axis + 2) % 3] = kOf[way][1];
    return direction;
}

double CellCut::along(uint32_t way, glm::dvec3 point, uint32_t facing) {
    return glm::dot(point - 0.5, direction(way, facing)) + 0.5;
}

bool CellCut::has(glm::dvec3 point, uint32_t facing) const {
    if (!any()) return true;
    const double past = along(way(), point, facing) - (bits % kSteps + 0.5) / kSteps;
    return bits & kSteps ? past <= 0 : past >= 0;
}

glm::dvec3 CellCut::beyond(glm::dvec3 point, uint32_t facing) const {
    const glm::dvec3 from_middle = point - 0.5, away = (bits & kSteps ? 1.0 : -1.0) * direction(way(), facing);
    return glm::sign(from_middle) * glm::dvec3(glm::greaterThan(from_middle * away, glm::dvec3(0)));
}

CellGrid CellGrid::around(glm::dvec3 low, glm::dvec3 high, double least) {
    constexpr double kMostCubes = 0.75 * double(uint32_t(-1) / kFacings);  // the other numbers are enough for air
    constexpr double kMostAlong = 1 << 24;                                 // whole numbers of floats, for shaders
    for (CellGrid grid{.size = least};; grid.size *= std::numbers::sqrt2) {
        grid.origin = low - 0.5 * grid.size;
        const glm::dvec3 count = glm::floor(grid.place(high) + 0.5) + 1.0;  // half a cube at least beyond the box
        if (!(count.x * count.y * count.z <= kMostCubes && std::max({count.x, count.y, count.z}) <= kMostAlong))
            continue;
        grid.count = glm::uvec3(count);
        return grid;
    }
}

namespace {

std::optional<uint32_t> number_of(glm::dvec3 cube, glm::uvec3 count) {
    const glm::dvec3 most(count);
    for (int i = 0; i < 3; ++i)
        if (!(cube[i] >= 0 && cube[i] < most[i])) return std::nullopt;
    const glm::uvec3 at(cube);
    return (at.z * count.y + at.y) * count.x + at.x;
}

}  // namespace

std::optional<uint32_t> CellGrid::cell(glm::dvec3 cube, uint32_t facing) const {
    const std::optional<uint32_t> number = number_of(cube, count);
    return number ? std::optional(*number * kFacings + facing) : std::nullopt;
}

std::optional<uint32_t> CellGrid::cell_at(glm::dvec3 point, glm::dvec3 normal) const {
    return cell(place(point), facing_of(normal));
}

std::optional<uint32_t> CellGrid::air_cell(glm::dvec3 cube, uint32_t side) const {
    const std::optional<uint32_t> number = number_of(cube, air_count());
    return number ? std::optional(air_begins() + *number * kSides + side) : std::nullopt;
}

uint32_t CellGrid::air_cubes() const { return uint32_t(std::max(double(kLeastAirCubes), std::ceil(kAirSize / size))); }

glm::dvec3 CellGrid::middle(uint32_t cell) const {
    const glm::uvec3 of = is_air(cell) ? air_count() : count;
    const uint32_t cube = is_air(cell) ? (cell - air_begins()) / kSides : cell / kFacings;
    const glm::uvec3 at(cube % of.x, cube / of.x % of.y, cube / (of.x * of.y));
    return origin + (is_air(cell) ? air_cubes() : 1) * size * (glm::dvec3(at) + 0.5);
}

}  // namespace vesper::transport
