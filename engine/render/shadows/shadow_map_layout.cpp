#include "render/shadows/shadow_map_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>

#include <glm/gtc/quaternion.hpp>

#include "base/angle.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "scene/placement.h"

namespace vesper::render {
namespace {

constexpr double kMostZoom = 8;
constexpr double kWidestFlat = kPi / 6;  // rad: of a wider beam most texels of a flat map would be far from the axis
constexpr double kNearestEye = 4;        // m: a lamp's light is not seen from nearer
constexpr double kMostScale = 8;         // log2 of the side for 0.001 cd, 1 m from the eye

// The largest angle from the lamp's axis at which it shines, rad; half a turn if it shines to all sides.
double widest_angle(const scene::Scene& scene, const scene::Lamp& lamp) {
    constexpr double kHalfTurn = kPi;
    switch (lamp.kind) {
        case scene::Lamp::Kind::Spot:
            return double(lamp.outer_cone);
        case scene::Lamp::Kind::CosinePower:
            return kHalfTurn / 2;
        case scene::Lamp::Kind::Measured:
            break;
        default:
            return kHalfTurn;
    }
    // Between the angles of the file intensity is linear, so a step of a degree to either side holds what is between.
    constexpr int kSteps = 180;
    for (int i = kSteps; i >= 0; --i) {
        const double polar = double(i) * kRadiansPerDegree, sine = std::sin(polar), cosine = std::cos(polar);
        for (int j = 0; j < 2 * kSteps; ++j) {
            const double azimuth = double(j) * kRadiansPerDegree;
            const glm::dvec3 direction(sine * std::cos(azimuth), sine * std::sin(azimuth), -cosine);
            if (scene::luminous_intensity(lamp, scene.distributions, direction) > 0)
                return std::min(polar + kRadiansPerDegree, kHalfTurn);
        }
    }
    return kRadiansPerDegree;
}

// How much of the square of a hemisphere a cone takes: its edge is farthest out along the diagonals of x and y.
double zoom_of(double angle, bool flat) {
    if (flat) return std::min(0.98 / (std::numbers::sqrt2 * std::tan(angle)), kMostZoom);
    const double sine = std::numbers::sqrt2 * std::sin(angle),
                 farthest = sine / (sine + std::max(std::cos(angle), 0.0));
    return angle >= kPi / 2 ? 1 : std::clamp(0.98 / farthest, 1.0, kMostZoom);
}

double largest_candela(const scene::Scene& scene, const scene::Lamp& lamp) {
    return double(lamp.intensity) * (lamp.kind == scene::Lamp::Kind::Measured
                                         ? photometry::largest_intensity(scene.distributions.at(lamp.distribution))
                                         : 1.0);
}

ShadowMapLayout layout_of(const scene::Scene& scene, const scene::Lamp& lamp, double angle) {
    const double candela = largest_candela(scene, lamp);
    if (lamp.kind == scene::Lamp::Kind::Directional || !(candela > 0)) return {};
    const double range = std::sqrt(candela / kFaintestLight);
    const bool flat = angle <= kWidestFlat;
    return {.side = 0,
            .hemispheres = angle > kPi / 2 + 1e-3 ? 2u : 1u,
            .zoom = float(zoom_of(angle, flat)),
            .flat = flat,
            .range = float(range),
            .radius = float(std::sqrt(lamp.opening.area() / kPi))};
}

std::vector<ShadowMapLayout> layouts_of(const scene::Scene& scene, const std::vector<gpu_scene::PlacedLamp>& lamps) {
    std::vector<ShadowMapLayout> layouts;
    std::map<uint32_t, double> angles;  // of distributions
    for (const auto& [lamp, node] : lamps) {
        const auto known = angles.find(lamp.distribution);
        const bool measured = lamp.kind == scene::Lamp::Kind::Measured;
        const double angle = measured && known != angles.end() ? known->second : widest_angle(scene, lamp);
        if (measured) angles[lamp.distribution] = angle;
        layouts.push_back(layout_of(scene, lamp, angle));
    }
    return layouts;
}

// Of each lamp the placements that scene::fixture_nodes() names by their nodes.
std::vector<std::vector<uint32_t>> fixtures_of(const scene::Scene& scene, const gpu_scene::GpuScene& resident,
                                               const std::vector<gpu_scene::PlacedLamp>& lamps,
                                               std::span<const glm::dmat4> world) {
    std::vector<uint32_t> placement_at(scene.nodes.size(), scene::kNone), nodes;
    for (uint32_t p = 0; p < resident.placements().size(); ++p) placement_at[resident.placements()[p].node] = p;
    for (const gpu_scene::PlacedLamp& lamp : lamps) nodes.push_back(lamp.node);
    std::vector<std::vector<uint32_t>> own = scene::fixture_nodes(scene, nodes, world);
    for (std::vector<uint32_t>& fixture : own)
        for (uint32_t& node : fixture) node = placement_at[node];
    return own;
}

uint64_t texels_of(const std::vector<ShadowMapLayout>& layouts) {
    uint64_t texels = 0;
    for (const ShadowMapLayout& layout : layouts) texels += layout.texels();
    return texels;
}

}  // namespace

ShadowMapPlan shadow_map_plan(const scene::Scene& scene, const gpu_scene::GpuScene& resident,
                              const std::vector<gpu_scene::PlacedLamp>& lamps) {
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    std::vector<glm::dvec3> places;
    for (const gpu_scene::PlacedLamp& lamp : lamps) places.emplace_back(world[lamp.node][3]);
    std::vector<ShadowMapLayout> layouts = layouts_of(scene, lamps);
    std::vector<bool> animated = scene::animated_nodes(scene);
    for (size_t i = 0; i < lamps.size(); ++i) layouts[i].moves = animated[lamps[i].node];
    return {std::move(layouts), std::move(places), fixtures_of(scene, resident, lamps, world), std::move(animated)};
}

uint64_t least_texels(const std::vector<ShadowMapLayout>& layouts) {
    uint64_t texels = 0;
    for (const ShadowMapLayout& layout : layouts)
        if (layout.range > 0) texels += uint64_t{layout.hemispheres} * kLeastMapSide * kLeastMapSide;
    return texels;
}

double choose_sides(std::vector<ShadowMapLayout>& layouts, const std::vector<double>& distances, double scale,
                    uint64_t most_texels) {
    constexpr double kStep = 1.0 / 64, kLeast = std::countr_zero(kLeastMapSide), kMost = std::countr_zero(kMostMapSide);
    std::vector<double> powers;  // of two, at a scale of 0
    for (size_t i = 0; i < layouts.size(); ++i) {
        const double away = std::sqrt(std::max(distances[i], kNearestEye)) * double(layouts[i].zoom);
        const double range = std::clamp(double(layouts[i].range), 1e-30, 1e30);  // so that steps come to an end
        powers.push_back(std::log2(std::sqrt(range) / away));
    }
    const auto with = [&](double tried) {
        for (size_t i = 0; i < layouts.size(); ++i) {
            const double wanted = std::round(tried + powers[i]);
            const double power = wanted > kLeast ? std::min(wanted, kMost) : kLeast;  // also where it is no number
            layouts[i].side = layouts[i].range > 0 ? 1u << uint32_t(power) : 0;
            if (layouts[i].moves && power > kLeast) layouts[i].side /= 2;
        }
        return texels_of(layouts);
    };
    const uint64_t least = least_texels(layouts);
    for (uint64_t texels = with(scale); texels > most_texels && texels > least; texels = with(scale)) scale -= kStep;
    return scale;
}

double scene_scale(const ShadowMapPlan& plan, uint64_t most_texels) {
    constexpr size_t kMostEyes = 64;
    double scale = kMostScale;
    if (least_texels(plan.layouts) > most_texels) return scale;  // only some of the lamps may shine at a time
    std::vector<ShadowMapLayout> tried = plan.layouts;
    for (size_t eye = 0; eye < plan.places.size(); eye += std::max<size_t>(plan.places.size() / kMostEyes, 1)) {
        std::vector<double> distances;
        for (const glm::dvec3 place : plan.places) distances.push_back(glm::distance(place, plan.places[eye]));
        scale = choose_sides(tried, distances, scale, most_texels);
    }
    return scale;
}

MapFrame map_frame(const glm::dmat4& world) {
    const auto unit = [](glm::dvec3 v, glm::dvec3 otherwise) {
        const double length = glm::length(v);
        return length > 0 ? v / length : otherwise;
    };
    const glm::dvec3 z = unit(-glm::dvec3(world[2]), {0, -1, 0});
    const glm::dvec3 across = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x0(world[0]);
    const glm::dvec3 x = unit(x0 - glm::dot(x0, z) * z, glm::normalize(glm::cross(z, across)));
    return {glm::dvec3(world[3]), glm::transpose(glm::dmat3(x, glm::cross(z, x), z))};
}

std::span<const glm::dvec2> quadrants_of(const ShadowMapLayout& layout) {
    static constexpr glm::dvec2 kFour[]{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}, kFlat[]{{0, 0}};
    if (layout.flat) return kFlat;
    return kFour;
}

bool may_see(double zoom, glm::dvec2 signs, glm::dvec3 centre, double radius) {
    const auto outside = [&](glm::dvec3 inward) { return glm::dot(inward, centre) < -radius * glm::length(inward); };
    const glm::dvec3 norm(signs, 1), u(zoom, zoom, 0), v(zoom, -zoom, 0);
    return !outside({signs.x, 0, 0}) && !outside({0, signs.y, 0}) && !outside({0, 0, 1}) && !outside(norm + u) &&
           !outside(norm + v) && !outside(norm - u) && !outside(norm - v);
}

glm::vec4 rotation_to_map(const glm::dmat3& rotation, const gpu_scene::View& view) {
    const glm::dquat q = glm::normalize(glm::quat_cast(rotation * glm::transpose(glm::dmat3(view.world_to_view))));
    return {float(q.x), float(q.y), float(q.z), float(q.w)};
}

shared::ShadowMap shadow_map(const ShadowMapLayout& layout, const MapFrame& frame, const gpu_scene::View& view) {
    return {.rotation = rotation_to_map(frame.rotation, view),
            .first = float(layout.first / shared::kMapUnit),
            .side = layout.flat ? -float(layout.side) : float(layout.side),
            .zoom = layout.hemispheres == 2 ? -layout.zoom : layout.zoom,
            .radius = layout.radius};
}

}  // namespace vesper::render
