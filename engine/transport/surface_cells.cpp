#include "transport/surface_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/fixtures.h"
#include "transport/placed_triangles.h"

namespace vesper::transport {
namespace {

constexpr double kLeastSize = 1e-2;          // of cubes, m
constexpr double kMostCubesAlong = 1 << 17;  // an axis: so a strip of a triangle has places that memory holds
constexpr double kLargestEmitter = 8 * SurfaceCells::kRegion;  // m: larger ones, such as domes, are near to nothing
constexpr double kSampled = SurfaceCells::kRegion / 4;         // m, between places that areas are estimated by
constexpr double kMostSamples = 1e6;                           // of a triangle

// Of a triangle, the part for which `holds(point)`, by places in rows.
template <class Holds>
double part_of(const Corners& c, const Holds& holds) {
    const double rows = std::clamp(std::ceil(c.side(c.longest()) / kSampled), 1.0, std::sqrt(kMostSamples));
    double all = 0, found = 0;
    for (double i = 0; i < rows; ++i)
        for (double k = 0; k <= 2 * i; ++k) {
            // The middles of rows^2 equal triangles: upright ones, and between them the others.
            const double down = std::fmod(k, 2), b = (std::floor(k / 2) + (down != 0 ? 2 / 3.0 : 1 / 3.0)) / rows,
                         a = (i + (down != 0 ? 1 / 3.0 : 2 / 3.0)) / rows;
            found += holds(c.at({1 - a, a - b, b})) ? 1 : 0, ++all;
        }
    return found / all;
}

}  // namespace

// Two regions that share a number are both near: it costs cells, and is rare.
uint64_t SurfaceCells::region_of(glm::dvec3 point) const {
    const glm::dvec3 at = glm::floor((point - regions_from_) / kRegion);
    uint64_t number = 0;
    for (int axis = 0; axis < 3; ++axis) number = number * 0x9e3779b97f4a7c15 + uint64_t(int64_t(at[axis]));
    return number;
}

void SurfaceCells::add_near(glm::dvec3 low, glm::dvec3 high) {
    low -= kRegion, high += kRegion;
    for (double x = low.x; x < high.x + kRegion; x += kRegion)
        for (double y = low.y; y < high.y + kRegion; y += kRegion)
            for (double z = low.z; z < high.z + kRegion; z += kRegion)
                near_.insert(region_of(glm::min(glm::dvec3(x, y, z), high)));
}

double SurfaceCells::larger(double size) {
    const double next = std::numbers::sqrt2 * size;
    return size < kUsualSize ? std::min(next, kUsualSize) : next;
}

std::optional<SurfaceCells> SurfaceCells::of(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                             const Emitters& emitters, const RadiositySettings& settings) {
    const std::vector<PlacedPrimitive> primitives = primitives_of(scene, world);
    glm::dvec3 low(1e300), high(-1e300);
    const auto area_of = [&](auto weight) {
        double area = 0;
        for (const PlacedPrimitive& primitive : primitives)
            for (uint32_t t = 0; t < primitive.triangles(); ++t)
                if (const std::optional<Corners> c = primitive.corners(t))
                    area += (primitive.double_sided ? 2 : 1) * c->area * weight(*c);
        return area;
    };
    const double all = area_of([&](const Corners& c) {
        for (const glm::dvec3 corner : c.points) low = glm::min(low, corner), high = glm::max(high, corner);
        return 1.0;
    });
    if (!(all > 0)) return std::nullopt;
    SurfaceCells cells;
    cells.regions_from_ = low;
    double area = all;
    double size = settings.cell_size > kLeastSize ? settings.cell_size : kLeastSize;
    const double usual = std::max(size, kUsualSize);
    if (all > double(settings.most_cells) * usual * usual) {
        size = usual;
        for (const uint32_t node : scene::nodes_with_lamps(scene)) {
            const glm::dvec3 at(world[node][3]);
            const bool directional = scene.lamps[scene.nodes[node].lamp].kind == scene::Lamp::Kind::Directional;
            if (!directional && glm::all(glm::lessThan(glm::abs(at), glm::dvec3(rays::kFarthest))))
                cells.add_near(at, at);
        }
        for (const Emitters::Emitter& e : emitters.list()) {
            const auto& [a, b, c] = e.corners;
            const glm::dvec3 least = glm::min(a, glm::min(b, c)), most = glm::max(a, glm::max(b, c));
            if (glm::distance(least, most) < kLargestEmitter) cells.add_near(least, most);
        }
        cells.all_fine_ = cells.near_.empty();
        constexpr double kFewer = 1.0 / (CellGrid::kLeastAirCubes * CellGrid::kLeastAirCubes);
        if (!cells.all_fine_)
            area = area_of([&](const Corners& c) {
                const double fine = part_of(c, [&](glm::dvec3 point) { return cells.is_fine(point); });
                return fine + kFewer * (1 - fine);
            });
    }
    const glm::dvec3 extent = high - low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    while (area > double(most(settings, size)) * size * size || longest > kMostCubesAlong * size) size = larger(size);
    // Cubes that are larger because numbers would not fit are no small ones.
    for (cells.grid = CellGrid::around(low, high, size); cells.grid.size > size && size < kUsualSize;
         cells.grid = CellGrid::around(low, high, size))
        size = larger(size);
    return cells;
}

}  // namespace vesper::transport
