#include "transport/moving_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/parallel.h"
#include "rays/ray_caster.h"
#include "scene/placement.h"

namespace vesper::transport {
namespace {

constexpr double kLeastBody = 0.3;     // m across
constexpr double kStepsAcross = 14;    // of the diagonal of a body's box
constexpr double kMargin = 0.6;        // diagonals, around the box
constexpr double kFade = 1 / 3.0;      // of the margin, where what is hidden falls to 0
constexpr uint32_t kDirections = 192;  // of the sphere

// Even over the sphere (spherical Fibonacci points: Gonzalez 2010).
std::vector<glm::dvec3> directions_all_around() {
    std::vector<glm::dvec3> directions;
    for (uint32_t i = 0; i < kDirections; ++i) {
        const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z),
                     turn = 2 * std::numbers::pi * i / std::numbers::phi;
        directions.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    }
    return directions;
}

// A body's meshes in the frame of its topmost node.
struct Shape {
    std::vector<std::pair<uint32_t, glm::dmat4>> meshes;
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    double across() const { return low.x <= high.x ? glm::distance(low, high) : 0; }
    std::vector<uint32_t> nodes;  // of the first body of this shape

    bool is(const Shape& other) const { return meshes == other.meshes; }
};

void take_in(const scene::Scene& scene, uint32_t node, const glm::dmat4& from_node, Shape& shape) {
    if (scene.nodes[node].mesh == scene::kNone) return;
    shape.meshes.emplace_back(scene.nodes[node].mesh, from_node);
    shape.nodes.push_back(node);
    for (const scene::Primitive& primitive : scene.meshes[scene.nodes[node].mesh].primitives)
        for (const scene::Vertex& vertex : primitive.vertices) {
            const glm::dvec3 corner(from_node * glm::dvec4(vertex.position, 1));
            shape.low = glm::min(shape.low, corner), shape.high = glm::max(shape.high, corner);
        }
}

// Shapes stand in a row, so that none is in the volume of another: how far one is moved.
glm::dvec3 place_in_row(const std::vector<Shape>& shapes, size_t number) {
    double x = -(shapes[number].low.x + shapes[number].high.x) / 2;
    for (size_t i = 0; i < number; ++i) x += 4 * shapes[i].across() + 4 * shapes[i + 1].across();
    return {x, 0, 0};
}

rays::RayCaster rays_of(const scene::Scene& scene, const std::vector<Shape>& shapes) {
    const glm::dvec4 nowhere(std::numeric_limits<double>::quiet_NaN());
    std::vector<glm::dmat4> world(scene.nodes.size(), glm::dmat4(nowhere, nowhere, nowhere, nowhere));
    for (size_t s = 0; s < shapes.size(); ++s)
        for (size_t i = 0; i < shapes[s].nodes.size(); ++i) {
            glm::dmat4& at = world[shapes[s].nodes[i]] = shapes[s].meshes[i].second;
            at[3] += glm::dvec4(place_in_row(shapes, s), 0);
        }
    return {scene, world};
}

OcclusionVolume volume_around(const Shape& shape) {
    OcclusionVolume volume;
    volume.step = shape.across() / kStepsAcross;
    const glm::dvec3 size = shape.high - shape.low + 2 * kMargin * shape.across();
    volume.count = glm::uvec3(glm::ceil(size / volume.step)) + 1u;
    volume.low = (shape.low + shape.high) / 2.0 - 0.5 * volume.step * glm::dvec3(volume.count - 1u);
    return volume;
}

// 1 within the margin, 0 at the border of the volume.
double fade_at(const OcclusionVolume& volume, glm::uvec3 place, double across) {
    const glm::uvec3 off = glm::min(place, volume.count - 1u - place);
    return std::min(1.0, volume.step * std::min({off.x, off.y, off.z}) / (kFade * kMargin * across));
}

std::array<uint8_t, kSides> hidden_around(const rays::RayCaster& rays, glm::dvec3 point, double reach, double fade,
                                          const std::vector<glm::dvec3>& directions) {
    std::array<double, kSides> hidden{}, all{};
    for (const glm::dvec3 direction : directions) {
        const bool blocked = rays.blocked(point, point + reach * direction);
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const double cosine = direction[int(axis)];
            const uint32_t side = 2 * axis + (cosine < 0 ? 1 : 0);
            all[side] += std::abs(cosine), hidden[side] += blocked ? std::abs(cosine) : 0;
        }
    }
    std::array<uint8_t, kSides> parts{};
    for (uint32_t side = 0; side < kSides; ++side)
        parts[side] = uint8_t(std::lround(MovingBodies::kAll * fade * hidden[side] / all[side]));
    return parts;
}

}  // namespace

MovingBodies moving_bodies(const scene::Scene& scene, const std::vector<bool>& moving) {
    MovingBodies found;
    std::map<uint32_t, Shape> by_node;  // of bodies
    std::vector<uint32_t> body(scene.nodes.size(), scene::kNone);
    std::vector<glm::dmat4> from_node(scene.nodes.size(), glm::dmat4(1));
    std::vector<bool> animated(scene.nodes.size());
    for (const scene::Channel& channel : scene.channels) animated[channel.node] = true;
    for (uint32_t node = 0; node < moving.size(); ++node) {
        if (!moving[node]) continue;
        const uint32_t parent = scene.nodes[node].parent;
        const bool below = parent != scene::kNone && moving[parent] && !animated[node];
        body[node] = below ? body[parent] : node;
        if (below) from_node[node] = from_node[parent] * scene::local_transform(scene.nodes[node]);
        take_in(scene, node, from_node[node], by_node[body[node]]);
    }
    std::erase_if(by_node, [](const auto& one) { return !(one.second.across() >= kLeastBody); });

    std::vector<Shape> shapes;
    const auto find = [&shapes](const Shape& shape) {
        return std::ranges::find_if(shapes, [&](const Shape& known) { return known.is(shape); });
    };
    for (const auto& [node, shape] : by_node)
        if (find(shape) == shapes.end()) shapes.push_back(shape);
    std::ranges::stable_sort(shapes, std::greater{}, &Shape::across);
    if (shapes.size() > kMostShapes) shapes.resize(kMostShapes);
    if (shapes.empty()) return found;
    for (const auto& [node, shape] : by_node)
        if (const auto known = find(shape); known != shapes.end())
            found.bodies.push_back({node, uint32_t(known - shapes.begin())});

    const rays::RayCaster rays = rays_of(scene, shapes);
    const std::vector<glm::dvec3> directions = directions_all_around();
    for (size_t s = 0; s < shapes.size(); ++s) {
        const double across = shapes[s].across();
        OcclusionVolume& volume = found.volumes.emplace_back(volume_around(shapes[s]));
        volume.first = uint32_t(found.hidden.size());
        found.hidden.resize(found.hidden.size() + volume.places());
        const glm::dvec3 moved = place_in_row(shapes, s);
        in_parallel(volume.places(), 256, [&](size_t begin, size_t end) {
            for (auto i = uint32_t(begin); i < end; ++i) {
                const glm::uvec3 at(i % volume.count.x, i / volume.count.x % volume.count.y,
                                    i / volume.count.x / volume.count.y);
                found.hidden[volume.first + i] =
                    hidden_around(rays, moved + volume.low + volume.step * glm::dvec3(at), (1 + 2 * kMargin) * across,
                                  fade_at(volume, at, across), directions);
            }
        });
    }
    return found;
}

}  // namespace vesper::transport
