#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "base/luminance.h"
#include "base/parallel.h"
#include "transport/cell_places.h"
#include "transport/cut_cells.h"
#include "transport/emitters.h"
#include "transport/lamp_light.h"
#include "transport/lit_cells.h"
#include "transport/patch.h"
#include "transport/radiosity.h"
#include "transport/reach.h"
#include "transport/sampling.h"
#include "transport/sight.h"
#include "transport/surfaces.h"

namespace vesper::transport {
namespace {

constexpr double kPlacesShare = 0.08;  // of the time
constexpr double kLampsShare = 0.3;    // of that of a round
constexpr double kAtEmitter = 1e-3;    // m
constexpr uint32_t kMostRounds = 4;
constexpr double kRegion = 16;          // cubes: cells in one see about the same emitters
constexpr double kRegionOfAir = 4;      // cubes of air
constexpr uint32_t kFewer = 4;          // times fewer rays and looks of cells that only rays find
constexpr double kMostOverfull = 1.5;   // times as many cells as settings say
constexpr double kMostRays = 4;         // times as many as settings say
constexpr double kKeptSources = 0.999;  // of the light of a cell
constexpr uint32_t kUsedPlaces = 4;     // of a cell
constexpr double kGuided = 0.5;         // of the rays of a cell, where lamps light others

using Light = std::vector<std::pair<uint32_t, glm::dvec3>>;  // by source, lx

void add_to(Light& light, uint32_t source, glm::dvec3 lux) {
    for (auto& [known, sum] : light)
        if (known == source) {
            sum += lux;
            return;
        }
    light.emplace_back(source, lux);
}

// The strongest ones, made as strong as all.
void keep_strongest(Light& light, std::vector<Radiosity::Source>& to) {
    std::ranges::sort(light, [](const auto& a, const auto& b) {
        const double of_a = luminance(a.second), of_b = luminance(b.second);
        return of_a != of_b ? of_a > of_b : a.first < b.first;
    });
    glm::dvec3 all(0), kept(0);
    for (const auto& [node, lux] : light) all += lux;
    size_t count = 0;
    while (count < light.size() && luminance(kept) < kKeptSources * luminance(all)) kept += light[count++].second;
    const double factor = luminance(kept) > 0 ? luminance(all) / luminance(kept) : 0;
    for (size_t i = 0; i < count; ++i)
        to.push_back(
            {light[i].first, glm::packF3x9_E1x5(glm::vec3(factor / Radiosity::kPackedUnit * light[i].second))});
}

struct Gathering {
    const scene::Scene& scene;
    RadiositySettings settings;
    std::vector<glm::dmat4> world;
    rays::RayCaster rays;
    Surfaces surfaces;
    Emitters emitters;
    LampLight lamps;
    SurfaceCells surface_cells;
    CellGrid grid;                               // of those
    std::vector<uint32_t> known;                 // numbers of cells of all rounds so far, ascending
    std::unordered_map<uint32_t, CellCut> cuts;  // of those that have one
    LitCells lit;                                // of the first round

    Gathering(const scene::Scene& of, std::span<const glm::dmat4> at, const std::vector<bool>& moving,
              const RadiositySettings& with)
        : scene(of),
          settings(with),
          world(without_moving(at, moving)),
          rays(of, world),
          surfaces(of, world),
          emitters(of, world, surfaces),
          lamps(of, world, rays) {}

    // What the rays of some cells found.
    struct Round {
        std::vector<uint32_t> numbers;
        std::vector<CellPlaces> cells;
        std::vector<float> sky;
        struct Region {
            std::vector<uint32_t> cells;
            std::vector<uint32_t> counts;  // of sources of each
            std::vector<Radiosity::Source> sources;
            std::vector<uint32_t> lamp_counts;  // likewise, of lamps alone
            std::vector<Radiosity::Source> lamps;
            std::vector<uint32_t> met_counts;  // of cells that the rays of each met
            std::vector<uint32_t> met;         // numbers
            std::vector<uint16_t> parts;       // as Radiosity::parts
            std::vector<FoundPlace> places;    // where rays met what is no cell yet
        };
        std::vector<Region> regions;
    };

