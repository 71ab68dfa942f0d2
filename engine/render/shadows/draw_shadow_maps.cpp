#include "render/shadows/draw_shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "render/shadows/caster_parts.h"
#include "render/shadows/caster_triangles.h"
#include "scene/scene.h"
#include "shaders/shadows/masked_casters.frag.inc"
#include "shaders/shadows/masked_casters.vert.inc"
#include "shaders/shadows/restore_shadow_maps.comp.inc"
#include "shaders/shadows/store_shadow_maps.comp.inc"

namespace vesper::render {
namespace {

using gpu_scene::GpuScene, gpu_scene::PlacedPart;
using graph::load, graph::update;

constexpr gpu::Shader kStore{"store_shadow_maps.comp", store_shadow_maps_comp},
    kRestore{"restore_shadow_maps.comp", restore_shadow_maps_comp};

constexpr VkVertexInputBindingDescription kMapBuffers[]{
    {0, sizeof(scene::Vertex), VK_VERTEX_INPUT_RATE_VERTEX},
    {1, sizeof(shared::MapInstance), VK_VERTEX_INPUT_RATE_INSTANCE}};
constexpr VkVertexInputAttributeDescription kMapAttributes[]{
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(scene::Vertex, position)},
    {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(scene::Vertex, uv)},
    {2, 0, VK_FORMAT_R16G16B16A16_UNORM, offsetof(scene::Vertex, colour)},
    {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, row_x)},
    {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, row_y)},
    {5, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, row_z)},
    {6, 1, VK_FORMAT_R32_UINT, offsetof(shared::MapInstance, quadrant)}};
constexpr VkDescriptorType kBindings[]{kMapBindings[0], kMapBindings[1], kMapBindings[2],
                                       VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr gpu::GraphicsShaders kMapShaders{
    "masked_casters.frag", masked_casters_vert,          masked_casters_frag, kBindings,
    sizeof(MaskPush),      VK_SHADER_STAGE_FRAGMENT_BIT, kMapBuffers,         kMapAttributes};

static_assert(ShadowMapScratch::kMostTexels >= kMostMapSide * kMostMapSide);

constexpr double kNear = 4;  // m: nearer to a lamp all casters are drawn as they are

// A hemisphere of a map.
struct Hemisphere {
    const ShadowMapToDraw& map;
    bool second;
    uint32_t first;  // texel, of those that are drawn into

    uint32_t texels() const { return map.layout.side * map.layout.side; }
};

std::vector<Hemisphere> hemispheres_of(std::span<const ShadowMapToDraw> maps) {
    std::vector<Hemisphere> all;
    for (const ShadowMapToDraw& map : maps)
        for (uint32_t h = 0; h < map.layout.hemispheres && map.layout.side > 0; ++h)
            all.push_back({map, h == 1, map.layout.first + h * map.layout.side * map.layout.side});
    return all;
}

// Casters: triangles of opaque parts; and of masked ones, or of all where there is no room for these, parts and an
// instance each, side by side.
struct Drawn {
    std::vector<shared::MapQuadrant> quadrants;
    CasterTriangles opaque;
    std::vector<uint32_t> parts;
    std::vector<shared::MapInstance> instances;

    void append(const Drawn& others) {
        const uint32_t first = uint32_t(quadrants.size());
        opaque.append(others.opaque, first);
        quadrants.insert(quadrants.end(), others.quadrants.begin(), others.quadrants.end());
        parts.insert(parts.end(), others.parts.begin(), others.parts.end());
        for (shared::MapInstance instance : others.instances) {
            instance.quadrant += first;
            instances.push_back(instance);
        }
    }
};

// Collects the casters that hemispheres see.
class Collector {
public:
    Collector(const GpuScene& scene, const gpu_scene::SceneFrame& poses, const gpu::Device& device,
              std::span<const ShadowMapToDraw> maps, const CasterGroups* groups)
        : scene_(scene),
          poses_(poses),
          triangles_(has_caster_triangles(device, scene)),
          snap_(map_snap(device)),
          groups_(groups),
          bounds_(scene.placements().size()) {
        for (uint32_t p = 0; groups && p < bounds_.size(); ++p) bounds_[p] = groups->bounds(p);
        for (const ShadowMapToDraw& map : maps)
            for (const uint32_t p : map.placements)
                if (!bounds_[p])
                    bounds_[p] = &moved_.emplace_back(caster_bounds(scene, p, poses.world[scene.placements()[p].node]));
    }

    Drawn collect(std::span<const Hemisphere> hemispheres) const {
        constexpr size_t kAtATime = 8;
        std::vector<Drawn> apart(hemispheres.size());
        in_parallel(apart.size(), kAtATime, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) collect(hemispheres[i], apart[i]);
        });
        Drawn all;
        for (const Drawn& drawn : apart) all.append(drawn);
        return all;
    }

