#include "render/shadows/draw_shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "render/shadows/caster_parts.h"
#include "render/shadows/caster_triangles.h"
#include "scene/scene.h"
#include "shaders/shadows/casters.frag.inc"
#include "shaders/shadows/casters.vert.inc"
#include "shaders/shadows/store_shadow_maps.comp.inc"

namespace vesper::render {
namespace {

using gpu_scene::GpuScene, gpu_scene::PlacedPart;
using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kStore{"store_distances.comp", store_shadow_maps_comp};

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
    {6, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, place)},
    {7, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, window)},
    {8, 1, VK_FORMAT_R32_SFLOAT, offsetof(shared::MapInstance, y_sign)},
    {9, 1, VK_FORMAT_R32_SFLOAT, offsetof(shared::MapInstance, overlap)}};
constexpr gpu::GraphicsShaders kMapShaders{"casters.frag",  casters_vert,     casters_frag,
                                           kCasterTextures, sizeof(MaskPush), VK_SHADER_STAGE_FRAGMENT_BIT,
                                           kMapBuffers,     kMapAttributes};

constexpr double kNear = 25;  // m: nearer to a lamp all casters are drawn as they are

// In a square of this side, texels.
uint32_t regions_in(uint32_t side) { return side / shared::kRegion * (side / shared::kRegion); }

// A hemisphere of a map or a tile of one, and its corner in the image.
struct Square {
    const ShadowMapToDraw* map;
    bool second;        // hemisphere
    glm::uvec2 corner;  // in the hemisphere, texels
    uint32_t side;      // texels
    // Its image: its side, texels; its number among those of this side; and the square's corner in it, texels.
    uint32_t image_side = 0, image = 0;
    glm::uvec2 place{0};
};

// The place of the n-th region along a curve that fills squares of powers of two one after another (Morton 1966).
glm::uvec2 region_place(uint32_t n) {
    glm::uvec2 place(0);
    for (uint32_t bit = 0; bit < 16; ++bit) place |= glm::uvec2(n >> 2 * bit & 1u, n >> (2 * bit + 1) & 1u) << bit;
    return place * shared::kRegion;
}

std::vector<Square> squares_of(std::span<const ShadowMapToDraw> maps) {
    std::vector<Square> all;
    for (const ShadowMapToDraw& map : maps)
        if (map.tile) {
            all.push_back({&map, map.tile->second, map.tile->corner, shared::kRegion});
        } else {
            for (uint32_t h = 0; h < map.layout.hemispheres && map.layout.side > 0; ++h)
                all.push_back({&map, h == 1, glm::uvec2(0), map.layout.side});
        }
    return all;
}

// The first of the regions, of `count`, that a square is drawn into: lamps are scattered (Knuth 1998, 6.4), and tiles
// that are side by side seldom meet.
uint32_t first_region(const Square& square, uint32_t count) {
    const uint32_t each = regions_in(square.side), places = count / each,
                   number = 2 * square.map->lamp + (square.second ? 1 : 0);
    const auto scattered = uint32_t(uint64_t(number * 2654435761u) * places >> 32u);
    const glm::uvec2 tile = square.map->tile ? square.corner / shared::kRegion : glm::uvec2(0);
    return (scattered + tile.x + 7 * tile.y) % places * each;
}

// All squares, image by image, the largest first, each in its place in the first image where that is free.
std::vector<Square> place_squares(std::span<const ShadowMapToDraw> maps, const ShadowMapScratch& scratch) {
    std::vector<Square> all = squares_of(maps);
    std::ranges::stable_sort(all, std::greater(), &Square::side);
    std::map<uint32_t, std::vector<std::vector<bool>>> taken;  // regions, by sides of images and their numbers
    for (Square& square : all) {
        square.image_side = scratch.image_for(square.side).side;
        const uint32_t regions = regions_in(square.image_side), first = first_region(square, regions);
        square.place = region_place(first);
        std::vector<std::vector<bool>>& images = taken[square.image_side];
        const auto image = std::ranges::find_if(images, [&](const std::vector<bool>& of) { return !of[first]; });
        square.image = uint32_t(image - images.begin());
        if (image == images.end()) images.emplace_back(regions);
        std::fill_n(images[square.image].begin() + first, regions_in(square.side), true);
    }
    std::ranges::stable_sort(all, {}, [](const Square& square) { return std::pair(~square.image_side, square.image); });
    return all;
}

// The casters of an image: triangles of opaque parts; and of masked ones, or of all where there is no room for these,
// parts and an instance each, side by side.
struct Drawn {
    CasterTriangles opaque;
    std::vector<uint32_t> parts;
    std::vector<shared::MapInstance> instances;
};