    void make_regions(Round& round) const {
        std::map<std::array<uint32_t, 4>, std::vector<uint32_t>> found;
        for (uint32_t i = 0; i < round.numbers.size(); ++i) {
            const bool air = grid.is_air(round.numbers[i]);
            const double wide = air ? kRegionOfAir * grid.air_cubes() : kRegion;
            const glm::uvec3 at(grid.place(grid.middle(round.numbers[i])) / wide);
            found[{at.z, at.y, at.x, grid.facing(round.numbers[i]) + (air ? kFacings : 0)}].push_back(i);
        }
        for (auto& [key, cells] : found) round.regions.push_back({.cells = std::move(cells)});
    }

    // Before a place of a cell: looks and rays from there.
    struct Start {
        glm::dvec3 point, normal;
        const EmitterChoice& choice;
        const RayGuide& guide;
        uint32_t looks, rays, guided;  // guided: rays besides those by cosines
    };

    // Of guided rays in a direction, 1/sr; of all rays; and of looks and rays at a place on an emitter.
    static double density_of_guided(const Start& start, glm::dvec3 direction) {
        return start.guided > 0 ? start.guided * start.guide.density(direction) : 0;
    }
    static double density_of_rays(const Start& start, double cosine, double of_guided) {
        return start.rays * cosine / std::numbers::pi + of_guided;
    }
    static double density(const Start& start, size_t emitter, glm::dvec3 to, double of_rays) {
        return start.looks * start.choice.density(emitter, to) + of_rays;
    }

    // At an emitter by chance: which, and its light, lx.
    std::pair<size_t, glm::dvec3> look(const Start& start, glm::dvec2 chance) const {
        const glm::dvec3 none(0);
        const size_t number = start.choice.choose(chance.x);
        const Emitters::Emitter& e = emitters.list()[number];
        const auto [place, wanted] = emitters.place_on(number, chance);
        const glm::dvec3 to = place - start.point;
        const double distance = glm::length(to), cosine = glm::dot(start.normal, to) / distance;
        const bool front = e.double_sided || glm::dot(e.outwards, to) < 0;
        if (!front || !(cosine > 0) || !(distance < kReach)) return {number, none};
        // Nothing before it, and it has no hole there.
        const double skin = std::min(1e-3, kAtEmitter / distance);
        if (rays.blocked(start.point, start.point + (1 - skin) * to) || !surfaces.stops_light(wanted))
            return {number, none};
        const glm::dvec3 emission = surfaces.emission(wanted, start.point);
        const double of_rays = density_of_rays(start, cosine, density_of_guided(start, to / distance));
        return {number, cosine / density(start, number, to, of_rays) * emission};
    }

    // A ray, and what it met.
    struct Sent {
        std::optional<uint32_t> met;  // number
        double part = 0;              // of the light of what it met that it brings
        bool guided = false;          // guided ones go there, too
        bool to_sky = false;
    };

    Sent send(const Start& start, glm::dvec3 direction, double share, Light& meshes,
              std::vector<FoundPlace>& places) const {
        const double cosine = glm::dot(start.normal, direction);
        if (!(cosine > 0)) return {};
        const double of_guided = density_of_guided(start, direction),
                     of_rays = density_of_rays(start, cosine, of_guided);
        Sent sent{.part = share * cosine / (std::numbers::pi * of_rays), .guided = of_guided > 0};
        const std::optional<rays::Hit> hit = rays.nearest(start.point, start.point + kReach * direction);
        if (!hit) {
            sent.to_sky = true;
            return sent;
        }
        const SurfacePoint surface = surfaces.emitted(*hit, start.point);
        if (surface.emission != glm::dvec3(0))
            if (const std::optional<size_t> number = emitters.find(*hit)) {
                const glm::dvec3 to = surface.position - start.point;
                add_to(meshes, hit->node, share * cosine / density(start, *number, to, of_rays) * surface.emission);
            }
        const std::optional<uint32_t> cell = cell_at(surface.position, surface.normal);
        if (!cell) return sent;
        if (!std::ranges::binary_search(known, *cell))
            places.push_back(
                {surface.position, surface.normal, surfaces.reflectance(*hit), hit->node, 1, 0, Exposure::Open});
        sent.met = *cell;
        return sent;
    }

