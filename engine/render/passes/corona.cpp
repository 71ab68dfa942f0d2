#include "render/passes/corona.h"

#include "shaders/corona/corona.comp.inc"
#include "shaders/corona/corona_pick.comp.inc"
#include "shaders/corona/corona_tiles.comp.inc"
#include "shared/corona.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kCoronaTiles{"corona_tiles.comp", corona_tiles_comp},
    kCoronaPick{"corona_pick.comp", corona_pick_comp}, kCorona{"corona.comp", corona_comp, corona_comp_storage};

}  // namespace

graph::Resource add_corona(const FrameContext& frame, graph::Resource scene, graph::Resource retina,
                           std::span<const glm::vec4> pattern) {
    using namespace shared;
    if (pattern.empty()) return retina;
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const gpu::Kernel &mean = frame.kernels.get(kCoronaTiles), &pick = frame.kernels.get(kCoronaPick),
                      &draw = frame.kernels.get(kCorona);
    const uint32_t columns = (view.extent.width + kCoronaTile - 1) / kCoronaTile,
                   rows = (view.extent.height + kCoronaTile - 1) / kCoronaTile;
    const CoronaPush push{{view.extent.width, view.extent.height}, view.ray_scale(), view.ray_offset()};
    const graph::Resource tiles =
        graph.transient("corona tiles", graph::buffer_shape(uint64_t{columns} * rows * sizeof(CoronaTile)));
    const graph::Resource lamps =
        graph.transient("corona lamps", graph::buffer_shape(kCoronaLamps * sizeof(CoronaLamp)));
    const graph::Resource texels =
        graph.upload("corona pattern", std::as_bytes(pattern), VK_FORMAT_R32G32B32A32_SFLOAT);
    graph.dispatch("corona tiles", mean, {load(scene), store(tiles)}, push,
                   graph::cover(columns, rows, mean.group[0], 1));
    graph.dispatch("corona lamps", pick, {load(tiles), store(lamps)}, push, {1, 1, 1});
    graph.dispatch("corona", draw, {load(lamps), sample(texels), update(retina)}, push,
                   graph::cover(view.extent.width, view.extent.height, draw.group[0], draw.group[1]));
    return retina;
}

}  // namespace vesper::render
