#include "transport/cell_places.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/gtc/packing.hpp>

#include "base/parallel.h"
#include "transport/placed_triangles.h"
#include "transport/reach.h"
#include "transport/sampling.h"

namespace vesper::transport {
namespace {

constexpr double kPlaceStep = 0.35;                // of a cube, between places that are looked for
constexpr double kFew = CellGrid::kLeastAirCubes;  // in larger cells one of so many places along each way is looked for
constexpr double kCovered = 0.06;                  // a surface so near before another is taken to lie on it, m
constexpr double kThinBody = 1.8;                  // cubes: their diagonal, and a little more
constexpr double kNearBy = 0.5;                    // of a cube
constexpr uint32_t kRaysToBacks = 4;               // from each place
constexpr double kLevel = 0.7;                     // cosine: ground and floors, with air over them
constexpr double kAirHeight = 4;                   // m, of that
constexpr double kPlacesOfPart = 4'096;            // which one thread finds, roughly
constexpr double kPlacesAtATime =
    100'000;  // that wait to be put together, some 100 bytes each, seven times over floors

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
    FoundPlace place;
};

// Finds the places of one part.
struct PlaceFinder {
    const rays::RayCaster& rays;
    const Surfaces& surfaces;
    const SurfaceCells& cells;
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
                const bool fine = cells.is_fine(c.at(hit.weights));
                // Of places in larger cells one stands for those of the strips and pieces after it.
                if (!fine && (std::fmod(strip, kFew) != 0 || std::fmod(piece, kFew) != 0)) continue;
                const double times = fine ? 1 : std::min(kFew, strips - strip) * std::min(kFew, pieces - piece);
                add_on_triangle(hit, c, times * area, part.of->double_sided, fine);
            }
        }
    }

    void add_on_triangle(const rays::Hit& hit, const Corners& c, double area, bool double_sided, bool fine) {
        const glm::dvec3 point = c.at(hit.weights);
        glm::dvec3 normal(0);
        for (int k = 0; k < 3; ++k) normal += hit.weights[k] * c.normals[size_t(k)];
        if (!(glm::length(normal) > 1e-12)) return;
        normal = glm::normalize(normal);
        const glm::dvec3 reflectance = surfaces.reflectance(hit);
        for (const glm::dvec3 outwards : {normal, -normal}) {
            const std::optional<double> open = open_before(point, outwards);
            if (const std::optional<uint32_t> number = cells.number(point, outwards)) {
                const Exposure exposure = open ? exposure_of(point, outwards) : Exposure::Covered;
                found.push_back({*number, {point, outwards, reflectance, hit.node, area, area, exposure}});
            }
            if (fine && open && outwards.y > kLevel) add_air(point, outwards, *open);
            if (!double_sided) break;
        }
    }

    // How far a surface sees along its normal, m; none if it is under another or within a body: what is there shows its
    // back. Bodies of double-sided sheets count where they are as thin as cells, whose places would be on both sides of
    // the sheet: elsewhere a back is a sheet that stands alone, as of a roof.
    std::optional<double> open_before(glm::dvec3 point, glm::dvec3 outwards) const {
        const std::optional<rays::Hit> hit =
            rays.nearest(point + skin_at(rays, point) * outwards, point + kReach * outwards);
        if (!hit) return kReach;
        const double open = hit->share * kReach;
        const bool within = surfaces.shows_back(*hit, point) && !stands_alone(*hit);
        return open < kCovered || within ? std::nullopt : std::optional(open);
    }
    bool stands_alone(const rays::Hit& hit) const {
        return surfaces.is_double_sided(hit) && hit.share * kReach >= kThinBody * cells.grid.size;
    }

    // So that places in relief count as often as they see what is far, and those within a body hardly ever, though one
    // of its parts hides its backs from some directions.
    Exposure exposure_of(glm::dvec3 point, glm::dvec3 outwards) {
        const glm::dvec3 start = point + skin_at(rays, point) * outwards;
        const glm::dvec2 chance{random.next(), random.next()};
        uint32_t backs = 0, sheets = 0, near = 0;
        for (uint32_t i = 0; i < kRaysToBacks; ++i) {
            const glm::dvec3 way = cosine_direction(outwards, glm::fract(chance + double(i) / kRaysToBacks));
            const std::optional<rays::Hit> hit = rays.nearest(start, start + kReach * way);
            if (!hit) continue;
            if (surfaces.shows_back(*hit, start)) ++(stands_alone(*hit) ? sheets : backs);
            if (i == 0 && hit->share * kReach < kNearBy * cells.grid.size) ++near;
        }
        if (2 * backs > kRaysToBacks) return Exposure::Covered;
        return backs + sheets > 0 ? Exposure::Partly : near > 0 ? Exposure::Near : Exposure::Open;
    }

    // Over ground and floors, where things move.
    void add_air(glm::dvec3 ground, glm::dvec3 up, double open) {
        const glm::dvec3 point = ground + std::min(random.next() * kAirHeight, 0.9 * open) * up;
        for (uint32_t side = 0; side < kSides; ++side)
            if (const std::optional<uint32_t> number = cells.air(point, side))
                found.push_back({*number, {point, direction_of(side), {}, scene::kNone, 1, 0, Exposure::Air}});
    }
};

}  // namespace

