#include "transport/cell_places.h"

#include <cmath>
#include <numbers>

#include "transport/reach.h"
#include "transport/sampling.h"

namespace vesper::transport {
namespace {

constexpr double kPlaceStep = 0.35;  // of a cube, between places that are looked for
constexpr double kCovered = 0.06;    // a surface so near before another is taken to lie on it, m
constexpr double kLevel = 0.7;       // cosine: ground and floors, with air over them
constexpr double kAirHeight = 4;     // m, of that

struct Corners {
    std::array<glm::dvec3, 3> points, normals;
    double area;

    double side(int from) const { return glm::distance(points[size_t(from)], points[size_t((from + 1) % 3)]); }
};

template <class Take>
void each_triangle(const scene::Scene& scene, std::span<const glm::dmat4> world, Take take) {
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == scene::kNone) continue;
        const scene::Mesh& mesh = scene.meshes[scene.nodes[node].mesh];
        const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(world[node])));
        for (uint32_t p = 0; p < mesh.primitives.size(); ++p) {
            const scene::Primitive& primitive = mesh.primitives[p];
            const scene::Material& material = scene.materials[primitive.material];
            if (material.clear) continue;
            for (uint32_t t = 0; 3 * size_t(t) < primitive.indices.size(); ++t) {
                Corners c{};
                for (size_t k = 0; k < 3; ++k) {
                    const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(t) + k]];
                    c.points[k] = glm::dvec3(world[node] * glm::dvec4(vertex.position, 1));
                    c.normals[k] = turn * glm::dvec3(vertex.normal);
                }
                c.area = 0.5 * glm::length(glm::cross(c.points[1] - c.points[0], c.points[2] - c.points[0]));
                double farthest = 0;  // per axis, as rays/ has it
                for (const glm::dvec3 corner : c.points) {
                    const glm::dvec3 a = glm::abs(corner);
                    farthest = std::max({farthest, a.x, a.y, a.z});
                }
                if (c.area > 0 && farthest <= rays::kFarthest)
                    take(rays::Hit{.share = 1, .node = node, .primitive = p, .triangle = t}, c, material.double_sided);
            }
        }
    }
}

struct PlaceFinder {
    const rays::RayCaster& rays;
    const Surfaces& surfaces;
    const CellGrid& grid;
    PlacesByCell cells;
    Random random{0};

    // In strips along the longest side, at the middle of pieces.
    void add_triangle(rays::Hit hit, const Corners& c, bool double_sided) {
        const double step = grid.size * kPlaceStep;
        int p = 0;  // where the longest side begins
        for (int k = 1; k < 3; ++k)
            if (c.side(k) > c.side(p)) p = k;
        const double longest = c.side(p);
        const double strips = std::ceil(2 * c.area / longest / step);
        for (double strip = 0; strip < strips; ++strip) {
            // Of the way from that side to the other corner.
            const double from = strip / strips, to = (strip + 1) / strips, width = to - from,
                         squares = (to * to - from * from) / 2, cubes = (to * to * to - from * from * from) / 3,
                         middle = (squares - cubes) / (width - squares);
            const double pieces = std::max(std::ceil(longest * (1 - middle) / step), 1.0);
            const double area = c.area * 2 * (width - squares) / pieces;
            for (double piece = 0; piece < pieces; ++piece) {
                const double along_it = (piece + 0.5) / pieces;
                hit.weights[p] = (1 - middle) * (1 - along_it);
                hit.weights[(p + 1) % 3] = (1 - middle) * along_it, hit.weights[(p + 2) % 3] = middle;
                add_on_triangle(hit, c, area, double_sided);
            }
        }
    }