// Collects the casters that squares see.
class Collector {
public:
    /// `standing`: of cells, whether they are drawn in place of their parts.
    Collector(const GpuScene& scene, const gpu_scene::SceneFrame& poses, const gpu::Device& device,
              const std::vector<bool>& standing)
        : scene_(scene),
          poses_(poses),
          triangles_(has_caster_triangles(device, scene)),
          snap_(map_snap(device)),
          bounds_(scene.placements().size()) {
        for (const GpuScene::Placement& placement : scene.placements()) loose_.push_back(placement.part_count);
        for (uint32_t i = 0; triangles_ && i < standing.size(); ++i) {
            if (!standing[i]) continue;
            const GpuScene::Cell& cell = *cells_.emplace_back(&scene.cells()[i]);
            in_cells_.insert(in_cells_.end(), cell.parts.begin(), cell.parts.end());
        }
        std::ranges::sort(in_cells_);
        for (const PlacedPart part : in_cells_) --loose_[part.placement];
    }

    void collect(const Square& square, Drawn& drawn) {
        const ShadowMapToDraw& map = *square.map;
        Seen seen{square, add_quadrants(square, drawn), 2 / (double(map.layout.side) * double(map.layout.zoom)), 0, {}};
        const bool by_cells = !map.tile && map.caster_error > 0;
        if (by_cells)
            for (const GpuScene::Cell* cell : cells_) collect_cell(seen, *cell, drawn);
        for (const uint32_t p : map.placements) {
            const auto& [node, first, count, at_rest] = scene_.placements()[p];
            if ((by_cells && loose_[p] == 0) || !sees(seen, bounds_of(p).whole) || is_fixture(map, p)) continue;
            for (uint32_t part = first; part < first + count; ++part)
                if (!by_cells || loose_[p] == count || !std::ranges::binary_search(in_cells_, PlacedPart{p, part}))
                    collect_part(seen, {p, part}, drawn);
        }
    }

private:
    // Of a placement in the world, and of its parts.
    struct Bounds {
        gpu_scene::WorldSphere whole{glm::dvec3(0), -1};
        std::vector<gpu_scene::WorldSphere> parts;
    };

    // Computed when a placement is first asked for.
    const Bounds& bounds_of(uint32_t placement) {
        const GpuScene::Placement& of = scene_.placements()[placement];
        Bounds& bounds = bounds_[placement];
        if (bounds.whole.radius >= 0 || of.part_count == 0) return bounds;
        for (uint32_t i = 0; i < of.part_count; ++i)
            bounds.parts.push_back(
                gpu_scene::world_sphere_of(scene_.parts()[of.first_part + i], poses_.world[of.node]));
        bounds.whole = bounds.parts[0];
        for (const gpu_scene::WorldSphere& part : bounds.parts)
            bounds.whole.radius =
                std::max(bounds.whole.radius, glm::distance(part.centre, bounds.whole.centre) + part.radius);
        return bounds;
    }

    // Of a square, in the image.
    struct Quadrant {
        MapWindow window;
        glm::dvec2 signs;
        uint32_t number;  // among those of opaque triangles
        shared::MapQuadrant drawn;
    };
    // Of the matrix of a placement to a map.
    struct Rows {
        glm::mat4 rows;
        std::optional<uint32_t> number{};  // among those of opaque triangles
    };

    // The search for the casters of a square.
    struct Seen {
        const Square& square;
        std::vector<Quadrant> quadrants;
        double texel;  // rad, about
        uint32_t placement;
        std::optional<Rows> rows;  // of this placement
    };

    // In the frame of the map, mirrored for its second hemisphere.
    static glm::dvec3 in_map(const Seen& seen, glm::dvec3 place) {
        const MapFrame& frame = seen.square.map->frame;
        return glm::dvec3(1, 1, seen.square.second ? -1 : 1) * (frame.rotation * (place - frame.position));
    }
    static bool sees(const Seen& seen, const gpu_scene::WorldSphere& sphere) {
        return is_caster(*seen.square.map, sphere) && in_map(seen, sphere.centre).z + sphere.radius >= 0;
    }
    static bool is_fixture(const ShadowMapToDraw& map, uint32_t placement) {
        return std::ranges::binary_search(map.fixture, placement);
    }

    // The coarsest level within the error; near the lamp, or with its fixture, the parts.
    void collect_cell(Seen& seen, const GpuScene::Cell& cell, Drawn& drawn) {
        const ShadowMapToDraw& map = *seen.square.map;
        const gpu_scene::WorldSphere bounds{cell.centre, cell.radius};
        if (!sees(seen, bounds)) return;
        const double away = glm::distance(cell.centre, map.frame.position) - cell.radius;
        const double error = away > kNear ? map.caster_error * seen.texel * away : 0;
        const auto coarser = std::ranges::find_if(cell.levels, [&](const auto& level) { return level.error > error; });
        const bool has_fixture = std::ranges::any_of(map.fixture, [&](uint32_t own) {
            return std::ranges::binary_search(cell.parts, own, {}, &PlacedPart::placement);
        });
        if (coarser == cell.levels.begin() || has_fixture) {
            for (const PlacedPart part : cell.parts)
                if (!is_fixture(map, part.placement)) collect_part(seen, part, drawn);
            return;
        }
        Rows rows{rows_to_map(map.frame, glm::translate(glm::dmat4(1), cell.centre))};
        add_seen(seen, bounds, (coarser - 1)->part, false, rows, drawn);
    }