private:
    struct Quadrant {
        glm::dvec2 signs;
        uint32_t number;  // among those that are drawn
        bool open;        // it may see something of the group that is looked at
    };
    // Of the matrix of a placement to a map.
    struct Rows {
        glm::mat3x4 rows;
        std::optional<uint32_t> number{};  // among those of opaque triangles
    };

    // The search for the casters of a hemisphere.
    struct Seen {
        const Hemisphere& of;
        std::vector<Quadrant> quadrants;
        double texel;         // rad, about
        bool fixture_stands;  // some of it
        uint32_t placement;
        std::optional<Rows> rows;  // of this placement
    };

    void collect(const Hemisphere& hemisphere, Drawn& drawn) const {
        const ShadowMapToDraw& map = hemisphere.map;
        Seen seen{hemisphere,
                  add_quadrants(hemisphere, drawn),
                  2 / (double(map.layout.side) * double(map.layout.zoom)),
                  std::ranges::any_of(map.fixture, [&](uint32_t own) { return groups_ && groups_->bounds(own); }),
                  0,
                  {}};
        if (groups_ && map.caster_error > 0)
            for (const CasterGroups::Group& group : groups_->groups()) collect_group(seen, group, drawn);
        for (Quadrant& quadrant : seen.quadrants) quadrant.open = true;
        for (const uint32_t p : map.placements) {
            const auto& [node, first, count, at_rest] = scene_.placements()[p];
            if (count == 0 || !sees(seen, bounds_[p]->whole) || is_fixture(map, p)) continue;
            for (uint32_t part = first; part < first + count; ++part) collect_part(seen, {p, part}, drawn);
        }
    }

    void collect_group(Seen& seen, const CasterGroups::Group& group, Drawn& drawn) const {
        const ShadowMapToDraw& map = seen.of.map;
        const glm::dvec3 centre = in_map(seen, group.bounds.centre);
        bool open = false;
        for (Quadrant& quadrant : seen.quadrants)
            open |= quadrant.open = may_see(double(map.layout.zoom), quadrant.signs, centre, group.bounds.radius);
        if (!open || !is_in_range(map, group.bounds) || !map.is_caster(group.bounds)) return;
        for (const auto& [bounds, cell, parts] : group.casters) {
            if (!sees(seen, bounds) || (cell && add_level(seen, *cell, drawn))) continue;
            for (const PlacedPart part : parts)
                if (!is_fixture(map, part.placement)) collect_part(seen, part, drawn);
        }
    }

    // In the frame of the map, mirrored for its second hemisphere.
    static glm::dvec3 in_map(const Seen& seen, glm::dvec3 place) {
        const MapFrame& frame = seen.of.map.frame;
        return glm::dvec3(1, 1, seen.of.second ? -1 : 1) * (frame.rotation * (place - frame.position));
    }
    static bool sees(const Seen& seen, const gpu_scene::WorldSphere& sphere) {
        return in_map(seen, sphere.centre).z + sphere.radius >= 0 && is_in_range(seen.of.map, sphere) &&
               seen.of.map.is_caster(sphere);
    }
    static bool is_fixture(const ShadowMapToDraw& map, uint32_t placement) {
        return std::ranges::binary_search(map.fixture, placement);
    }

    // The coarsest level within the error; near the lamp, or with its fixture, none: false.
    bool add_level(const Seen& seen, const GpuScene::Cell& cell, Drawn& drawn) const {
        const ShadowMapToDraw& map = seen.of.map;
        const double away = glm::distance(cell.centre, map.frame.position) - cell.radius;
        const double error = away > kNear ? map.caster_error * seen.texel * away : 0;
        const auto coarser = std::ranges::find_if(cell.levels, [&](const auto& level) { return level.error > error; });
        const auto is_own = [&](const PlacedPart& part) { return is_fixture(map, part.placement); };
        if (!triangles_ || coarser == cell.levels.begin() ||
            (seen.fixture_stands && std::ranges::any_of(cell.parts, is_own)))
            return false;
        Rows rows{rows_to_map(map.frame, glm::dmat3(1), cell.centre)};
        add_seen(seen, {cell.centre, cell.radius}, (coarser - 1)->part, false, rows, drawn);
        return true;
    }

    void collect_part(Seen& seen, PlacedPart placed, Drawn& drawn) const {
        const GpuScene::Placement& placement = scene_.placements()[placed.placement];
        const GpuScene::Part& part = scene_.parts()[placed.part];
        const ShadowMapToDraw& map = seen.of.map;
        const gpu_scene::WorldSphere& bounds = bounds_[placed.placement]->parts[placed.part - placement.first_part];
        if (part.index_count == 0 || scene_.surfaces()[part.material].material.clear || !sees(seen, bounds) ||
            bounds.radius < 0.25 * seen.texel * glm::distance(bounds.centre, map.frame.position))
            return;
        if (!seen.rows || seen.placement != placed.placement) {
            const glm::dmat4& world = poses_.world[placement.node];
            seen.rows = Rows{rows_to_map(map.frame, glm::dmat3(world), world[3])}, seen.placement = placed.placement;
        }
        const bool masked = scene_.surfaces()[part.material].material.alpha == scene::Material::Alpha::Mask;
        add_seen(seen, bounds, part, masked, *seen.rows, drawn);
    }

    // To all quadrants that may see it.
    void add_seen(const Seen& seen, const gpu_scene::WorldSphere& bounds, const GpuScene::Part& part, bool masked,
                  Rows& rows, Drawn& drawn) const {
        const glm::dvec3 centre = in_map(seen, bounds.centre);
        for (const Quadrant& quadrant : seen.quadrants)
            if (quadrant.open && may_see(double(seen.of.map.layout.zoom), quadrant.signs, centre, bounds.radius))
                add(quadrant.number, part, masked, rows, drawn);
    }

    static bool is_in_range(const ShadowMapToDraw& map, const gpu_scene::WorldSphere& sphere) {
        const glm::dvec3 to = sphere.centre - map.frame.position;
        const double far = double(map.layout.range) + sphere.radius;
        return glm::dot(to, to) <= far * far;
    }

    // Of a mesh with these axes at a place of the world.
    static glm::mat3x4 rows_to_map(const MapFrame& frame, const glm::dmat3& axes, glm::dvec3 place) {
        const glm::dmat3 turned = frame.rotation * axes;
        return glm::mat3x4(
            glm::transpose(glm::dmat4x3(turned[0], turned[1], turned[2], frame.rotation * (place - frame.position))));
    }

    std::vector<Quadrant> add_quadrants(const Hemisphere& hemisphere, Drawn& drawn) const {
        const ShadowMapLayout& layout = hemisphere.map.layout;
        const uint32_t side = layout.side;
        // Both sides of a border may be off by half a step; less than half a texel, so that no middle is drawn twice.
        const float overlap = snap_ > 1.0f / 256 ? 4 * snap_ / (layout.zoom * float(side)) : 1e-5f;
        std::vector<Quadrant> quadrants;
        for (const glm::dvec2 signs : quadrants_of(layout)) {
            quadrants.push_back({signs, uint32_t(drawn.quadrants.size()), true});
            drawn.quadrants.push_back({.zoom = signs.x < 0 ? -layout.zoom : layout.zoom,
                                       .y_sign = float(signs.y),
                                       .mirror = hemisphere.second ? -1.0f : 1.0f,
                                       .overlap = overlap,
                                       .side = side,
                                       .first = hemisphere.first,
                                       .lamp = hemisphere.map.number});
        }
        return quadrants;
    }

    void add(uint32_t quadrant, const GpuScene::Part& part, bool masked, Rows& rows, Drawn& drawn) const {
        if (!triangles_ || masked) {
            drawn.parts.push_back(uint32_t(&part - scene_.parts().data()));
            drawn.instances.push_back({.row_x = rows.rows[0],
                                       .row_y = rows.rows[1],
                                       .row_z = drawn.quadrants[quadrant].mirror * rows.rows[2],
                                       .quadrant = quadrant});
            return;
        }
        if (!rows.number) rows.number = drawn.opaque.add_rows(rows.rows);
        drawn.opaque.add(part, *rows.number, quadrant);
    }

    const GpuScene& scene_;
    const gpu_scene::SceneFrame& poses_;
    bool triangles_;                           // opaque parts are drawn by them
    float snap_;                               // texels, see map_snap
    const CasterGroups* groups_;               // or null
    std::vector<const CasterBounds*> bounds_;  // of placements, where they are looked at
    std::deque<CasterBounds> moved_;           // of those that are in no group
};

