#include "transport/path_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/luminance.h"
#include "base/parallel.h"
#include "scene/scene.h"
#include "transport/light_tracer.h"
#include "transport/placed_triangles.h"
#include "transport/reach.h"

namespace vesper::transport {
namespace {

constexpr uint32_t kPlaces = 512, kCandidates = 32 * kPlaces;
constexpr TraceSettings kTraced{.paths = 256, .lamp_rays = 2};
constexpr double kFar = 1;           // m
constexpr uint32_t kLooks = 6;       // from each candidate
constexpr double kLeastShare = 0.2;  // of the mean light of candidates: so much counts for those that have none

struct Place {
    glm::dvec3 point, normal;
    double cells = 0, paths = 0, weight = 1;  // lx; weight: how many candidates it stands for
};

struct Triangle {
    const PlacedPrimitive* of;
    uint32_t number;
};

// By chance as often as it sees what is farther than a metre, and never where it sees a back, as within a house.
bool is_seen(const Place& place, const rays::RayCaster& rays, const Surfaces& surfaces, Random& random) {
    const glm::dvec3 start = place.point + skin_at(rays, place.point) * place.normal;
    for (uint32_t i = 0; i < kLooks; ++i) {
        const glm::dvec3 way = cosine_direction(place.normal, {random.next(), random.next()});
        const std::optional<rays::Hit> hit = rays.nearest(start, start + kReach * way);
        if (hit && ((i == 0 && hit->share * kReach < kFar) || surfaces.shows_back(*hit, start))) return false;
    }
    return true;
}

// Even over all sides of surfaces that are seen.
std::vector<Place> candidates(const scene::Scene& scene, std::span<const glm::dmat4> world, const rays::RayCaster& rays,
                              Random& random) {
    const std::vector<PlacedPrimitive> primitives = primitives_of(scene, world);
    const Surfaces surfaces(scene, world);
    std::vector<Triangle> triangles;
    std::vector<double> ends;
    double area = 0;
    for (const PlacedPrimitive& primitive : primitives)
        for (uint32_t t = 0; t < primitive.triangles(); ++t)
            if (const std::optional<Corners> c = primitive.corners(t))
                triangles.push_back({&primitive, t}),
                    ends.push_back(area += (primitive.double_sided ? 2 : 1) * c->area);
    std::vector<Place> places;
    for (uint32_t i = 0; i < kCandidates && !ends.empty(); ++i) {
        const auto found = std::ranges::upper_bound(ends, (i + random.next()) / kCandidates * area);
        const Triangle& triangle = triangles[size_t(std::min(found, ends.end() - 1) - ends.begin())];
        const Corners corners = *triangle.of->corners(triangle.number);
        const glm::dvec3 weights = triangle_weights({random.next(), random.next()});
        glm::dvec3 normal(0);
        for (int k = 0; k < 3; ++k) normal += weights[k] * corners.normals[size_t(k)];
        if (!(glm::length(normal) > 1e-12)) continue;
        normal = glm::normalize(normal);
        if (triangle.of->double_sided && random.next() < 0.5) normal = -normal;
        const Place place{.point = corners.at(weights), .normal = normal};
        if (is_seen(place, rays, surfaces, random)) places.push_back(place);
    }
    return places;
}

// Some, in even steps through what they have of light.
std::vector<Place> choose(const std::vector<Place>& all, double mean, Random& random) {
    double sum = 0, end = 0, next = random.next();
    for (const Place& place : all) sum += place.cells + kLeastShare * mean;
    std::vector<Place> chosen;
    for (const Place& place : all) {
        const double steps = (place.cells + kLeastShare * mean) / sum * kPlaces;
        for (end += steps; next < end; ++next) {
            chosen.push_back(place);
            chosen.back().weight = 1 / steps;
        }
    }
    return chosen;
}

}  // namespace

PathCheck check_by_paths(const scene::Scene& scene, std::span<const glm::dmat4> world, const std::vector<bool>& moving,
                         const Radiosity& radiosity, uint32_t reflections) {
    const std::vector<glm::dmat4> still = without_moving(world, moving);
    std::optional<photometry::Irradiance9> sky_on;
    if (scene.environment) sky_on = photometry::irradiance_polynomial(*scene.environment);
    RadiosityLight all;
    all.sky = double(scene.sky_luminance) * glm::dvec3(scene.sky_colour);
    all.sky_picture = sky_on ? &*sky_on : nullptr, all.reflections = reflections;
    const std::vector<glm::vec3> light = radiosity.solve(all).other;
    Random random(1);
    std::vector<Place> places = candidates(scene, still, rays::RayCaster(scene, still), random);
    double mean = 0;
    for (Place& place : places) {
        place.cells = luminance(radiosity.at(light, place.point, place.normal));
        mean += place.cells / double(places.size());
    }
    if (!(mean > 0)) return {};
    places = choose(places, mean, random);
    const LightTracer tracer(scene, still);
    in_parallel(places.size(), 1, [&](size_t i, size_t) {
        TraceSettings own = kTraced;
        own.seed = i + 1;
        const Illuminance found = tracer.at(places[i].point, places[i].normal, own);
        places[i].paths = luminance(found.sum() - found[Origin::Lamps]);
    });
    PathCheck check{.places = uint32_t(places.size())};
    double weights = 0, squares = 0;
    for (const Place& place : places) {
        weights += place.weight;
        check.cells += place.weight * place.cells, check.paths += place.weight * place.paths;
    }
    if (!(check.paths > 0)) return {.places = check.places, .cells = check.cells / weights};
    for (const Place& place : places)
        squares += std::pow(place.weight * (place.cells - check.ratio() * place.paths), 2);
    check.error = std::sqrt(squares) / check.paths;
    check.cells /= weights, check.paths /= weights;
    return check;
}

}  // namespace vesper::transport
