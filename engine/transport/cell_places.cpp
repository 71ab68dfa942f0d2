#include "transport/cell_places.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "transport/reach.h"
#include "transport/sampling.h"

namespace vesper::transport {
namespace {

constexpr double kPlaceStep = 0.35;      // of a cube, between places that are looked for
constexpr double kCovered = 0.06;        // a surface so near before another is taken to lie on it, m
constexpr double kLevel = 0.7;           // cosine: ground and floors, with air over them
constexpr double kAirHeight = 4;         // m, of that
constexpr double kPlacesOfPart = 4'096;  // which one thread finds, roughly
constexpr double kPlacesAtATime =
    100'000;  // that wait to be put together, some 100 bytes each, seven times over floors

constexpr double kMostCubesAlong = 1 << 17;  // an axis: so a strip of a triangle has places that memory holds

struct Corners {
    std::array<glm::dvec3, 3> points, normals;
    double area;

    double side(int from) const { return glm::distance(points[size_t(from)], points[size_t((from + 1) % 3)]); }
    int longest() const {  // the side, by where it begins
        int longest = 0;
        for (int k = 1; k < 3; ++k)
            if (side(k) > side(longest)) longest = k;
        return longest;
    }
};

// A primitive of a node.
struct PlacedPrimitive {
    const scene::Primitive& primitive;
    uint32_t node, number;
    bool double_sided;
    const glm::dmat4& world;
    glm::dmat3 turn;  // of normals

    uint32_t triangles() const { return uint32_t(primitive.indices.size() / 3); }
    // None of what rays do not meet either.
    std::optional<Corners> corners(uint32_t triangle) const {
        Corners c{};
        double farthest = 0;  // per axis, as rays/ has it
        for (size_t k = 0; k < 3; ++k) {
            const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(triangle) + k]];
            c.points[k] = glm::dvec3(world * glm::dvec4(vertex.position, 1));
            c.normals[k] = turn * glm::dvec3(vertex.normal);
            const glm::dvec3 a = glm::abs(c.points[k]);
            farthest = std::max({farthest, a.x, a.y, a.z});
        }
        c.area = 0.5 * glm::length(glm::cross(c.points[1] - c.points[0], c.points[2] - c.points[0]));
        if (!(c.area > 0 && farthest <= rays::kFarthest)) return std::nullopt;
        return c;
    }
};

std::vector<PlacedPrimitive> primitives_of(const scene::Scene& scene, std::span<const glm::dmat4> world) {
    std::vector<PlacedPrimitive> all;
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == scene::kNone) continue;
        const std::vector<scene::Primitive>& primitives = scene.meshes[scene.nodes[node].mesh].primitives;
        const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(world[node])));
        for (uint32_t p = 0; p < primitives.size(); ++p) {
            const scene::Material& material = scene.materials[primitives[p].material];
            if (!material.clear) all.push_back({primitives[p], node, p, material.double_sided, world[node], turn});
        }
    }
    return all;
}

// Some triangles of a primitive, or some strips of a large one.
struct Part {
    const PlacedPrimitive* of;
    uint32_t first, end;
    double places;  // at most, of one side
    double first_strip = 0, end_strip = 1e300;
};

double strips_of(const Corners& c, double step) { return std::ceil(2 * c.area / c.side(c.longest()) / step); }

std::vector<Part> parts_of(std::span<const PlacedPrimitive> primitives, double step) {
    std::vector<Part> parts;
    for (const PlacedPrimitive& primitive : primitives) {
        Part part{&primitive, 0, 0, 0};
        const auto end_part = [&](uint32_t next) {
            if (part.places > 0) parts.push_back(part);
            part = {&primitive, next, next, 0};
        };
        for (uint32_t t = 0; t < primitive.triangles(); ++t) {
            const std::optional<Corners> c = primitive.corners(t);
            if (!c) continue;
            const double strips = strips_of(*c, step), of_strip = std::ceil(c->side(c->longest()) / step);
            if (part.places + strips * of_strip > kPlacesOfPart) end_part(t);
            if (strips * of_strip > kPlacesOfPart) {
                const double some = std::max(std::floor(kPlacesOfPart / of_strip), 1.0);
                for (double strip = 0; strip < strips; strip += some)
                    parts.push_back({&primitive, t, t + 1, some * of_strip, strip, strip + some});
                end_part(t + 1);
            } else {
                part.end = t + 1, part.places += strips * of_strip;
            }
        }
        end_part(0);
    }
    return parts;
}

