#include "transport/lamp_reflections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/luminance.h"
#include "scene/lamp.h"
#include "scene/scene.h"
#include "transport/cell_grid.h"
#include "transport/radiosity.h"
#include "transport/reach.h"

namespace vesper::transport {
namespace {

constexpr uint32_t kRings = 128, kTurns = 256;  // of the sphere, where a lamp's intensity is looked up

struct Ray {
    glm::dvec3 direction;
    double flux;
};

double flux_of_rays(std::span<const Ray> rays) {
    double sum = 0;
    for (const Ray& ray : rays) sum += ray.flux;
    return sum;
}

// Rays along `axis` in `parts` parts of equal flux.
std::vector<std::span<Ray>> split(std::span<Ray> rays, int axis, uint32_t parts) {
    std::ranges::stable_sort(rays, {}, [axis](const Ray& ray) { return ray.direction[axis]; });
    const double all = flux_of_rays(rays);
    std::vector<std::span<Ray>> found;
    double sum = 0;
    size_t begin = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        sum += rays[i].flux;
        if (sum < all * double(found.size() + 1) / parts && i + 1 < rays.size()) continue;
        found.push_back(rays.subspan(begin, i + 1 - begin));
        begin = i + 1;
        if (found.size() == parts) break;
    }
    while (found.size() < parts) found.push_back(found.back());  // all in one direction
    return found;
}

// At even steps through their flux.
void choose(std::span<const Ray> rays, uint32_t count, std::vector<glm::dvec3>& to) {
    const double step = flux_of_rays(rays) / count;
    double next = step / 2, sum = 0;
    const size_t wanted = to.size() + count;
    for (const Ray& ray : rays)
        for (sum += ray.flux; next < sum && to.size() < wanted; next += step) to.push_back(ray.direction);
    to.resize(wanted, rays.back().direction);
}

// What a patch gathers.
struct Sum {
    double weight = 0;
    glm::dvec3 position{0}, normal{0}, intensity{0};
    double squares = 0;  // of positions from `origin`
    glm::dvec3 origin{0};

    void add(glm::dvec3 point, glm::dvec3 facing, glm::dvec3 candela) {
        const double more = luminance(candela);
        if (weight == 0) origin = point;
        const glm::dvec3 off = point - origin;
        weight += more, position += more * off, squares += more * glm::dot(off, off), normal += more * facing;
        intensity += candela;
    }
    LitPatch patch() const {
        const glm::dvec3 mean = position / weight;
        const double variance = std::max(squares / weight - glm::dot(mean, mean), 0.0);
        // Of points all over a disc the variance is half the square of its radius.
        return {origin + mean, glm::normalize(normal), std::sqrt(2 * variance), intensity};
    }
};

}  // namespace

LampReflections::LampReflections(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                 const std::vector<bool>& moving)
    : scene_(scene),
      at_rest_(without_moving(world, moving)),
      rays_(scene, at_rest_),
      surfaces_(scene, at_rest_),
      fans_(scene.lamps.size()) {
    for (uint32_t node = 0; node < moving.size(); ++node) {
        const uint32_t number = scene.nodes[node].lamp;
        if (!moving[node] || number == scene::kNone) continue;
        const scene::Lamp& lamp = scene.lamps[number];
        if (lamp.kind == scene::Lamp::Kind::Directional) continue;
        lamps_.push_back({node, number});
        Fan& fan = fans_[number];
        if (!fan.directions.empty()) continue;
        std::vector<Ray> rays;
        const double solid_angle = 4 * std::numbers::pi / (kRings * kTurns);
        for (uint32_t ring = 0; ring < kRings; ++ring)
            for (uint32_t turn = 0; turn < kTurns; ++turn) {
                const double z = 1 - 2 * (ring + 0.5) / kRings, r = std::sqrt(1 - z * z),
                             angle = 2 * std::numbers::pi * (turn + 0.5) / kTurns;
                const glm::dvec3 direction(r * std::cos(angle), r * std::sin(angle), z);
                const double candela = scene::luminous_intensity(lamp, scene.distributions, direction);
                if (candela > 0) rays.push_back({direction, candela * solid_angle});
            }
        fan.flux = flux_of_rays(rays);
        if (!(fan.flux >= kLeastFlux)) continue;
        for (const std::span<Ray> level : split(rays, 1, kAbove))
            for (const std::span<Ray> part : split(level, 0, kBeside)) choose(part, kRaysOfPart, fan.directions);
    }
    std::erase_if(lamps_, [this](const MovingLamp& lamp) { return fans_[lamp.lamp].directions.empty(); });
}

std::vector<LitPatch> LampReflections::patches(std::span<const glm::dmat4> world, std::span<const float> factors,
                                               glm::dvec3 eye) const {
    struct Near {
        double distance;
        MovingLamp lamp;
        double factor;
    };
    std::vector<Near> near;
    for (const MovingLamp& lamp : lamps_) {
        const double factor = factors.empty() ? 1 : double(factors[lamp.node]);
        const double distance = glm::distance(glm::dvec3(world[lamp.node][3]), eye);
        if (distance <= kFarthest && factor * fans_[lamp.lamp].flux >= kLeastFlux)
            near.push_back({distance, lamp, factor});
    }
    std::ranges::stable_sort(near, {}, &Near::distance);
    if (near.size() > kMostLamps) near.resize(kMostLamps);

    // By the node above, the lamp, the directions, and the side that the surface faces: road and walls are two lights.
    std::map<std::array<uint32_t, 4>, Sum> sums;
    for (const auto& [distance, lamp, factor] : near) {
        const glm::dmat4& at = world[lamp.node];
        const glm::dmat3 turned = scene::lamp_frame(at);
        const glm::dvec3 from(at[3]);
        const Fan& fan = fans_[lamp.lamp];
        const uint32_t parent = scene_.nodes[lamp.node].parent;
        const double lumens = factor * fan.flux / double(fan.directions.size());
        for (uint32_t i = 0; i < fan.directions.size(); ++i) {
            const std::optional<rays::Hit> hit = rays_.nearest(from, from + kReach * (turned * fan.directions[i]));
            if (!hit) continue;
            const SurfacePoint surface = surfaces_.at(*hit, from);
            const glm::dvec3 candela =
                lumens / std::numbers::pi * glm::dvec3(scene_.lamps[lamp.lamp].colour) * surface.reflectance;
            if (!(luminance(candela) > 0)) continue;
            sums[{parent == scene::kNone ? lamp.node : parent, lamp.lamp, i / kRaysOfPart, side_of(surface.normal)}]
                .add(surface.position, surface.normal, candela);
        }
    }
    std::vector<LitPatch> found;
    for (const auto& [key, sum] : sums)
        if (glm::length(sum.normal) > 1e-6 * sum.weight) found.push_back(sum.patch());
    return found;
}

}  // namespace vesper::transport
