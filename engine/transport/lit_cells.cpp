#include "transport/lit_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/sampling.h"

namespace vesper::transport {
namespace {

constexpr size_t kMostCones = 64;
constexpr double kNarrow = 0.05;      // radius over distance: cubes that are as narrow stay whole
constexpr double kLeastPart = 0.005;  // of all light: cubes that give less stay whole
constexpr double kOfCell = 0.75;      // of a cube: radius of a sphere around the surfaces in it
constexpr double kBent = 0.3;         // of the width of a cube: cosines that differ by less within it count

// Every third bit.
uint64_t spread(uint64_t bits) {
    uint64_t spread = 0;
    for (uint32_t k = 0; k < 21; ++k) spread |= (bits >> k & 1u) << 3 * k;
    return spread;
}

}  // namespace

void RayGuide::add(glm::dvec3 axis, double cosine, double weight) {
    cones_.push_back({axis, cosine, weight + (cones_.empty() ? 0 : cones_.back().end)});
}

glm::dvec3 RayGuide::direction(glm::dvec2 chance) const {
    const double wanted = chance.x * cones_.back().end;
    auto cone = std::ranges::upper_bound(cones_, wanted, {}, &Cone::end);
    if (cone == cones_.end()) --cone;
    const double begin = cone == cones_.begin() ? 0 : std::prev(cone)->end;
    const double left = std::clamp((wanted - begin) / (cone->end - begin), 0.0, 1.0);
    const double cosine = 1 - left * (1 - cone->cosine), sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    return direction_about(cone->axis, sine, cosine, 2 * std::numbers::pi * chance.y);
}

double RayGuide::density(glm::dvec3 direction) const {
    double sum = 0, before = 0;
    for (const Cone& cone : cones_) {
        if (glm::dot(cone.axis, direction) >= cone.cosine) sum += (cone.end - before) / (1 - cone.cosine);
        before = cone.end;
    }
    return cones_.empty() ? 0 : sum / (2 * std::numbers::pi * cones_.back().end);
}

LitCells::LitCells(const CellGrid& grid, std::span<const Cell> cells) {
    struct Keyed {
        uint64_t key;
        Node node;
    };
    std::vector<Keyed> level;
    for (const Cell& cell : cells) {
        const glm::dvec3 cube = glm::floor(grid.place(grid.middle(cell.number)));
        Keyed leaf{spread(uint64_t(cube.x)) | spread(uint64_t(cube.y)) << 1u | spread(uint64_t(cube.z)) << 2u,
                   {cell.place, kOfCell * grid.size, {}, 0, 0}};
        const glm::dvec3 direction = direction_of(grid.facing(cell.number));
        for (int axis = 0; axis < 3; ++axis)
            leaf.node.fluxes[size_t(2 * axis + (direction[axis] < 0 ? 1 : 0))] = std::abs(direction[axis]) * cell.flux;
        level.push_back(leaf);
    }
    std::ranges::stable_sort(level, {}, &Keyed::key);
    // Cells of one cube are one; then cubes of one larger cube, until there is one.
    for (bool first = true; first || level.size() > 1; first = false) {
        std::vector<Keyed> above;
        for (size_t i = 0; i < level.size();) {
            Keyed joined{first ? level[i].key : level[i].key >> 3u, {glm::dvec3(0), 0, {}, uint32_t(nodes_.size()), 0}};
            size_t end = i;
            double flux = 0;
            for (; end < level.size() && (first ? level[end].key : level[end].key >> 3u) == joined.key; ++end) {
                const Node& part = level[end].node;
                double of_part = 0;
                for (uint32_t side = 0; side < kSides; ++side)
                    joined.node.fluxes[side] += part.fluxes[side], of_part += part.fluxes[side];
                joined.node.centre += of_part * part.centre, flux += of_part;
                if (!first) nodes_.push_back(part), ++joined.node.count;
            }
            joined.node.centre /= flux;
            for (; i < end; ++i)
                joined.node.radius = std::max(
                    joined.node.radius, glm::distance(joined.node.centre, level[i].node.centre) + level[i].node.radius);
            above.push_back(joined);
        }
        level = std::move(above);
        if (level.empty()) return;
    }
    nodes_.push_back(level[0].node);
}

// About the illuminance, lx; 0 where it gives none, or is too near.
double LitCells::light_of(const Node& node, const Patch& patch) {
    const glm::dvec3 to = node.centre - patch.middle;
    const double away = glm::length(to), reach = node.radius + patch.across();
    if (!(away > reach)) {
        if (node.count == 0) return 0;
        double flux = 0;
        for (const double of_side : node.fluxes) flux += of_side;
        return flux / (node.radius * node.radius);
    }
    const glm::dvec3 way = to / away;
    const double width = reach / away, cosine = glm::dot(patch.normal, way);
    if (cosine < -width) return 0;
    double leaving = 0;
    for (uint32_t side = 0; side < kSides; ++side)
        leaving += node.fluxes[side] * std::max((side % 2 ? 1 : -1) * way[int(side / 2)] + kBent * width, 0.0);
    return leaving * (std::max(cosine, 0.0) + kBent * width) / (std::numbers::pi * away * away);
}

RayGuide LitCells::guide(const Patch& patch) const {
    struct Open {
        double light;
        const Node* node;
        bool whole;  // it stays as it is
    };
    RayGuide guide;
    if (nodes_.empty()) return guide;
    std::vector<Open> open;
    double all = 0;
    const auto add = [&](const Node& node) {
        const double light = light_of(node, patch);
        const bool narrow = node.radius < kNarrow * glm::distance(node.centre, patch.middle);
        if (light > 0) open.push_back({light, &node, narrow || node.count == 0}), all += light;
    };
    add(nodes_.back());
    while (open.size() < kMostCones) {
        Open* widest = nullptr;
        for (Open& one : open)
            if (!one.whole && (!widest || one.light > widest->light)) widest = &one;
        if (!widest || widest->light < kLeastPart * all) break;
        const Open whole = *widest;
        *widest = open.back(), open.pop_back(), all -= whole.light;
        for (uint32_t i = 0; i < whole.node->count; ++i) add(nodes_[whole.node->first + i]);
    }
    for (const Open& one : open) {
        const glm::dvec3 to = one.node->centre - patch.middle;
        const double away = glm::length(to), sine = (one.node->radius + patch.across()) / away;
        if (sine < 1) guide.add(to / away, std::sqrt(1 - sine * sine), one.light);
    }
    return guide;
}

}  // namespace vesper::transport