    void collect_part(Seen& seen, PlacedPart placed, Drawn& drawn) {
        const GpuScene::Placement& placement = scene_.placements()[placed.placement];
        const GpuScene::Part& part = scene_.parts()[placed.part];
        const ShadowMapToDraw& map = *seen.square.map;
        const gpu_scene::WorldSphere& bounds = bounds_of(placed.placement).parts[placed.part - placement.first_part];
        if (part.index_count == 0 || scene_.surfaces()[part.material].material.clear || !sees(seen, bounds) ||
            bounds.radius < 0.25 * seen.texel * glm::distance(bounds.centre, map.frame.position))
            return;
        if (!seen.rows || seen.placement != placed.placement)
            seen.rows = Rows{rows_to_map(map.frame, poses_.world[placement.node])}, seen.placement = placed.placement;
        const bool masked = scene_.surfaces()[part.material].material.alpha == scene::Material::Alpha::Mask;
        add_seen(seen, bounds, part, masked, *seen.rows, drawn);
    }

    // To all quadrants that may see it.
    void add_seen(const Seen& seen, const gpu_scene::WorldSphere& bounds, const GpuScene::Part& part, bool masked,
                  Rows& rows, Drawn& drawn) const {
        const glm::dvec3 centre = in_map(seen, bounds.centre);
        for (const Quadrant& quadrant : seen.quadrants)
            if (may_see(quadrant.window, quadrant.signs, centre, bounds.radius))
                add(quadrant, part, masked, rows, drawn);
    }

    static bool is_caster(const ShadowMapToDraw& map, const gpu_scene::WorldSphere& sphere) {
        const glm::dvec3 to = sphere.centre - map.frame.position;
        const double far = double(map.layout.range) + sphere.radius;
        return glm::dot(to, to) <= far * far && (!map.is_caster || map.is_caster(sphere));
    }

    static glm::mat4 rows_to_map(const MapFrame& frame, const glm::dmat4& world) {
        const glm::dmat4 from_lamp = glm::translate(glm::dmat4(1), -frame.position) * world;
        return glm::transpose(glm::mat4(glm::dmat4(frame.rotation) * from_lamp));
    }

    std::vector<Quadrant> add_quadrants(const Square& square, Drawn& drawn) const {
        const ShadowMapLayout& layout = square.map->layout;
        const double zoom = double(layout.zoom), per_texel = 2.0 / double(layout.side);
        const glm::dvec2 low = per_texel * glm::dvec2(square.corner) - 1.0;
        const MapWindow window{zoom, low, low + per_texel * double(square.side)};
        const float image = float(square.image_side), scale = float(layout.side) / image;
        const glm::vec2 corner = glm::vec2(square.place) - glm::vec2(square.corner);
        const glm::vec2 middle = (corner + 0.5f * float(layout.side)) * (2.0f / image) - 1.0f;
        // Both sides of a border may be off by half a step; less than half a texel, so that no middle is drawn twice.
        const float overlap = snap_ > 1.0f / 256 ? 4 * snap_ / (layout.zoom * float(layout.side)) : 1e-5f;
        std::vector<Quadrant> quadrants;
        for (const glm::dvec2 signs : quadrants_of(layout)) {
            const shared::MapQuadrant quadrant{.place = glm::vec4(scale, middle, float(signs.x < 0 ? -zoom : zoom)),
                                               .window = glm::vec4(window.low, window.high),
                                               .y_sign = float(signs.y),
                                               .first = 0,
                                               .mirror = square.second ? -1.0f : 1.0f,
                                               .side = image,
                                               .corner = glm::vec2(square.place),
                                               .width = float(square.side),
                                               .overlap = overlap};
            quadrants.push_back({window, signs, drawn.opaque.quadrants(), quadrant});
            drawn.opaque.add_quadrant(quadrant);
        }
        return quadrants;
    }

    void add(const Quadrant& quadrant, const GpuScene::Part& part, bool masked, Rows& rows, Drawn& drawn) const {
        const shared::MapQuadrant& to = quadrant.drawn;
        if (!triangles_ || masked) {
            drawn.parts.push_back(uint32_t(&part - scene_.parts().data()));
            drawn.instances.push_back({.row_x = rows.rows[0],
                                       .row_y = rows.rows[1],
                                       .row_z = to.mirror * rows.rows[2],
                                       .place = to.place,
                                       .window = to.window,
                                       .y_sign = to.y_sign,
                                       .overlap = to.overlap});
            return;
        }
        if (!rows.number) rows.number = drawn.opaque.add_rows(rows.rows);
        drawn.opaque.add(part, *rows.number, quadrant.number);
    }