    // Where a cut parts a point from the cell of its cube, the one beyond.
    std::optional<uint32_t> cell_at(glm::dvec3 point, glm::dvec3 normal) const {
        const std::optional<uint32_t> cell = surface_cells.number(point, normal);
        const auto cut = cell ? cuts.find(*cell) : cuts.end();
        if (cut == cuts.end()) return cell;
        const uint32_t facing = grid.facing(*cell);
        const glm::dvec3 place = grid.place(point), in_cube = glm::fract(place);
        if (cut->second.has(in_cube, facing)) return cell;
        const std::optional<uint32_t> other = grid.cell(place + cut->second.beyond(in_cube, facing), facing);
        return other && std::ranges::binary_search(known, *other) ? other : cell;
    }

    // All parts together are 1: guided rays know best how much is where they go, and the others bring the rest.
    static void balance(std::vector<Sent>& all) {
        double guided = 0, others = 0;
        for (const Sent& sent : all) (sent.guided ? guided : others) += sent.part;
        const double of_guided = guided > 0 && (guided > 1 || others == 0) ? 1 / guided : 1,
                     of_others = others > 0 ? std::max(1 - guided, 0.0) / others : 1;
        for (Sent& sent : all) sent.part *= sent.guided ? of_guided : of_others;
    }

    // Each cell once.
    static void keep_met(std::vector<Sent>& sent, Round::Region& region) {
        std::erase_if(sent, [](const Sent& one) { return !one.met || !(one.part > 0); });
        std::ranges::stable_sort(sent, {}, &Sent::met);
        const size_t before = region.met.size();
        for (auto one = sent.begin(); one != sent.end();) {
            const uint32_t number = *one->met;
            double part = 0;
            for (; one != sent.end() && *one->met == number; ++one) part += one->part;
            region.met.push_back(number);
            region.parts.push_back(glm::packHalf1x16(float(part) / Radiosity::kPartUnit));
        }
        region.met_counts.push_back(uint32_t(region.met.size() - before));
    }

    // Of a cell: some of its places, before its surfaces.
    std::vector<SurfacePlace> places_of(const Round& round, size_t i) const {
        const CellPlaces& cell = round.cells[i];
        std::vector<SurfacePlace> places;
        const uint32_t used = std::min(cell.count(), kUsedPlaces);
        for (uint32_t k = 0; k < used; ++k) {
            const CellPlaces::Place& place = cell.places[(2 * k + 1) * cell.count() / (2 * used)];
            const glm::dvec3 point = grid.middle(round.numbers[i]) + glm::dvec3(place.point),
                             normal = glm::normalize(glm::dvec3(place.normal));
            places.push_back({point + skin_at(rays, point) * normal, normal, place.node});
        }
        return places;
    }

    void gather_lamps(const Round& round, Round::Region& region, uint32_t shadow_rays) const {
        std::vector<LampLight::Share> shares;
        for (const uint32_t i : region.cells) {
            Random random(~uint64_t{round.numbers[i]});
            shares.clear();
            lamps.sample(places_of(round, i), shadow_rays, random, shares);
            Light light;
            for (const LampLight::Share& s : shares) add_to(light, s.node | Radiosity::kLamp, s.lux);
            const size_t before = region.lamps.size();
            keep_strongest(light, region.lamps);
            region.lamp_counts.push_back(uint32_t(region.lamps.size() - before));
        }
    }