struct NumberedPlace {
    uint32_t number;  // of the cell
    bool covered;
    FoundPlace place;
};

// Finds the places of one part.
struct PlaceFinder {
    const rays::RayCaster& rays;
    const Surfaces& surfaces;
    const CellGrid& grid;
    double step;
    Random random;
    std::vector<NumberedPlace> found;

    void look_at(const Part& part) {
        for (uint32_t t = part.first; t < part.end; ++t)
            if (const std::optional<Corners> c = part.of->corners(t)) add_strips(part, t, *c);
        std::ranges::stable_sort(found, {}, &NumberedPlace::number);
    }

    // In strips along the longest side, at the middle of pieces.
    void add_strips(const Part& part, uint32_t triangle, const Corners& c) {
        rays::Hit hit{.share = 1, .node = part.of->node, .primitive = part.of->number, .triangle = triangle};
        const int p = c.longest();
        const double longest = c.side(p), strips = strips_of(c, step), end = std::min(strips, part.end_strip);
        for (double strip = part.first_strip; strip < end; ++strip) {
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
                add_on_triangle(hit, c, area, part.of->double_sided);
            }
        }
    }

    void add_on_triangle(const rays::Hit& hit, const Corners& c, double area, bool double_sided) {
        glm::dvec3 point(0), normal(0);
        for (int k = 0; k < 3; ++k)
            point += hit.weights[k] * c.points[size_t(k)], normal += hit.weights[k] * c.normals[size_t(k)];
        if (!(glm::length(normal) > 1e-12)) return;
        normal = glm::normalize(normal);
        const glm::dvec3 reflectance = surfaces.reflectance(hit);
        for (const glm::dvec3 outwards : {normal, -normal}) {
            const std::optional<double> open = open_before(point, outwards);
            if (const std::optional<uint32_t> number = grid.cell_at(point, outwards))
                found.push_back({*number, !open, {point, outwards, reflectance, hit.node, area, area}});
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
                found.push_back({*number, false, {point, direction_of(side), {}, scene::kNone, 1, 0}});
    }
};

}  // namespace

void add_place(CellPlaces& cell, const CellGrid& grid, uint32_t number, const FoundPlace& place, bool covered) {
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
    for (const PlacedPrimitive& primitive : primitives_of(scene, world))
        for (uint32_t t = 0; t < primitive.triangles(); ++t) {
            const std::optional<Corners> c = primitive.corners(t);
            if (!c) continue;
            for (const glm::dvec3 corner : c->points) low = glm::min(low, corner), high = glm::max(high, corner);
            area += primitive.double_sided ? 2 * c->area : c->area;
        }
    if (!(area > 0)) return std::nullopt;
    const glm::dvec3 extent = high - low;
    const double least = std::max(std::sqrt(area / double(settings.most_cells)),
                                  std::max({extent.x, extent.y, extent.z}) / kMostCubesAlong);
    double size = settings.cell_size;
    while (size < least) size *= std::numbers::sqrt2;
    return CellGrid::around(low, high, size);
}

std::optional<PlacesByCell> find_places(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                        const rays::RayCaster& rays, const Surfaces& surfaces, const CellGrid& grid,
                                        const std::function<bool(double)>& progress) {
    const double step = grid.size * kPlaceStep;
    const std::vector<PlacedPrimitive> primitives = primitives_of(scene, world);
    const std::vector<Part> parts = parts_of(primitives, step);
    PlacesByCell cells;
    for (size_t first = 0, end = 0; first < parts.size(); first = end) {
        for (double places = 0; end < parts.size() && places < kPlacesAtATime; ++end) places += parts[end].places;
        std::vector<std::vector<NumberedPlace>> found(end - first);
        const bool done = in_parallel(
            found.size(), 1,
            [&](size_t i, size_t) {
                PlaceFinder finder{rays, surfaces, grid, step, Random(first + i), {}};
                finder.look_at(parts[first + i]);
                found[i] = std::move(finder.found);
            },
            [&](size_t so_far) { return !progress || progress(double(first + so_far) / double(parts.size())); });
        if (!done) return std::nullopt;
        for (const std::vector<NumberedPlace>& of_part : found) {
            auto at = cells.end();
            for (const NumberedPlace& p : of_part) {
                if (at == cells.end() || at->first != p.number) at = cells.try_emplace(p.number).first;
                add_place(at->second, grid, p.number, p.place, p.covered);
            }
        }
    }
    return cells;
}

}  // namespace vesper::transport
