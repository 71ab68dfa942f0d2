#include "render/shadows/casting_lamps.h"

#include <algorithm>

#include "shaders/shadows/casting_lamps.comp.inc"
#include "shaders/shadows/light_shares.comp.inc"
#include "shared/visibility.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kLightShares{"light_shares.comp", light_shares_comp, light_shares_comp_storage};
constexpr gpu::Shader kCastingLamps{"casting_lamps.comp", casting_lamps_comp};

constexpr uint32_t kMostBlocks = 16384;  // of a picture whose blocks are all taken

}  // namespace

graph::Resource add_casting_lamps(const FrameContext& frame, const BlockLists& lists,
                                  const std::vector<shared::ShadowMap>& maps, std::vector<uint32_t> optional,
                                  float most_share, size_t most_lamps) {
    const auto& [surfaces, clusters, blocks] = lists;
    graph::FrameGraph& graph = frame.graph;
    const VkExtent2D extent = frame.view.extent;
    const LampKinds kinds = lamp_kinds(clusters);
    const uint32_t rows = blocks.count / blocks.columns, step = blocks.count > kMostBlocks ? 2 : 1,
                   across = (blocks.columns + step - 1) / step, down = (rows + step - 1) / step;
    // As fine as fits the sum of all blocks into a word, rounded up in each.
    const uint32_t whole = std::min(~0u / (across * down) - 1, 1u << 24u), lamps = uint32_t(maps.size());
    const graph::Resource sums =
        graph.transient("light of lamps", graph::buffer_shape((most_lamps + 1) * sizeof(uint32_t)));
    graph.clear("clear light of lamps", sums);
    graph.dispatch("light shares", frame.kernels.get(kLightShares, {kinds.powers, kinds.tables, frame.lockstep()}),
                   {load(surfaces.surface), sample(clusters.lamps), sample(blocks.counts), sample(blocks.entries),
                    sample(clusters.tables.texels), update(sums)},
                   shared::LightSharesPush{.grid = clusters.push.grid,
                                           .size = {extent.width, extent.height},
                                           .blocks_x = blocks.columns,
                                           .blocks_y = rows,
                                           .capacity = blocks.capacity,
                                           .step = step,
                                           .lamps = clusters.push.lamps,
                                           .whole = whole},
                   graph::Groups{across, down, 1});
    const graph::Resource kept = graph.transient(
        "shadow maps", graph::buffer_shape(most_lamps * sizeof(shared::ShadowMap), VK_FORMAT_R32G32B32A32_SFLOAT));
    if (optional.empty()) optional.push_back(lamps);
    const gpu::Kernel& casting = frame.kernels.get(kCastingLamps, {});
    graph.dispatch("casting lamps", casting,
                   {load(sums), load(graph.upload("lamps that may be left out", optional)),
                    load(graph.upload("shadow maps of all lamps", maps)), store(kept), update(blocks.visibility)},
                   shared::CastingLampsPush{lamps, uint32_t(optional.size()), across * down, whole, most_share},
                   graph::cover(lamps, 1, casting.group[0], 1));
    return kept;
}

}  // namespace vesper::render
