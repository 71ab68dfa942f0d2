#include "transport/sound_radiosity.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scene/scene.h"

namespace vesper::transport {
namespace {

bool is_within(double value, double low, double high) { return value >= low && value <= high; }

template <class List>
bool are_within(const List& list, double low, double high) {
    return std::ranges::all_of(list, [&](float value) { return is_within(value, low, high); });
}

bool are_within(const std::vector<glm::vec3>& list, double low, double high) {
    return std::ranges::all_of(list, [&](const glm::vec3& value) {
        return is_within(value.x, low, high) && is_within(value.y, low, high) && is_within(value.z, low, high);
    });
}

bool has_size(size_t size, std::initializer_list<size_t> allowed) {
    return std::ranges::find(allowed, size) != allowed.end();
}

constexpr double kFarthest = 1e9;  // m
constexpr double kRounding = 1e-3;

/// Cells that a grid numbers; 0: it is none.
uint64_t cells_of(const CellGrid& grid) {
    constexpr uint64_t kNumbers = uint64_t{1} << 32u;
    const auto cubes = [](glm::uvec3 count) {
        const uint64_t area = uint64_t{count.x} * count.y;
        return area == 0 || area >= kNumbers || count.z >= kNumbers / area ? 0 : area * count.z;
    };
    for (int axis = 0; axis < 3; ++axis)
        if (!is_within(grid.origin[axis], -kFarthest, kFarthest)) return 0;
    if (!is_within(grid.size, 1e-6, kFarthest)) return 0;
    const uint64_t surfaces = cubes(grid.count);
    if (surfaces == 0 || surfaces >= kNumbers / kFacings) return 0;
    // Without air_count(), whose sum may be too much for 32 bits.
    const uint64_t side = grid.air_cubes();
    uint64_t air = 1;
    for (int axis = 0; axis < 3; ++axis) air *= (grid.count[axis] + side - 1) / side;
    const uint64_t all = surfaces * kFacings + air * kSides;
    return all < kNumbers ? all : 0;
}

/// First indices of parts of a list of `size`, and its end.
bool part(const std::vector<uint32_t>& first, size_t cells, size_t size) {
    return first.size() == cells + 1 && first.front() == 0 && first.back() == size && std::ranges::is_sorted(first);
}

bool are_below(const std::vector<uint32_t>& indices, uint64_t end) {
    return std::ranges::all_of(indices, [end](uint32_t index) { return index < end; });
}

/// A half that is neither negative, infinite nor NaN.
bool is_share(uint16_t half) { return half < 0x7c00u; }

bool are_sound(const MovingBodies& bodies) {
    for (const OcclusionVolume& volume : bodies.volumes) {
        for (int axis = 0; axis < 3; ++axis)
            if (!is_within(volume.low[axis], -kFarthest, kFarthest) || volume.count[axis] == 0) return false;
        if (!is_within(volume.step, 1e-6, kFarthest)) return false;
        const uint64_t all = bodies.hidden.size(), area = uint64_t{volume.count.x} * volume.count.y;
        if (volume.first > all || area > all || volume.count.z > (all - volume.first) / area) return false;
    }
    for (const auto& sides : bodies.hidden)
        if (std::ranges::any_of(sides, [](uint8_t part) { return part > MovingBodies::kAll; })) return false;
    return std::ranges::all_of(bodies.bodies,
                               [&](const MovingBodies::Body& body) { return body.volume < bodies.volumes.size(); }) &&
           std::ranges::is_sorted(bodies.bodies, std::less_equal<>(), &MovingBodies::Body::node);
}

}  // namespace

bool is_sound(const Radiosity& r) {
    const size_t n = r.cells();
    if (n == 0) return r.sources.empty() && r.met.empty() && r.beside.empty() && are_sound(r.bodies);
    const uint64_t numbers = cells_of(r.grid);
    for (const size_t size : {r.heights.size(), r.areas.size(), r.normals.size(), r.reflectances.size(), r.sky.size()})
        if (size != n) return false;
    for (const size_t size : {r.walls.size(), r.steps.size(), r.cuts.size()})
        if (!has_size(size, {0, n})) return false;
    return r.numbers.back() < numbers &&
           std::ranges::adjacent_find(r.numbers, std::greater_equal<>()) == r.numbers.end() &&
           are_within(r.heights, -kFarthest, kFarthest) && are_within(r.areas, 0, kFarthest * kFarthest) &&
           are_within(r.normals, -1 - kRounding, 1 + kRounding) && are_within(r.reflectances, 0, 1 + kRounding) &&
           are_within(r.sky, -kRounding, 1 + kRounding) && part(r.first_source, n, r.sources.size()) &&
           part(r.first_met, n, r.met.size()) && are_below(r.met, n) && r.parts.size() == r.met.size() &&
           std::ranges::all_of(r.parts, is_share) && has_size(r.beside.size(), {0, n * Radiosity::kBeside}) &&
           are_below(r.beside, n) && are_sound(r.bodies);
}

bool names_nodes_of(const Radiosity& r, const scene::Scene& scene) {
    const size_t nodes = scene.nodes.size();
    return std::ranges::all_of(r.sources,
                               [&](const Radiosity::Source& source) {
                                   const uint32_t node = source.node & ~Radiosity::kLamp;
                                   if (node >= nodes) return false;
                                   const scene::Node& at = scene.nodes[node];
                                   return ((source.node & Radiosity::kLamp) != 0 ? at.lamp : at.mesh) != scene::kNone;
                               }) &&
           std::ranges::all_of(r.bodies.bodies, [&](const MovingBodies::Body& body) { return body.node < nodes; });
}

}  // namespace vesper::transport