    // From the light of lamps on the cells of a round.
    LitCells lit_cells(const Round& round) const {
        std::vector<LitCells::Cell> cells;
        for (const Round::Region& region : round.regions) {
            auto source = region.lamps.begin();
            for (size_t k = 0; k < region.cells.size(); ++k) {
                const uint32_t number = round.numbers[region.cells[k]];
                const CellPlaces& cell = round.cells[region.cells[k]];
                glm::dvec3 lux(0);
                for (const auto end = source + region.lamp_counts[k]; source != end; ++source)
                    lux += source->illuminance();
                const double flux = cell.area * luminance(lux * cell.reflectance / cell.weight);
                if (flux > 0 && !grid.is_air(number))
                    cells.push_back({number, grid.middle(number) + cell.point / cell.weight, flux});
            }
        }
        std::ranges::sort(cells, {}, &LitCells::Cell::number);
        return LitCells(grid, cells);
    }

    void gather(Round& round, Round::Region& region, uint32_t fewer) const {
        Sight sight(emitters.groups().size());
        auto lamp = region.lamps.begin();
        for (size_t k = 0; k < region.cells.size(); ++k) {
            const size_t before = region.sources.size();
            region.sources.insert(region.sources.end(), lamp, lamp + region.lamp_counts[k]);
            lamp += region.lamp_counts[k];
            gather(round, region.cells[k], fewer, sight, region);
            region.counts.push_back(uint32_t(region.sources.size() - before));
            sight.end_cell();
        }
    }

    void gather(Round& round, size_t i, uint32_t fewer, Sight& sight, Round::Region& region) const {
        const uint32_t number = round.numbers[i];
        const std::vector<SurfacePlace> places = places_of(round, i);
        const uint32_t count = std::min(uint32_t(places.size()), std::max(settings.rays, 1u));
        const Patch patch = Patch::around(places);
        const EmitterChoice choice(emitters, patch, sight.shares());
        const RayGuide guide = lit.guide(patch);
        // Of each place; parts of a lattice that follow each other fill the square evenly, each and together.
        const uint32_t looks = choice.any() ? std::max(settings.looks / fewer / count, 1u) : 0,
                       rays_sent = std::max(settings.rays / fewer, std::min(settings.rays, count)),
                       guided = guide.any() ? uint32_t(kGuided * (rays_sent / count)) : 0;
        Random random(number);
        const Lattice of_looks(random), directions(random), of_guided(random);
        Light meshes;
        std::vector<Sent> sent;
        const double share = 1.0 / count;
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t first_ray = rays_sent * k / count, end_ray = rays_sent * (k + 1) / count;
            const Start start{places[k].point, places[k].normal, choice, guide, looks, end_ray - first_ray - guided,
                              guided};
            for (uint32_t l = looks * k; l < looks * (k + 1); ++l) {
                const auto [emitter, light] = look(start, of_looks.at(l));
                const bool is_seen = light != glm::dvec3(0);
                sight.add(emitters.group_of(emitter), is_seen);
                if (is_seen) add_to(meshes, emitters.list()[emitter].node, share * light);
            }
            for (uint32_t r = first_ray; r < end_ray; ++r) {
                const uint32_t of_place = r - first_ray;
                const glm::dvec3 direction = of_place < guided
                                                 ? guide.direction(of_guided.at(guided * k + of_place))
                                                 : cosine_direction(start.normal, directions.at(r - guided * (k + 1)));
                sent.push_back(send(start, direction, share, meshes, region.places));
            }
        }
        balance(sent);
        for (const Sent& one : sent)
            if (one.to_sky) round.sky[i] += float(one.part);
        keep_met(sent, region);
        keep_strongest(meshes, region.sources);
    }

