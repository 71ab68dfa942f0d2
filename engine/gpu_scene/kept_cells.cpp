#include "gpu_scene/kept_cells.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <meshoptimizer.h>

#include "scene/fixtures.h"
#include "scene/placement.h"
#include "scene/scene.h"

namespace vesper::gpu_scene {
namespace {

// To be raised whenever the same scene gives other cells.
constexpr uint64_t kCellsVersion = 2;

struct KeptHeader {
    uint64_t cells = 0, bytes = 0;  // of all that follows
};

// Of a cell, before its lists.
struct KeptCell {
    glm::dvec3 origin{0};
    double radius = 0;
    uint32_t parts = 0, vertices = 0, indices = 0, levels = 0;
};
static_assert(sizeof(KeptCell) == 48 && sizeof(CasterCell::Level) == 16, "without padding");

Digest::Value key_of_cells(const Digest::Value& key) {
    Digest digest;
    digest.add_value(key);
    digest.add_list(std::string_view("cells"));
    return digest.value();
}

template <class T>
void append(std::vector<std::byte>& to, const std::vector<T>& list) {
    const std::span from = std::as_bytes(std::span(list));
    to.insert(to.end(), from.begin(), from.end());
}

// Takes what lies in bytes, one after the other.
class KeptBytes {
public:
    explicit KeptBytes(std::span<const std::byte> bytes) : left_(bytes) {}

    /// False: there are not as many.
    template <class T>
    bool take(std::vector<T>& list, uint32_t count) {
        const uint64_t bytes = uint64_t{count} * sizeof(T);
        if (bytes > left_.size()) return false;
        list.resize(count);
        if (bytes > 0) std::memcpy(list.data(), left_.data(), bytes);
        left_ = left_.subspan(bytes);
        return true;
    }
    bool is_empty() const { return left_.empty(); }

private:
    std::span<const std::byte> left_;
};

std::optional<std::vector<CasterCell>> read_cells(Cache& cache, const Digest::Value& key) {
    KeptHeader header;
    if (!cache.read(key, std::as_writable_bytes(std::span(&header, 1)))) return std::nullopt;
    if (cache.bytes(key_of_cells(key)) != header.bytes) return std::nullopt;
    std::vector<std::byte> bytes(header.bytes);
    if (!cache.read(key_of_cells(key), bytes)) return std::nullopt;
    KeptBytes kept(bytes);
    std::vector<CasterCell> cells;
    std::vector<KeptCell> one;
    for (uint64_t i = 0; i < header.cells; ++i) {
        CasterCell& cell = cells.emplace_back();
        if (!kept.take(one, 1)) return std::nullopt;
        cell.origin = one[0].origin, cell.radius = one[0].radius;
        if (!kept.take(cell.parts, one[0].parts) || !kept.take(cell.vertices, one[0].vertices) ||
            !kept.take(cell.indices, one[0].indices) || !kept.take(cell.levels, one[0].levels))
            return std::nullopt;
    }
    return kept.is_empty() ? std::optional(std::move(cells)) : std::nullopt;
}

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Indices lie in their lists, parts are of the scene, and numbers are finite.
bool are_sound(const std::vector<CasterCell>& cells, const scene::Scene& scene) {
    std::vector<uint32_t> first_parts{0};  // of each mesh, and the end
    for (const scene::Mesh& mesh : scene.meshes)
        first_parts.push_back(first_parts.back() + uint32_t(mesh.primitives.size()));
    std::vector<uint32_t> meshes;  // of each placement
    for (const scene::Node& node : scene.nodes)
        if (node.mesh != scene::kNone) meshes.push_back(node.mesh);
    const auto is_of_scene = [&](const PlacedPart& part) {
        if (part.placement >= meshes.size()) return false;
        const uint32_t mesh = meshes[part.placement];
        return part.part >= first_parts[mesh] && part.part < first_parts[mesh + 1];
    };
    return std::ranges::all_of(cells, [&](const CasterCell& cell) {
        return is_finite(cell.origin) && std::isfinite(cell.radius) && cell.radius >= 0 && !cell.levels.empty() &&
               std::ranges::all_of(cell.parts, is_of_scene) &&
               std::ranges::all_of(cell.vertices, [](const glm::vec3& vertex) { return is_finite(vertex); }) &&
               std::ranges::all_of(cell.indices, [&](uint32_t index) { return index < cell.vertices.size(); }) &&
               std::ranges::all_of(cell.levels, [&](const CasterCell::Level& level) {
                   return std::isfinite(level.error) && level.first_index <= cell.indices.size() &&
                          level.index_count <= cell.indices.size() - level.first_index && level.index_count % 3 == 0;
               });
    });
}

void write_cells(Cache& cache, const Digest::Value& key, const std::vector<CasterCell>& cells) {
    std::vector<std::byte> bytes;
    for (const CasterCell& cell : cells) {
        append(bytes, std::vector{KeptCell{cell.origin, cell.radius, uint32_t(cell.parts.size()),
                                           uint32_t(cell.vertices.size()), uint32_t(cell.indices.size()),
                                           uint32_t(cell.levels.size())}});
        append(bytes, cell.parts), append(bytes, cell.vertices), append(bytes, cell.indices);
        append(bytes, cell.levels);
    }
    const KeptHeader header{cells.size(), bytes.size()};
    cache.write(key_of_cells(key), bytes);
    cache.write(key, std::as_bytes(std::span(&header, 1)));
}

}  // namespace

Digest::Value cells_key(const scene::Scene& scene, const Digest::Value& occluders) {
    Digest digest;
    digest.add_list(std::string_view("cells of casters"));
    digest.add_list(std::string_view(VESPER_VERSION));
    digest.add_value(MESHOPTIMIZER_VERSION);
    digest.add_value(kCellsVersion), digest.add_value(kCellSide), digest.add_value(kMostCellTriangles);
    digest.add_value(occluders);
    digest.add_value(scene::nodes_with_lamps(scene).empty());
    digest.add_list(scene::world_transforms(scene, 0));
    for (const bool moves : scene::animated_nodes(scene)) digest.add_value(moves);
    return digest.value();
}

std::vector<CasterCell> kept_or_made_cells(const scene::Scene& scene, const Digest::Value& occluders, Cache* cache) {
    if (!cache) return caster_cells(scene);
    const Digest::Value key = cells_key(scene, occluders);
    if (auto kept = read_cells(*cache, key); kept && are_sound(*kept, scene)) return *std::move(kept);
    std::vector<CasterCell> made = caster_cells(scene);
    if (cache->writes()) write_cells(*cache, key, made);
    return made;
}

}  // namespace vesper::gpu_scene