// Masked parts, in an order in which few states change.
struct MaskedParts {
    std::vector<shared::MapInstance> instances;
    std::vector<CasterBatch> batches;
};

MaskedParts masked_parts(const Drawn& drawn, const GpuScene& scene) {
    MaskedParts parts;
    for (const uint32_t i : order_by_part(drawn.parts, scene)) {
        add_to_batches(parts.batches, drawn.parts[i], uint32_t(parts.instances.size()));
        parts.instances.push_back(drawn.instances[i]);
    }
    return parts;
}

void rasterize_parts(const FrameContext& frame, const GpuScene& scene, const Drawn& drawn, const std::string& name,
                     const MapTargets& to) {
    if (drawn.parts.empty()) return;
    MaskedParts parts = masked_parts(drawn, scene);
    const graph::Resource placed = frame.graph.upload("shadow casters" + name, parts.instances);
    frame.graph.raster("masked shadow casters", map_uses(to, {{placed, graph::Access::Vertices}}),
                       [&pipelines = frame.pipelines, &scene, placed, to,
                        batches = std::move(parts.batches)](const graph::Recording& recording) {
                           set_map_viewport(recording.commands());
                           MapBindings bindings(recording, to);
                           record_casters(recording, pipelines, kMapShaders,
                                          {.targets = {}, .constants = {0, to.over ? 1u : 0u}}, scene, placed, batches,
                                          bindings.writes());
                       },
                       {to.side, to.side});
}