    const GpuScene& scene_;
    const gpu_scene::SceneFrame& poses_;
    bool triangles_;                            // opaque parts are drawn by them
    float snap_;                                // texels, see map_snap
    std::vector<Bounds> bounds_;                // of placements
    std::vector<const GpuScene::Cell*> cells_;  // that stand
    std::vector<PlacedPart> in_cells_;          // their parts, ascending
    std::vector<uint32_t> loose_;               // of placements: how many parts are in none
};

uint32_t saved_word(const std::optional<MapTile>& tile) {
    if (!tile) return shared::kNotSaved;
    return tile->saved / shared::kMapUnit | (tile->save ? shared::kSaveNow : 0u);
}

std::vector<shared::MapRegion> regions_of(std::span<const Square> squares) {
    std::vector<shared::MapRegion> regions;
    for (const Square& square : squares) {
        const ShadowMapLayout& layout = square.map->layout;
        const uint32_t first = (layout.first + (square.second ? layout.side * layout.side : 0)) / shared::kMapUnit;
        for (uint32_t y = 0; y < square.side; y += shared::kRegion)
            for (uint32_t x = 0; x < square.side; x += shared::kRegion)
                regions.push_back({square.place.x + x, square.place.y + y, square.corner.x + x, square.corner.y + y,
                                   layout.side, first, saved_word(square.map->tile), 0});
    }
    return regions;
}

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
    if (parts.instances.empty()) parts.instances.emplace_back();  // an upload is never empty
    return parts;
}

}  // namespace

std::vector<bool> standing_cells(const GpuScene& scene, std::span<const uint32_t> still,
                                 const gpu_scene::SceneFrame& poses) {
    std::vector<bool> stands(scene.placements().size());
    for (const uint32_t p : still) stands[p] = poses.world[scene.placements()[p].node] == scene.placements()[p].at_rest;
    std::vector<bool> cells;
    for (const GpuScene::Cell& cell : scene.cells())
        cells.push_back(std::ranges::all_of(cell.parts, [&](const auto& part) { return stands[part.placement]; }));
    return cells;
}

void add_shadow_maps(const FrameContext& frame, const GpuScene& scene, const gpu_scene::SceneFrame& poses,
                     const std::vector<bool>& standing, std::span<const ShadowMapToDraw> maps,
                     graph::Resource distances, ShadowMapScratch& scratch) {
    graph::FrameGraph& graph = frame.graph;
    Collector collector(scene, poses, frame.kernels.device(), standing);
    const std::vector<Square> squares = place_squares(maps, scratch);
    for (auto begin = squares.begin(); begin != squares.end();) {
        const auto in_other_image = [&](const Square& square) {
            return square.image_side != begin->image_side || square.image != begin->image;
        };
        const std::span<const Square> of_image(begin, std::find_if(begin, squares.end(), in_other_image));
        const std::string which = " " + std::to_string(scratch.drawn++);
        const auto [side, depth, small] = scratch.image_for(begin->image_side);
        begin += std::ptrdiff_t(of_image.size());
        Drawn drawn;
        for (const Square& square : of_image) collector.collect(square, drawn);
        MaskedParts parts = masked_parts(drawn, scene);

        const graph::Resource placed = graph.upload("shadow casters" + which, parts.instances);
        graph.raster("masked shadow casters",
                     {{placed, graph::Access::Vertices}, {depth, graph::Access::DepthTarget, {}, true}},
                     [&pipelines = frame.pipelines, &scene, placed,
                      batches = std::move(parts.batches)](const graph::Recording& recording) {
                         record_casters(recording, pipelines, kMapShaders, scene, placed, batches);
                     });
        graph.clear("clear small shadow casters", small);
        drawn.opaque.draw(frame, {which, depth, small}, scratch);

        const std::vector<shared::MapRegion> regions = regions_of(of_image);
        const graph::Resource list = graph.upload("shadow map regions" + which, regions);
        graph.dispatch("store shadow maps", frame.kernels.get(kStore),
                       {sample(depth), load(list), update(distances), load(small)},
                       graph::Groups{uint32_t(regions.size()), 1, 1});
    }
}

void add_shadow_map_shaders(Digest& digest) {
    for (const std::span<const uint32_t> spirv : {kMapShaders.vertex, kMapShaders.fragment, kStore.spirv})
        digest.add_list(spirv);
    add_caster_triangle_shaders(digest);
}

}  // namespace vesper::render