    // Finds cubes, and the places in them; none where `progress` ends it. Where surfaces are small there are more cells
    // than their area says; small cubes have two tries.
    std::optional<PlacesByCell> size_cells(const std::function<bool(double)>& progress) {
        RadiositySettings sized = settings;
        for (int tries = 1;; ++tries) {
            std::optional<SurfaceCells> found = SurfaceCells::of(scene, world, emitters, sized);
            if (!found) return PlacesByCell();
            surface_cells = std::move(*found), grid = surface_cells.grid;
            const double most = kMostOverfull * double(SurfaceCells::most(settings, grid.size));
            double done = 1;
            std::optional<PlacesByCell> places =
                find_places(scene, world, rays, surfaces, surface_cells, size_t(most), [&](double share) {
                    done = share;
                    return !progress || progress(kPlacesShare * share);
                });
            if (!places || double(places->size()) <= most) return places;
            sized.cell_size = SurfaceCells::larger(grid.size);
            if (!(grid.size < SurfaceCells::kUsualSize)) continue;
            const double fits = grid.size * std::sqrt(double(places->size()) / std::max(done, 1e-3) / most);
            sized.cell_size = tries > 1 ? SurfaceCells::kUsualSize
                                        : std::min(std::max(sized.cell_size, fits), SurfaceCells::kUsualSize);
        }
    }

    std::optional<Radiosity> run(const std::function<bool(double)>& progress) {
        Radiosity result;
        result.first_source.push_back(0), result.first_met.push_back(0);
        std::optional<PlacesByCell> places = size_cells(progress);
        if (!places) return std::nullopt;
        // Where there are few cells there is time for more rays of each.
        const double cells_now = double(std::max<size_t>(places->size(), 1)),
                     more = std::clamp(double(settings.fine_cells) / cells_now, 1.0, kMostRays);
        for (uint32_t* count : {&settings.rays, &settings.looks, &settings.lamp_rays})
            *count = uint32_t(std::min(more * double(*count), double(uint32_t(-1))));
        PlacesByCell wanted = std::move(*places);
        std::vector<Round> rounds;
        while (!wanted.empty() && rounds.size() < kMostRounds) {
            Round& round = rounds.emplace_back();
            for (const auto& [number, cell] : wanted) round.numbers.push_back(number), round.cells.push_back(cell);
            wanted.clear();
            const auto before = std::ptrdiff_t(known.size());
            known.insert(known.end(), round.numbers.begin(), round.numbers.end());
            std::ranges::inplace_merge(known, known.begin() + before);
            const size_t cells = round.cells.size();
            round.sky.resize(cells);
            in_parallel(cells, 1024, [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end; ++i) cut(round.cells[i], round.numbers[i], grid, rays);
            });
            for (size_t i = 0; i < cells; ++i)
                if (round.cells[i].cut.any()) cuts[round.numbers[i]] = round.cells[i].cut;
            make_regions(round);
            // What rays of a round find takes about a fifth of the time of that.
            const double begins = 1 - std::pow(0.2, double(rounds.size() - 1)), width = 0.8 * (1 - begins);
            const uint32_t fewer = rounds.size() > 1 ? kFewer : 1;
            const auto each_region = [&](double from, double to, const auto& work) {
                return in_parallel(
                    round.regions.size(), 1, [&](size_t number, size_t) { work(round.regions[number]); },
                    [&](size_t so_far) {
                        const double share = glm::mix(from, to, double(so_far) / double(round.regions.size()));
                        return !progress || progress(glm::mix(kPlacesShare, 1.0, begins + width * share));
                    });
            };
            const bool lamps_done = each_region(0, kLampsShare, [&](Round::Region& region) {
                gather_lamps(round, region, std::max(settings.lamp_rays / fewer, 1u));
            });
            if (!lamps_done) return std::nullopt;
            if (rounds.size() == 1) lit = lit_cells(round);
            const bool done = each_region(kLampsShare, 1, [&](Round::Region& region) { gather(round, region, fewer); });
            if (!done) return std::nullopt;
            for (Round::Region& region : round.regions)
                for (const FoundPlace& place : std::exchange(region.places, {})) {
                    const uint32_t number = *surface_cells.number(place.point, place.normal);
                    add_place(wanted[number], grid, number, place);
                }
        }
        put_together(rounds, result);
        return result;
    }