void draw(const FrameContext& frame, const GpuScene& scene, const Drawn& drawn, const std::string& name, MapTargets to,
          const ShadowMapScratch& scratch) {
    if (drawn.quadrants.empty()) return;
    to.side = std::ranges::max(drawn.quadrants, {}, &shared::MapQuadrant::side).side;
    to.quadrants = frame.graph.upload("shadow quadrants" + name, drawn.quadrants);
    rasterize_parts(frame, scene, drawn, name, to);
    drawn.opaque.draw(frame, name, to, scratch);
}

std::string of_target(const graph::FrameGraph& graph, graph::Resource distances) {
    return " of " + graph.resources()[distances.index].name;
}

}  // namespace

void add_shadow_maps(const FrameContext& frame, const GpuScene& scene, const gpu_scene::SceneFrame& poses,
                     const CasterGroups* groups, std::span<const ShadowMapToDraw> maps, graph::Resource distances,
                     const ShadowMapScratch& scratch) {
    graph::FrameGraph& graph = frame.graph;
    const Collector collector(scene, poses, frame.kernels.device(), maps, groups);
    uint32_t round = 0;
    const std::vector<Hemisphere> all = hemispheres_of(maps);
    for (auto next = all.begin(); next != all.end();) {
        std::vector<Hemisphere> drawn;
        std::vector<shared::DrawnTexels> list;
        uint32_t texels = 0;
        for (; next != all.end() && texels + next->texels() <= scratch.texels; ++next) {
            drawn.push_back({next->map, next->second, texels});
            for (uint32_t k = 0; k < next->texels(); k += shared::kTileTexels)
                list.push_back({texels + k, (next->first + k) / 2});
            texels += next->texels();
        }
        const std::string name = of_target(graph, distances) + "." + std::to_string(round++);
        graph.fill("clear drawn shadow maps", scratch.drawn, 0, {{0, 0, texels * sizeof(float)}});
        draw(frame, scene, collector.collect(drawn), name, {{}, scratch.drawn, scratch.changed}, scratch);
        graph.dispatch("store shadow maps", frame.kernels.get(kStore, {frame.lockstep() ? 8u : 64u}),
                       {load(scratch.drawn), load(graph.upload("drawn texels" + name, list)), update(distances)},
                       graph::Groups{uint32_t(list.size()), 1, 1});
    }
}

void add_over_shadow_maps(const FrameContext& frame, const GpuScene& scene, const gpu_scene::SceneFrame& poses,
                          std::span<const ShadowMapToDraw> maps, graph::Resource distances,
                          const ShadowMapScratch& scratch) {
    const Collector collector(scene, poses, frame.kernels.device(), maps, nullptr);
    draw(frame, scene, collector.collect(hemispheres_of(maps)), of_target(frame.graph, distances) + ", bodies",
         {{}, distances, scratch.changed, true}, scratch);
}

void restore_shadow_maps(const FrameContext& frame, graph::Resource still, graph::Resource distances,
                         const ShadowMapScratch& scratch) {
    graph::FrameGraph& graph = frame.graph;
    graph.copy("count changed tiles", scratch.changed, scratch.draws, {{0, 0, sizeof(VkDispatchIndirectCommand)}});
    graph.dispatch("restore shadow maps", frame.kernels.get(kRestore, {frame.lockstep() ? 8u : 64u}),
                   {load(still), update(distances), update(scratch.changed)}, graph::Arguments{scratch.draws});
    graph.fill("empty changed tiles", scratch.changed, 0, {{0, 0, sizeof(uint32_t)}});
}

void add_shadow_map_shaders(Digest& digest) {
    for (const std::span<const uint32_t> spirv : {kMapShaders.vertex, kMapShaders.fragment, kStore.spirv})
        digest.add_list(spirv);
    add_caster_triangle_shaders(digest);
}

}  // namespace vesper::render
