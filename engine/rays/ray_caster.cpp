#include "rays/ray_caster.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/type_ptr.hpp>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "rays/box_hierarchy.h"
#include "rays/opacity.h"

namespace vesper::rays {

/// A triangle that a ray meets.
struct RayCaster::Crossing {
    double share;
    uint32_t triangle;  ///< index into TriangleList::triangles
    glm::dvec3 weights;
};

/// A segment as triangles see it.
struct RayCaster::Sight {
    glm::dvec3 from, way;  ///< m, from the list's origin
    int x, y, z;           ///< z: the axis that the way follows most; the others
    double from_x, from_y, from_z;
    double shear_x, shear_y;  ///< of the way over its z: at most 1

    Sight(glm::dvec3 start, glm::dvec3 along) : from(start), way(along) {
        const glm::dvec3 size = glm::abs(along);
        z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        x = (z + 1) % 3, y = (z + 2) % 3;
        from_x = start[x], from_y = start[y], from_z = start[z];
        shear_x = along[x] / along[z], shear_y = along[y] / along[z];
    }
    std::optional<Crossing> meet(const std::array<glm::vec3, 3>& corners, uint32_t triangle) const;
};

/// Where the segment meets a triangle.
///
/// Woop, Benthin and Wald 2013, Watertight ray/triangle intersection: corners are sheared so that the way is an axis,
/// and rounded to floats there, alike for all triangles of a corner; then the side of each edge is exact, since
/// products of floats are exact in double. A line that meets a closed surface cannot pass between its triangles.
std::optional<RayCaster::Crossing> RayCaster::Sight::meet(const std::array<glm::vec3, 3>& corners,
                                                          uint32_t triangle) const {
    double u[3], v[3];
    for (size_t k = 0; k < 3; ++k) {
        const float* corner = glm::value_ptr(corners[k]);
        const double ahead = double(corner[z]) - from_z;
        u[k] = double(float(double(corner[x]) - from_x - shear_x * ahead));
        v[k] = double(float(double(corner[y]) - from_y - shear_y * ahead));
    }
    const glm::dvec3 areas(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    const bool inside =
        (areas.x >= 0 && areas.y >= 0 && areas.z >= 0) || (areas.x <= 0 && areas.y <= 0 && areas.z <= 0);
    const double sum = areas.x + areas.y + areas.z;
    if (!inside || sum == 0) return std::nullopt;
    const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double along = glm::dot(normal, way);
    // A way within the plane meets nothing.
    if (!(along * along > 1e-28 * glm::dot(normal, normal) * glm::dot(way, way))) return std::nullopt;
    const double share = glm::dot(normal, a - from) / along;
    if (!(share > 0 && share < 1)) return std::nullopt;
    return Crossing{share, triangle, areas / sum};
}

/// A ray on its way, which Embree hands to what looks at triangles.
struct RayCaster::Query : embree::Context {
    const RayCaster& caster;
    Sight sight;
    std::span<const uint32_t> without;
    std::optional<Crossing> found;

    Query(const RayCaster& of, glm::dvec3 from, glm::dvec3 to, std::span<const uint32_t> but)
        : caster(of), sight(from - of.list_.origin, to - from), without(but) {
        embree::init(*this);
    }
    static void look_for_nearest(const RTCIntersectFunctionNArguments* arguments);
    static void look_for_any(const RTCOccludedFunctionNArguments* arguments);
    RTCRay ray() const {
        const glm::vec3 from(sight.from), way(sight.way);
        RTCRay ray{};
        ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z;
        ray.dir_x = way.x, ray.dir_y = way.y, ray.dir_z = way.z;
        ray.tfar = 1, ray.mask = ~0u;
        return ray;
    }
};

namespace {

bool is_far(glm::dvec3 point) {
    constexpr double kMost = 10 * kFarthest;
    return !(std::abs(point.x) <= kMost && std::abs(point.y) <= kMost && std::abs(point.z) <= kMost);
}

}  // namespace

RayCaster::RayCaster(const scene::Scene& scene, std::span<const glm::dmat4> world) : scene_(&scene) {
    const std::string name = scene.name.empty() ? "the scene" : one_line(scene.name);
    const Budget budget("preparing rays through " + name);
    const uint64_t count = count_triangles(scene);
    if (count > kMostTriangles) throw Error(name + ": has more triangles than rays can be cast at");
    spend(count * kBytesPerTriangle);
    list_ = list_triangles(scene, world);
    if (list_.triangles.empty()) return;
    const TriangleLooks looks{Query::look_for_nearest, Query::look_for_any};
    boxes_ = std::make_unique<BoxHierarchy>(list_.triangles, looks, budget.task);
}

RayCaster::RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;
RayCaster::~RayCaster() = default;

bool RayCaster::counts(const Crossing& crossing, std::span<const uint32_t> without) const {
    const Triangle& triangle = list_.triangles[crossing.triangle];
    const TriangleList::Run& run = list_.runs[triangle.run];
    if (!without.empty() && std::ranges::binary_search(without, run.node)) return false;
    if (!run.masked) return true;
    const scene::Mesh& mesh = scene_->meshes[scene_->nodes[run.node].mesh];
    return stops_light(*scene_, mesh.primitives[run.primitive], triangle.number, crossing.weights);
}

void RayCaster::Query::look_for_any(const RTCOccludedFunctionNArguments* arguments) {
    const auto& query = *static_cast<const Query*>(arguments->context);
    const RayCaster& caster = query.caster;
    const auto met = query.sight.meet(caster.list_.triangles[arguments->primID].corners, arguments->primID);
    if (met && caster.counts(*met, query.without)) reinterpret_cast<RTCRay*>(arguments->ray)->tfar = -HUGE_VALF;
}

/// Of triangles at one place the first counts, whichever box it is in.
void RayCaster::Query::look_for_nearest(const RTCIntersectFunctionNArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->context);
    const RayCaster& caster = query.caster;
    const auto met = query.sight.meet(caster.list_.triangles[arguments->primID].corners, arguments->primID);
    if (!met) return;
    const std::optional<Crossing>& found = query.found;
    if (found && std::pair(met->share, met->triangle) > std::pair(found->share, found->triangle)) return;
    if (!caster.counts(*met, query.without)) return;
    query.found = met;
    // Above the share, so that boxes that begin there are met.
    reinterpret_cast<RTCRayHit*>(arguments->rayhit)->ray.tfar = float(met->share) * (1 + 0x1p-22f);
}

bool RayCaster::has_way(glm::dvec3 from, glm::dvec3 to) const {
    return boxes_ && !is_far(from) && !is_far(to) && from != to;
}

bool RayCaster::blocked(glm::dvec3 from, glm::dvec3 to, std::span<const uint32_t> without) const {
    if (!has_way(from, to)) return false;
    Query query(*this, from, to, without);
    RTCRay ray = query.ray();
    embree::occluded(boxes_->scene(), query, ray);
    return ray.tfar < 0;
}

std::optional<Hit> RayCaster::nearest(glm::dvec3 from, glm::dvec3 to, std::span<const uint32_t> without) const {
    if (!has_way(from, to)) return std::nullopt;
    Query query(*this, from, to, without);
    RTCRayHit ray{query.ray(), {}};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree::intersect(boxes_->scene(), query, ray);
    if (!query.found) return std::nullopt;
    const Triangle& triangle = list_.triangles[query.found->triangle];
    const TriangleList::Run& run = list_.runs[triangle.run];
    return Hit{query.found->share, run.node, run.primitive, triangle.number, query.found->weights};
}

uint64_t RayCaster::bytes() const {
    return list_.triangles.size() * sizeof(Triangle) + list_.runs.size() * sizeof(TriangleList::Run) +
           (boxes_ ? boxes_->bytes() : 0);
}

}  // namespace vesper::rays