void add_place(CellPlaces& cell, const CellGrid& grid, uint32_t number, const FoundPlace& place) {
    if (cell.seen > 0 && place.exposure > cell.exposure) {
        if (place.exposure != Exposure::Covered) cell.area += place.area;
        return;
    }
    if (place.exposure < cell.exposure) cell = {.area = cell.exposure == Exposure::Covered ? 0 : cell.area};
    cell.exposure = place.exposure;
    // Any places are as likely to be kept (reservoir sampling: Vitter 1985).
    const uint32_t seen = cell.seen++;
    const uint64_t slot =
        seen < CellPlaces::kMost ? seen : Random((uint64_t{number} << 32u) + seen).next_bits() % (uint64_t{seen} + 1);
    if (slot < CellPlaces::kMost)
        cell.places[slot] = {glm::vec3(place.point - grid.middle(number)), glm::vec3(place.normal), place.node,
                             glm::packF3x9_E1x5(glm::vec3(place.reflectance)), float(place.weight)};
    cell.weight += place.weight, cell.area += place.area;
    cell.point += place.weight * (place.point - grid.middle(number));
    cell.normal += place.weight * place.normal, cell.reflectance += place.weight * place.reflectance;
}

void CellPlaces::keep(uint32_t which) {
    double before = 0;
    for (uint32_t i = 0; i < count(); ++i) before += double(places[i].weight);
    seen = 0, weight = 0, point = normal = reflectance = glm::dvec3(0);
    for (uint32_t bits = which; bits != 0; bits &= bits - 1) {
        const Place& kept = places[seen++] = places[size_t(std::countr_zero(bits))];
        const auto times = double(kept.weight);
        weight += times, point += times * glm::dvec3(kept.point), normal += times * glm::dvec3(kept.normal);
        reflectance += times * glm::dvec3(glm::unpackF3x9_E1x5(kept.reflectance));
    }
    area *= weight / before;
}

std::optional<PlacesByCell> find_places(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                        const rays::RayCaster& rays, const Surfaces& surfaces,
                                        const SurfaceCells& cells, size_t most,
                                        const std::function<bool(double)>& progress) {
    const double step = cells.grid.size * kPlaceStep;
    const std::vector<PlacedPrimitive> primitives = primitives_of(scene, world);
    const std::vector<Part> parts = parts_of(primitives, step);
    PlacesByCell by_cell;
    for (size_t first = 0, end = 0; first < parts.size() && by_cell.size() <= most; first = end) {
        for (double places = 0; end < parts.size() && places < kPlacesAtATime; ++end) places += parts[end].places;
        std::vector<std::vector<NumberedPlace>> found(end - first);
        const bool done = in_parallel(
            found.size(), 1,
            [&](size_t i, size_t) {
                PlaceFinder finder{rays, surfaces, cells, step, Random(first + i), {}};
                finder.look_at(parts[first + i]);
                found[i] = std::move(finder.found);
            },
            [&](size_t so_far) { return !progress || progress(double(first + so_far) / double(parts.size())); });
        if (!done) return std::nullopt;
        for (const std::vector<NumberedPlace>& of_part : found) {
            auto at = by_cell.end();
            for (const NumberedPlace& p : of_part) {
                if (at == by_cell.end() || at->first != p.number) at = by_cell.try_emplace(p.number).first;
                add_place(at->second, cells.grid, p.number, p.place);
            }
        }
    }
    return by_cell;
}

}  // namespace vesper::transport