    // From the middle of the places of each. A cell that something splits is seen by no other, and sees none.
    void connect(std::span<const CellPlaces* const> cells, Radiosity& result) const {
        const auto point = [&](uint32_t i) {
            glm::dvec3 sum(0);
            for (uint32_t k = 0; k < cells[i]->count(); ++k) sum += glm::dvec3(cells[i]->places[k].point);
            const uint32_t number = result.numbers[i];
            return before(grid, number, grid.middle(number) + sum / double(cells[i]->count()));
        };
        std::vector<char> split(cells.size());
        in_parallel(cells.size(), 1024, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) split[i] = is_split(*cells[i], result.numbers[i], grid, rays);
        });
        result.connect(
            [&](uint32_t a, uint32_t b) { return !split[a] && !split[b] && !rays.blocked(point(a), point(b)); });
    }

    void put_together(const std::vector<Round>& rounds, Radiosity& result) const {
        result.grid = grid, result.numbers = known;
        struct Found {
            std::span<const Radiosity::Source> sources;
            std::span<const uint32_t> met;
            std::span<const uint16_t> parts;
        };
        std::vector<std::vector<Found>> found;  // of each cell of each round
        for (const Round& round : rounds) {
            auto& of_cells = found.emplace_back(round.cells.size());
            for (const Round::Region& region : round.regions) {
                size_t source = 0, met = 0;
                for (size_t i = 0; i < region.cells.size(); source += region.counts[i], met += region.met_counts[i++])
                    of_cells[region.cells[i]] = {std::span(region.sources).subspan(source, region.counts[i]),
                                                 std::span(region.met).subspan(met, region.met_counts[i]),
                                                 std::span(region.parts).subspan(met, region.met_counts[i])};
            }
        }
        std::vector<std::pair<size_t, size_t>> at(known.size());  // round, and index in it
        for (size_t r = 0; r < rounds.size(); ++r)
            for (size_t i = 0; i < rounds[r].cells.size(); ++i) at[*result.find(rounds[r].numbers[i])] = {r, i};
        std::vector<const CellPlaces*> cells;
        for (const auto& [r, i] : at) {
            const Round& round = rounds[r];
            const CellPlaces& cell = *cells.emplace_back(&round.cells[i]);
            result.areas.push_back(float(cell.area));
            result.cuts.push_back(cell.cut);
            const double length = glm::length(cell.normal);
            result.normals.push_back(length > 0 ? glm::vec3(cell.normal / length) : cell.places[0].normal);
            result.heights.push_back(float(glm::dot(cell.point / cell.weight, glm::dvec3(result.normals.back()))));
            result.reflectances.push_back(glm::vec3(cell.reflectance / cell.weight));
            result.sky.push_back(round.sky[i]);
            const Found& of_cell = found[r][i];
            // Surfaces that rays of the last round met may be of no cell.
            for (size_t k = 0; k < of_cell.met.size(); ++k)
                if (const std::optional<uint32_t> met = result.find(of_cell.met[k]))
                    result.met.push_back(*met), result.parts.push_back(of_cell.parts[k]);
            result.first_met.push_back(uint32_t(result.met.size()));
            result.sources.insert(result.sources.end(), of_cell.sources.begin(), of_cell.sources.end());
            result.first_source.push_back(uint32_t(result.sources.size()));
        }
        connect(cells, result);
        result.find_steps();
    }
};

}  // namespace

std::vector<glm::dmat4> without_moving(std::span<const glm::dmat4> world, const std::vector<bool>& moving) {
    std::vector<glm::dmat4> still(world.begin(), world.end());
    const glm::dvec4 nowhere(std::numeric_limits<double>::quiet_NaN());
    for (size_t node = 0; node < moving.size(); ++node)
        if (moving[node]) still[node] = glm::dmat4(nowhere, nowhere, nowhere, nowhere);
    return still;
}

std::optional<Radiosity> gather_radiosity(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                          const std::vector<bool>& moving, const RadiositySettings& settings,
                                          const std::function<bool(double)>& progress) {
    std::optional<Radiosity> radiosity = Gathering(scene, world, moving, settings).run(progress);
    if (radiosity) radiosity->bodies = moving_bodies(scene, moving);
    return radiosity;
}

}  // namespace vesper::transport
