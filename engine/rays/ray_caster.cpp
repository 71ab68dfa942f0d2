#include "rays/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "rays/opacity.h"

namespace vesper::rays {

/// A segment as triangles see it.
struct RayCaster::Sight {
    glm::dvec3 from, way;     ///< m, from the list's origin
    int x, y, z;              ///< z: the axis that the way follows most; the others
    double shear_x, shear_y;  ///< of the way over its z: at most 1

    Sight(glm::dvec3 start, glm::dvec3 along) : from(start), way(along) {
        const glm::dvec3 size = glm::abs(along);
        z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        x = (z + 1) % 3, y = (z + 2) % 3;
        shear_x = along[x] / along[z], shear_y = along[y] / along[z];
    }
};

/// A triangle that a ray meets.
struct RayCaster::Crossing {
    double share;
    uint32_t source;  ///< without its flag
    bool masked;
    glm::dvec3 weights;
};

namespace {

/// A segment as boxes see it. The float ends of its origin hold the exact one between them, so that boxes are met where
/// the exact segment meets them.
struct Slabs {
    float inverse[3], before[3], behind[3];  ///< of the way; of the origin, for the near and the far side of a box
    uint32_t near[3];                        ///< which end of a box comes first along each axis

    Slabs(glm::dvec3 start, glm::dvec3 along) {
        constexpr float kLeast = 1e-30f, kMargin = 1e-20f;  // m; more than a way of kLeast, and than its product
        for (int axis = 0; axis < 3; ++axis) {
            const float nearest = float(start[axis]), d = float(along[axis]);
            const float low = std::nextafter(nearest, -HUGE_VALF) - kMargin,
                        high = std::nextafter(nearest, HUGE_VALF) + kMargin;
            inverse[axis] = 1 / (std::abs(d) < kLeast ? std::copysign(kLeast, d) : d);
            near[axis] = std::signbit(d) ? 1 : 0;
            before[axis] = near[axis] ? low : high;
            behind[axis] = near[axis] ? high : low;
        }
    }
};

/// Of the shares of the way, which are floats of 1 + 3 roundings: box, subtraction, product, and inverse.
constexpr float kWiden = 1 + 8 * 0x1p-24f;

struct Open {
    uint32_t node;
    float share;
};

/// The boxes of a node that a segment meets before a share of its way, and where it enters them.
LaneFlags meet_boxes(const Node& node, const Slabs& slabs, float most, Lanes& enter) {
    Lanes leave = Lanes{} + most;
    for (int axis = 0; axis < 3; ++axis) {
        const uint32_t near = slabs.near[axis];
        const Lanes in = (node.bounds[near][axis] - slabs.before[axis]) * slabs.inverse[axis];
        const Lanes out = (node.bounds[1 - near][axis] - slabs.behind[axis]) * slabs.inverse[axis] * kWiden;
        enter = in > enter ? in : enter;
        leave = out < leave ? out : leave;
    }
    return enter <= leave * kWiden;
}

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
    nodes_ = build_hierarchy(list_.triangles);
}

/// Where the line meets the triangle, as (share, weights of corners); share -1 if it does not.
///
/// Woop, Benthin and Wald 2013, Watertight ray/triangle intersection: corners are sheared so that the way is an axis,
/// and rounded to floats there, alike for all triangles of a corner; then the side of each edge is exact, since
/// products of floats are exact in double. A line that meets a closed surface cannot pass between its triangles.
glm::dvec4 RayCaster::meet(const Triangle& triangle, const Sight& sight) {
    const glm::dvec4 nowhere(-1, 0, 0, 0);
    double x[3], y[3];
    for (size_t k = 0; k < 3; ++k) {
        const glm::vec3& corner = triangle.corners[k];
        const double z = double(corner[sight.z]) - sight.from[sight.z];
        x[k] = double(float(double(corner[sight.x]) - sight.from[sight.x] - sight.shear_x * z));
        y[k] = double(float(double(corner[sight.y]) - sight.from[sight.y] - sight.shear_y * z));
    }
    const glm::dvec3 areas(x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]);
    const bool inside =
        (areas.x >= 0 && areas.y >= 0 && areas.z >= 0) || (areas.x <= 0 && areas.y <= 0 && areas.z <= 0);
    const double sum = areas.x + areas.y + areas.z;
    if (!inside || sum == 0) return nowhere;
    const glm::dvec3 a(triangle.corners[0]), b(triangle.corners[1]), c(triangle.corners[2]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double along = glm::dot(normal, sight.way);
    // A way within the plane meets nothing.
    if (!(along * along > 1e-28 * glm::dot(normal, normal) * glm::dot(sight.way, sight.way))) return nowhere;
    return {glm::dot(normal, a - sight.from) / along, areas / sum};
}

template <bool kAny>
std::optional<RayCaster::Crossing> RayCaster::walk(glm::dvec3 from, glm::dvec3 to,
                                                   std::span<const uint32_t> without) const {
    std::optional<Crossing> found;
    if (nodes_.empty() || is_far(from) || is_far(to)) return found;
    const Sight sight(from - list_.origin, to - from);
    const Slabs slabs(sight.from, sight.way);
    std::array<Open, kMostOpen> open;
    size_t count = 1;
    open[0] = {0, 0};
    float most = 1;
    while (count > 0) {
        const Open next = open[--count];
        if (!kAny && next.share > most) continue;
        const Node& node = nodes_[next.node];
        Lanes enter{};
        const LaneFlags met = meet_boxes(node, slabs, most, enter);
        const size_t first = count;
        for (uint32_t i = 0; i < Node::kWidth; ++i) {
            if (!met[i]) continue;
            if (node.count[i] == 0) {
                size_t at = count++;
                if constexpr (!kAny)  // the nearest on top
                    for (; at > first && open[at - 1].share < enter[i]; --at) open[at] = open[at - 1];
                open[at] = {node.first[i], enter[i]};
                continue;
            }
            const bool nearer = look_at<kAny>(node.first[i], node.count[i], sight, without, found);
            if (kAny && nearer) return found;
            if (nearer) most = std::nextafter(float(found->share), 2.0f);
        }
    }
    return found;
}

/// Puts the nearest triangle of a leaf into `found` if it is nearer; with kAny any triangle.
template <bool kAny>
bool RayCaster::look_at(uint32_t first, uint32_t count, const Sight& sight, std::span<const uint32_t> without,
                        std::optional<Crossing>& found) const {
    bool nearer = false;
    for (uint32_t t = first; t < first + count; ++t) {
        const Triangle& triangle = list_.triangles[t];
        const glm::dvec4 met = meet(triangle, sight);
        if (!(met.x > 0 && met.x < 1)) continue;
        const Crossing crossing{met.x, triangle.source & ~Triangle::kMasked, (triangle.source & Triangle::kMasked) != 0,
                                glm::dvec3(met.y, met.z, met.w)};
        if (found && std::pair(crossing.share, crossing.source) > std::pair(found->share, found->source)) continue;
        if (!counts(crossing, without)) continue;
        found = crossing;
        nearer = true;
        if (kAny) break;
    }
    return nearer;
}

const TriangleList::Run& RayCaster::run_of(const Crossing& crossing) const {
    const auto after =
        std::upper_bound(list_.runs.begin(), list_.runs.end(), crossing.source,
                         [](uint32_t source, const TriangleList::Run& run) { return source < run.first; });
    return *(after - 1);
}

bool RayCaster::counts(const Crossing& crossing, std::span<const uint32_t> without) const {
    if (without.empty() && !crossing.masked) return true;
    const TriangleList::Run& run = run_of(crossing);
    if (std::binary_search(without.begin(), without.end(), run.node)) return false;
    if (!crossing.masked) return true;
    const scene::Mesh& mesh = scene_->meshes[scene_->nodes[run.node].mesh];
    return stops_light(*scene_, mesh.primitives[run.primitive], crossing.source - run.first, crossing.weights);
}

bool RayCaster::blocked(glm::dvec3 from, glm::dvec3 to, std::span<const uint32_t> without) const {
    return walk<true>(from, to, without).has_value();
}

std::optional<Hit> RayCaster::nearest(glm::dvec3 from, glm::dvec3 to, std::span<const uint32_t> without) const {
    const std::optional<Crossing> found = walk<false>(from, to, without);
    if (!found) return {};
    const TriangleList::Run& run = run_of(*found);
    return Hit{found->share, run.node, run.primitive, found->source - run.first, found->weights};
}

uint64_t RayCaster::bytes() const {
    return list_.triangles.size() * sizeof(Triangle) + list_.runs.size() * sizeof(TriangleList::Run) +
           nodes_.size() * sizeof(Node);
}

}  // namespace vesper::rays
