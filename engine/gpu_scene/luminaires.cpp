#include "gpu_scene/luminaires.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/gtc/quaternion.hpp>

#include "base/error.h"
#include "gpu_scene/silhouette.h"
#include "scene/lamp.h"
#include "scene/scene.h"

namespace vesper::gpu_scene {
namespace {

using glm::dvec2, glm::dvec3;

// The shortest turn from one unit vector to another; half a turn about `spare` where they are opposite.
glm::dquat turn(dvec3 from, dvec3 to, dvec3 spare) {
    const double cosine = glm::dot(from, to);
    if (cosine < -1 + 1e-9) return {0, spare.x, spare.y, spare.z};
    const dvec3 normal = glm::cross(from, to);
    return glm::normalize(glm::dquat(1 + cosine, normal.x, normal.y, normal.z));
}

// The normal a flat opening is drawn with, so that the eye sees at least kGrazing of it. A point lamp faces the eye.
dvec3 seen_normal(const scene::Lamp& lamp, dvec3 normal, dvec3 up, dvec3 to_eye) {
    if (lamp.kind == scene::Lamp::Kind::Point) return to_eye;
    const double cosine = glm::dot(normal, to_eye);
    if (cosine >= kGrazing) return normal;
    const dvec3 sideways = normal - cosine * to_eye;
    const dvec3 edge = glm::length(sideways) > 1e-6 ? glm::normalize(sideways) : up;
    return kGrazing * to_eye + std::sqrt(1 - kGrazing * kGrazing) * edge;
}

// A lamp and the eye.
struct Aim {
    dvec3 centre, right, up, back, to_eye;  ///< view frame; the axes are of unit length
    double distance;                        ///< m
    double candela;                         ///< towards the eye
};

// Nothing where the eye gets no light from there.
std::optional<Aim> aim_of(const scene::Lamp& lamp, float dimming,
                          const std::vector<photometry::Distribution>& distributions, const glm::mat4& m,
                          const View& view) {
    const dvec3 centre(m[3]);
    const dvec3 columns[] = {dvec3(m[0]), dvec3(m[1]), dvec3(m[2])};
    for (const dvec3& column : columns)
        if (!(glm::length(column) > 0)) return std::nullopt;  // a node squeezed flat has no direction left
    const dvec3 right = glm::normalize(columns[0]), up = glm::normalize(columns[1]), back = glm::normalize(columns[2]);
    const double distance = glm::length(centre);
    const double half_diagonal = std::hypot(lamp.opening.length, lamp.opening.width) / 2;
    if (!(distance > 1e-6) || -centre.z + half_diagonal < view.near) return std::nullopt;
    const dvec3 to_eye = -centre / distance;
    const dvec3 direction(glm::dot(right, to_eye), glm::dot(up, to_eye), glm::dot(back, to_eye));
    const double candela = double(dimming) * scene::luminous_intensity(lamp, distributions, direction);
    if (!(candela > 0)) return std::nullopt;
    return Aim{centre, right, up, back, to_eye, distance, candela};
}

constexpr double kLantern = 0.4;  // m

struct Seen {
    Silhouette silhouette;
    double luminance;  // cd/m^2
    double hidden;     // m
};

Seen look_at(const scene::Lamp& lamp, const Aim& aim, const View& view) {
    const dvec3 normal = seen_normal(lamp, -aim.back, aim.up, aim.to_eye);
    const glm::dquat turned = turn(-aim.back, normal, aim.up);
    // Axes of a sheared node are not at right angles; those of the opening are.
    const dvec3 across = turned * glm::normalize(aim.right - glm::dot(aim.right, aim.back) * aim.back),
                along = glm::cross(normal, across);
    const photometry::LuminousOpening& o = lamp.opening;
    const Opening opening{aim.centre, 0.5 * o.length * across, 0.5 * o.width * along, o.round};
    Silhouette silhouette = project(opening, view, kSmallest);
    const double luminance = aim.candela / (o.area() * glm::dot(normal, aim.to_eye) * silhouette.widening);
    const double half_diagonal = std::hypot(o.length, o.width) / 2;
    return {std::move(silhouette), luminance,
            -aim.centre.z * 0.999 - kHousing - half_diagonal - double(shared::kLuminaireEdge)};
}

// Part of a lamp's light that its silhouette in the picture has.
double part_inside(const Seen& seen, const Aim& aim, const View& view) {
    double twice_area = 0;
    const std::vector<dvec2>& v = seen.silhouette.vertices;
    for (size_t i = 0; i < v.size(); ++i) {
        const dvec2 a = v[i], b = v[(i + 1) % v.size()];
        twice_area += a.x * b.y - b.x * a.y;
    }
    const dvec2 pixel = glm::abs(dvec2(view.ray_scale()));
    const double cosine = aim.to_eye.z;
    const double drawn = seen.luminance * std::abs(twice_area) / 2 * pixel.x * pixel.y * cosine * cosine * cosine;
    const double part = drawn / (aim.candela / (aim.distance * aim.distance));
    return part > 0.99 ? 1 : part;  // silhouettes are good to so much
}

// Part of a lamp without opening that the picture shows, as if what is modelled of it were kLantern wide: it comes in
// without a step.
double middle_inside(const Aim& aim, const View& view) {
    const dvec2 at = dvec2(aim.centre) / -aim.centre.z, low = glm::min(view.tangent_low, view.tangent_high),
                high = glm::max(view.tangent_low, view.tangent_high);
    const dvec2 within = glm::min(at - low, high - at) * -aim.centre.z / kLantern + 0.5;  // of its width
    const dvec2 part = glm::clamp(within, 0.0, 1.0);
    return part.x * part.y;
}

// The shader's loops over the silhouettes of a tile end by themselves well before lavapipe silently ends them, after
// 65,535 turns of the lanes of two tiles together.
constexpr uint32_t kMostTurns = 30000;

void add(LuminaireList& list, SilhouetteTiles& tiles, const Seen& seen, glm::vec3 luminance) {
    const SilhouetteTiles::Place place = tiles.add(seen.silhouette.vertices);
    list.luminaires.push_back({luminance, float(seen.hidden), place.origin, float(place.first), float(place.vertices)});
}

}  // namespace

LuminaireSet placed_luminaires(const scene::Scene& scene) {
    LuminaireSet set;
    for (const PlacedLamp& placed : placed_lamps(scene))
        if (placed.lamp.kind != scene::Lamp::Kind::Directional) set.lamps.push_back(placed);
    if (!set.lamps.empty()) set.distributions = scene.distributions;
    return set;
}

LuminaireList luminaire_list(const LuminaireSet& set, const SceneFrame& frame, const View& view,
                             std::optional<float> white) {
    LuminaireList list;
    SilhouetteTiles tiles(view.extent);
    for (const PlacedLamp& placed : set.lamps) {
        const scene::Lamp& lamp = placed.lamp;
        const uint32_t node = placed.node;
        const std::optional<Aim> aim =
            aim_of(lamp, frame.dimming_of(node), set.distributions, view.from(frame.world[node]), view);
        if (!aim) continue;
        const auto dazzles = [&](double inside) {
            if (aim->to_eye.z > 0)
                list.glare_sources.push_back({node, -aim->to_eye, aim->distance, aim->candela,
                                              aim->candela / (aim->distance * aim->distance) * dvec3(lamp.colour),
                                              inside});
        };
        if (!(lamp.opening.area() > 0) ||
            !lamp.opening.drawn) {  // what is modelled of it is seen where the picture has its place
            dazzles(middle_inside(*aim, view));
            continue;
        }
        const Seen seen = look_at(lamp, *aim, view);
        if (std::isfinite(seen.luminance)) dazzles(part_inside(seen, *aim, view));
        if (seen.silhouette.vertices.empty()) continue;
        const glm::vec3 c = lamp.colour;
        const double largest = std::max({c.r, c.g, c.b, 1e-6f});
        const double scale = white ? *white / (largest * seen.silhouette.widening) : seen.luminance;
        const glm::vec3 luminance(scale * dvec3(c));
        if (std::isfinite(luminance.r + luminance.g + luminance.b)) add(list, tiles, seen, luminance);
    }
    static_cast<SilhouetteList&>(list) = tiles.list();
    for (const glm::uvec4& tile : list.tiles) {
        uint32_t turns = 0;
        for (uint32_t i = tile.z; i < tile.z + tile.w; ++i)
            turns += 2 + uint32_t(list.luminaires[list.entries[i] & ~shared::kCoversTile].vertices);
        if (turns > kMostTurns)
            throw Error(std::to_string(tile.w) + " lamps are seen within the same pixels (column " +
                        std::to_string(tile.x * shared::kLuminaireTile) + ", row " +
                        std::to_string(tile.y * shared::kLuminaireTile) + "): too many to draw their openings");
    }
    return list;
}

}  // namespace vesper::gpu_scene
