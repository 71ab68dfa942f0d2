#include "gpu_scene/caster_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <meshoptimizer.h>

#include "base/budget.h"
#include "base/parallel.h"
#include "scene/fixtures.h"
#include "scene/placement.h"
#include "scene/scene.h"

namespace vesper::gpu_scene {
namespace {

constexpr double kFirstError = 0.035;  // m
constexpr double kQuadricShare =
    0.35;  // of an error: quadrics are means of squares, a sphere is up to 2.7 times as far off
constexpr int kMostLevels = 7;
constexpr double kWorthwhile = 0.8;  // of the triangles of the level before

// A part of a placement with what it is made of.
struct Source {
    PlacedPart part;
    const scene::Primitive* primitive;
    glm::dmat4 to_world;
    glm::dvec3 low, high;  // m, world
};

bool casts_by_triangles(const scene::Material& material) {
    return !material.clear && material.alpha != scene::Material::Alpha::Mask;
}

std::vector<Source> sources_of(const scene::Scene& scene) {
    const std::vector<bool> animated = scene::animated_nodes(scene);
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    std::vector<uint32_t> first_parts;
    uint32_t parts = 0, placement = 0;
    for (const scene::Mesh& mesh : scene.meshes)
        first_parts.push_back(parts), parts += uint32_t(mesh.primitives.size());
    std::vector<Source> sources;
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        const uint32_t mesh = scene.nodes[node].mesh;
        if (mesh == scene::kNone) continue;
        const uint32_t number = placement++;
        for (uint32_t i = 0; !animated[node] && i < scene.meshes[mesh].primitives.size(); ++i) {
            const scene::Primitive& primitive = scene.meshes[mesh].primitives[i];
            if (primitive.indices.empty() || !casts_by_triangles(scene.materials[primitive.material])) continue;
            Source source{{number, first_parts[mesh] + i}, &primitive, world[node], glm::dvec3(INFINITY), {}};
            source.high = -source.low;
            for (const glm::dvec3 corner : scene::placed_corners(primitive.bounds, world[node]))
                source.low = glm::min(source.low, corner), source.high = glm::max(source.high, corner);
            if (std::isfinite(glm::length(source.high - source.low))) sources.push_back(source);
        }
    }
    return sources;
}

// By cubes; what is larger than one is alone.
std::vector<std::vector<Source>> grouped(const std::vector<Source>& sources) {
    std::map<std::tuple<double, double, double>, std::vector<Source>> cubes;
    std::vector<std::vector<Source>> groups;
    for (const Source& source : sources) {
        const glm::dvec3 size = source.high - source.low;
        const glm::dvec3 cube = glm::floor(0.5 * (source.low + source.high) / kCellSide);
        if (std::max({size.x, size.y, size.z}) > kCellSide)
            groups.push_back({source});
        else
            cubes[{cube.x, cube.y, cube.z}].push_back(source);
    }
    for (auto& [cube, group] : cubes) groups.push_back(std::move(group));
    return groups;
}

CasterCell merged(const std::vector<Source>& group) {
    CasterCell cell;
    glm::dvec3 low = group[0].low, high = group[0].high;
    for (const Source& source : group) low = glm::min(low, source.low), high = glm::max(high, source.high);
    cell.origin = 0.5 * (low + high);
    for (const Source& source : group) {
        const auto first = uint32_t(cell.vertices.size());
        for (const scene::Vertex& vertex : source.primitive->vertices)
            cell.vertices.emplace_back(glm::dvec3(source.to_world * glm::dvec4(vertex.position, 1)) - cell.origin);
        for (const uint32_t index : source.primitive->indices) cell.indices.push_back(first + index);
        cell.parts.push_back(source.part);
    }
    for (const glm::vec3 vertex : cell.vertices) cell.radius = std::max(cell.radius, double(glm::length(vertex)));
    // Corners at one place are one.
    std::vector<uint32_t> remap(cell.vertices.size());
    const size_t count = meshopt_generateVertexRemap(remap.data(), cell.indices.data(), cell.indices.size(),
                                                     cell.vertices.data(), cell.vertices.size(), sizeof(glm::vec3));
    std::vector<glm::vec3> vertices(count);
    meshopt_remapVertexBuffer(vertices.data(), cell.vertices.data(), cell.vertices.size(), sizeof(glm::vec3),
                              remap.data());
    meshopt_remapIndexBuffer(cell.indices.data(), cell.indices.data(), cell.indices.size(), remap.data());
    cell.vertices = std::move(vertices);
    return cell;
}

CasterCell simplified(CasterCell cell) {
    const double scale = double(meshopt_simplifyScale(&cell.vertices[0].x, cell.vertices.size(), sizeof(glm::vec3)));
    const std::vector<uint32_t> whole = cell.indices;
    cell.levels.push_back({0, 0, uint32_t(whole.size())});
    double error = kFirstError;
    size_t last = whole.size();
    for (int k = 0; k < kMostLevels && scale > 0 && last > 0; ++k, error *= 2) {
        std::vector<uint32_t> found(whole.size());
        found.resize(meshopt_simplify(found.data(), whole.data(), whole.size(), &cell.vertices[0].x,
                                      cell.vertices.size(), sizeof(glm::vec3), 0, float(kQuadricShare * error / scale),
                                      0, nullptr));
        if (double(found.size()) > kWorthwhile * double(last)) continue;
        cell.levels.push_back({error, uint32_t(cell.indices.size()), uint32_t(found.size())});
        cell.indices.insert(cell.indices.end(), found.begin(), found.end());
        last = found.size();
    }
    return cell;
}

}  // namespace

std::vector<CasterCell> caster_cells(const scene::Scene& scene) {
    if (scene::nodes_with_lamps(scene).empty()) return {};
    const std::vector<Source> sources = sources_of(scene);
    uint64_t triangles = 0;
    for (const Source& source : sources) triangles += source.primitive->indices.size() / 3;
    if (triangles > kMostCellTriangles) return {};
    const std::vector<std::vector<Source>> groups = grouped(sources);
    std::vector<CasterCell> cells(groups.size());
    for (const Source& source : sources)
        spend(source.primitive->vertices.size() * sizeof(glm::vec3) +
              2 * source.primitive->indices.size() * sizeof(uint32_t));
    in_parallel(groups.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) cells[i] = simplified(merged(groups[i]));
    });
    std::erase_if(cells, [](const CasterCell& cell) { return cell.parts.size() < 2 && cell.levels.size() < 2; });
    return cells;
}

}  // namespace vesper::gpu_scene