    void add_on_triangle(const rays::Hit& hit, const Corners& c, double area, bool double_sided) {
        glm::dvec3 point(0), normal(0);
        for (int k = 0; k < 3; ++k)
            point += hit.weights[k] * c.points[size_t(k)], normal += hit.weights[k] * c.normals[size_t(k)];
        if (!(glm::length(normal) > 1e-12)) return;
        normal = glm::normalize(normal);
        const glm::dvec3 reflectance = surfaces.at(hit, point + normal).reflectance;
        for (const glm::dvec3 outwards : {normal, -normal}) {
            const std::optional<double> open = open_before(point, outwards);
            if (const std::optional<uint32_t> number = grid.cell_at(point, outwards))
                add_place(cells, grid, *number, {point, outwards, reflectance, hit.node, area, area}, !open);
            if (open && outwards.y > kLevel) add_air(point, outwards, *open);
            if (!double_sided) break;
        }
    }

    // How far a surface sees along its normal, m; none if it is under another or within a body: what is there shows its
    // back.
    std::optional<double> open_before(glm::dvec3 point, glm::dvec3 outwards) const {
        const std::optional<rays::Hit> hit =
            rays.nearest(point + skin_at(rays, point) * outwards, point + kReach * outwards);
        if (!hit) return kReach;
        if (hit->share * kReach < kCovered || !surfaces.shows_front(*hit, point)) return std::nullopt;
        return hit->share * kReach;
    }

    // Over ground and floors, where things move.
    void add_air(glm::dvec3 ground, glm::dvec3 up, double open) {
        const glm::dvec3 point = ground + std::min(random.next() * kAirHeight, 0.9 * open) * up;
        const glm::dvec3 cube = grid.place(point) / double(CellGrid::kAir);
        for (uint32_t side = 0; side < kSides; ++side)
            if (const std::optional<uint32_t> number = grid.air_cell(cube, side))
                add_place(cells, grid, *number, {point, direction_of(side), {}, scene::kNone, 1, 0}, false);
    }
};

}  // namespace

void add_place(PlacesByCell& cells, const CellGrid& grid, uint32_t number, const FoundPlace& place, bool covered) {
    CellPlaces& cell = cells[number];
    if (covered && cell.seen > 0 && !cell.covered) return;
    if (!covered && cell.covered) cell = {};
    cell.covered = covered;
    // Any places are as likely to be kept (reservoir sampling: Vitter 1985).
    const uint32_t seen = cell.seen++;
    const uint64_t slot =
        seen < CellPlaces::kMost ? seen : Random((uint64_t{number} << 32u) + seen).next_bits() % (uint64_t{seen} + 1);
    if (slot < CellPlaces::kMost)
        cell.places[slot] = {glm::vec3(place.point - grid.middle(number)), glm::vec3(place.normal), place.node};
    cell.weight += place.weight, cell.area += place.area;
    cell.height += place.weight * grid.height(number, place.point);
    cell.normal += place.weight * place.normal, cell.reflectance += place.weight * place.reflectance;
}

std::optional<CellGrid> grid_around(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                    const RadiositySettings& settings) {
    glm::dvec3 low(1e300), high(-1e300);
    double area = 0;
    each_triangle(scene, world, [&](const rays::Hit&, const Corners& c, bool double_sided) {
        for (const glm::dvec3 corner : c.points) low = glm::min(low, corner), high = glm::max(high, corner);
        area += double_sided ? 2 * c.area : c.area;
    });
    if (!(area > 0)) return std::nullopt;
    const double least = std::sqrt(area / double(settings.most_cells));
    double size = settings.cell_size;
    while (size < least) size *= std::numbers::sqrt2;
    return CellGrid::around(low, high, size);
}

PlacesByCell find_places(const scene::Scene& scene, std::span<const glm::dmat4> world, const rays::RayCaster& rays,
                         const Surfaces& surfaces, const CellGrid& grid) {
    PlaceFinder finder{rays, surfaces, grid, {}};
    each_triangle(scene, world, [&finder](const rays::Hit& hit, const Corners& c, bool double_sided) {
        finder.add_triangle(hit, c, double_sided);
    });
    return std::move(finder.cells);
}

}  // namespace vesper::transport
