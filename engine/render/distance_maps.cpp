#include "render/distance_maps.h"

#include <algorithm>
#include <bit>
#include <functional>

#include "render/passes/distance_map.h"

namespace vesper::render {
namespace {

gpu::OwnedBuffer make_words(const gpu::Device& device, gpu::Arena& arena, uint64_t words) {
    gpu::OwnedBuffer buffer =
        gpu::make_buffer(device, std::max<uint64_t>(words, 1) * sizeof(uint32_t),
                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
    arena.bind(buffer.get());
    return buffer;
}

// Pieces of the buffers are powers of two of the least map.
constexpr uint32_t kPiece = gpu_scene::kLeastMapSide * gpu_scene::kLeastMapSide;  // texels

uint32_t size_of(const gpu_scene::MapLayout& layout) { return uint32_t(std::countr_zero(layout.texels() / kPiece)); }

uint64_t largest_texels(const std::vector<gpu_scene::MapLayout>& layouts) {
    uint64_t texels = 0;
    for (gpu_scene::MapLayout layout : layouts) {
        layout.side = layout.range > 0 ? gpu_scene::kMostMapSide : 0;
        texels += layout.texels();
    }
    return std::clamp<uint64_t>(texels, kPiece, DistanceMaps::kMostTexels);
}

}  // namespace

DistanceMaps::DistanceMaps(gpu::Device& device, const gpu_scene::GpuScene& resident,
                           const std::vector<gpu_scene::PlacedLamp>& lamps, const gpu_scene::MapPlan& plan)
    : resident_(resident),
      lamps_(lamps),
      fixtures_(plan.fixtures),
      layouts_(plan.layouts),
      texels_(largest_texels(layouts_)),
      places_(uint32_t(texels_ / kPiece)),
      arena_(device),
      drawn_(lamps.size()),
      kernels_(device),
      pipelines_(device),
      executor_(device) {
    distances_ = make_words(device, arena_, texels_ / 2);
    bounds_ = make_words(device, arena_, texels_ / 8);
}

std::vector<uint32_t> DistanceMaps::outdated(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses) {
    if (poses.world != drawn_world_) drawn_.assign(lamps_.size(), false);
    std::vector<gpu_scene::MapLayout> wanted;
    std::vector<double> distances;
    for (uint32_t i = 0; i < list.placed(); ++i) {
        wanted.push_back(layouts_[list.indices[i]]);
        distances.push_back(double(glm::length(list.lamps[i].position)));
    }
    gpu_scene::choose_sides(wanted, distances, texels_);
    std::vector<uint32_t> resized;
    for (uint32_t i = 0; i < list.placed(); ++i) {
        gpu_scene::MapLayout& layout = layouts_[list.indices[i]];
        if (layout.side == wanted[i].side) continue;
        if (layout.side != 0) places_.give(layout.first / kPiece, size_of(layout));
        layout.side = wanted[i].side;
        drawn_[list.indices[i]] = false;
        resized.push_back(list.indices[i]);
    }
    place(resized, list);
    std::vector<uint32_t> lamps;
    for (const uint32_t lamp : std::span(list.indices).first(list.placed()))
        if (!drawn_[lamp] && layouts_[lamp].side > 0) lamps.push_back(lamp);
    return lamps;
}

// Where there is no place, lamps that do not shine lose theirs and the others find new ones, the largest first: these
// always fit.
void DistanceMaps::place(std::vector<uint32_t> resized, const gpu_scene::LampList& list) {
    const auto find_places = [&](std::vector<uint32_t>& lamps) {
        std::ranges::stable_sort(lamps, std::greater(), [&](uint32_t lamp) { return layouts_[lamp].texels(); });
        for (const uint32_t lamp : lamps) {
            if (layouts_[lamp].side == 0) continue;
            const std::optional<uint32_t> at = places_.take(size_of(layouts_[lamp]));
            if (!at) return false;
            layouts_[lamp].first = *at * kPiece;
        }
        return true;
    };
    if (find_places(resized)) return;
    places_.clear();
    drawn_.assign(lamps_.size(), false);
    std::vector<uint32_t> all(list.indices.begin(), list.indices.begin() + list.placed());
    std::vector<bool> shines(lamps_.size());
    for (const uint32_t lamp : all) shines[lamp] = true;
    for (uint32_t lamp = 0; lamp < lamps_.size(); ++lamp)
        if (!shines[lamp]) layouts_[lamp].side = 0;
    find_places(all);
}

void DistanceMaps::draw(const std::vector<uint32_t>& lamps, const gpu_scene::SceneFrame& poses) {
    std::vector<MapToDraw> maps;
    for (const uint32_t lamp : lamps)
        maps.push_back({layouts_[lamp], gpu_scene::map_frame(poses.world[lamps_[lamp].node]), fixtures_[lamp]});
    graph::FrameGraph graph;
    const MapWords words{
        graph.lasting("map distances", distances_.get(), texels_ / 2 * sizeof(uint32_t), VK_FORMAT_R32_UINT),
        graph.lasting("map bounds", bounds_.get(), texels_ / 8 * sizeof(uint32_t), VK_FORMAT_R32_UINT)};
    add_distance_maps({graph, kernels_, pipelines_, {}}, resident_, poses, maps, words);
    executor_.run(graph);
    drawn_world_ = poses.world;
    for (const uint32_t lamp : lamps) drawn_[lamp] = true;
}

VisibilityMaps DistanceMaps::maps(graph::FrameGraph& graph, const gpu_scene::LampList& list,
                                  const gpu_scene::SceneFrame& poses, const gpu_scene::View& view) const {
    if (list.placed() == 0 || texels_ == 0) return {};
    std::vector<shared::LampMap> lamps;
    for (uint32_t i = 0; i < list.placed(); ++i)
        lamps.push_back(gpu_scene::lamp_map(layouts_[list.indices[i]],
                                            gpu_scene::map_frame(poses.world[lamps_[list.indices[i]].node]), view));
    return {graph.upload("lamp maps", lamps, VK_FORMAT_R32G32B32A32_SFLOAT),
            graph.external("distances", distances_.get(), texels_ * 2, VK_FORMAT_R16_SFLOAT),
            graph.external("bounds", bounds_.get(), texels_ / 8 * sizeof(uint32_t), VK_FORMAT_R16G16_SFLOAT)};
}

}  // namespace vesper::render
