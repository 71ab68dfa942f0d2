#include "transport/flux_balance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/luminance.h"
#include "photometry/distribution.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "transport/emitters.h"
#include "transport/reach.h"
#include "transport/sampling.h"
#include "transport/surfaces.h"

namespace vesper::transport {
namespace {

constexpr uint32_t kRaysOfLamp = 1024, kRaysOfEmitters = 1u << 18u;

double flux_of(const scene::Lamp& lamp, const scene::Scene& scene) {
    if (lamp.kind == scene::Lamp::Kind::Directional) return 0;
    if (lamp.kind != scene::Lamp::Kind::Measured) return scene::luminous_flux(lamp);
    return double(lamp.intensity) * photometry::luminous_flux(scene.distributions[lamp.distribution]);
}

// The cosine to a lamp's axis beyond which it sends nothing.
double least_cosine(const scene::Lamp& lamp) {
    if (lamp.kind == scene::Lamp::Kind::Spot) return std::cos(double(lamp.outer_cone));
    return lamp.kind == scene::Lamp::Kind::CosinePower ? 0 : -1;
}

// The part of a lamp's light that meets no surface.
double open_part(const scene::Scene& scene, const scene::Lamp& lamp, const glm::dmat4& at,
                 std::span<const uint32_t> fixture, const rays::RayCaster& rays, uint32_t seed) {
    const glm::dmat3 turned = scene::lamp_frame(at);
    Random random(seed);
    const Lattice directions(random);
    const double least = least_cosine(lamp);
    double sent = 0, open = 0;
    for (uint32_t i = 0; i < kRaysOfLamp; ++i) {
        const glm::dvec2 chance = directions.at(i);
        const double cosine = 1 - chance.x * (1 - least), sine = std::sqrt(std::max(1 - cosine * cosine, 0.0)),
                     turn = 2 * std::numbers::pi * chance.y;
        const glm::dvec3 own(sine * std::cos(turn), sine * std::sin(turn), -cosine);
        const double candela = scene::luminous_intensity(lamp, scene.distributions, own);
        sent += candela;
        const glm::dvec3 from(at[3]), way = turned * own;
        if (candela > 0 && !rays.blocked(from, from + kReach * way, fixture)) open += candela;
    }
    return sent > 0 ? open / sent : 0;
}

void add_lamps(FluxBalance& balance, const scene::Scene& scene, std::span<const glm::dmat4> world,
               const rays::RayCaster& rays) {
    const std::vector<uint32_t> nodes = scene::nodes_with_lamps(scene);
    const auto fixtures = scene::fixture_nodes(scene, nodes, world);
    for (size_t i = 0; i < nodes.size(); ++i) {
        const scene::Lamp& lamp = scene.lamps[scene.nodes[nodes[i]].lamp];
        if (!std::isfinite(world[nodes[i]][3].x)) continue;
        const double flux = flux_of(lamp, scene);
        balance.lamps += flux;
        if (flux > 0)
            balance.sky_directly += flux * open_part(scene, lamp, world[nodes[i]], fixtures[i], rays, nodes[i]);
    }
}

void add_emitters(FluxBalance& balance, const scene::Scene& scene, std::span<const glm::dmat4> world,
                  const rays::RayCaster& rays) {
    const Surfaces surfaces(scene, world);
    const Emitters emitters(scene, world, surfaces);
    const EmitterChoice choice(emitters);
    if (!choice.any()) return;
    Random random(1);
    for (uint32_t i = 0; i < kRaysOfEmitters; ++i) {
        double first = (i + 0.5) / kRaysOfEmitters;
        const size_t number = choice.choose(first);
        const Emitters::Emitter& e = emitters.list()[number];
        const auto [place, here] = emitters.place_on(number, {random.next(), random.next()});
        const bool back = e.double_sided && random.next() < 0.5;
        const glm::dvec3 normal = back ? -e.outwards : e.outwards;
        const glm::dvec3 start = place + skin_at(rays, place) * normal;
        const double sides = e.double_sided ? 2 : 1;
        if (!surfaces.stops_light(here)) continue;  // a hole of a mask
        const double flux = std::numbers::pi * luminance(surfaces.emission(here, place + normal)) * sides * e.area /
                            (choice.probability(number) * kRaysOfEmitters);
        balance.emitters += flux;
        const glm::dvec3 way = cosine_direction(normal, {random.next(), random.next()});
        if (!rays.blocked(start, start + kReach * way)) balance.sky_directly += flux;
    }
}

}  // namespace

FluxBalance flux_balance(const scene::Scene& scene, std::span<const glm::dmat4> world, const std::vector<bool>& moving,
                         const Radiosity& radiosity, uint32_t reflections) {
    const std::vector<glm::dmat4> still = without_moving(world, moving);
    const rays::RayCaster rays(scene, still);
    FluxBalance balance;
    add_lamps(balance, scene, still, rays);
    add_emitters(balance, scene, still, rays);
    // Directional light has no flux.
    std::vector<float> factors(scene.nodes.size(), 1);
    for (const uint32_t node : scene::nodes_with_lamps(scene))
        if (scene.lamps[scene.nodes[node].lamp].kind == scene::Lamp::Kind::Directional) factors[node] = 0;
    const Radiosity::Solution light = radiosity.solve({.factors = factors, .reflections = reflections});
    for (size_t i = 0; i < radiosity.cells(); ++i) {
        const glm::dvec3 lux = glm::dvec3(light.lamps[i]) + glm::dvec3(light.other[i]),
                         kept = glm::dvec3(radiosity.reflectances[i]);
        balance.absorbed += double(radiosity.areas[i]) * luminance((1.0 - kept) * lux);
        balance.sky_reflected += double(radiosity.areas[i]) * double(radiosity.sky[i]) * luminance(kept * lux);
    }
    return balance;
}

}  // namespace vesper::transport
