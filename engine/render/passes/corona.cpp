#include "render/passes/passes.h"
#include "shared/corona.h"

namespace vesper {

Resource add_corona(FrameGraph& graph, const Kernels& kernels, Resource scene, Resource seen, const std::vector<glm::vec4>& pattern, const View& view) {
    using namespace shared;
    const uint32_t columns = (view.extent.width + kCoronaTile - 1) / kCoronaTile, rows = (view.extent.height + kCoronaTile - 1) / kCoronaTile;
    const CoronaPush push{{view.extent.width, view.extent.height}, view.ray_scale(), view.ray_offset()};
    const Resource tiles = graph.transient("corona tiles", buffer_shape(uint64_t{columns} * rows * sizeof(CoronaTile)));
    const Resource lamps = graph.transient("corona lamps", buffer_shape(kCoronaLamps * sizeof(CoronaLamp)));
    const Resource texels = graph.upload("corona pattern", pattern, VK_FORMAT_R32G32B32A32_SFLOAT);
    graph.dispatch("corona tiles", kernels.corona_tiles, {load(scene), store(tiles)}, push, cover(columns, rows, kernels.corona_tiles.group[0], 1));
    graph.dispatch("corona lamps", kernels.corona_pick, {load(tiles), store(lamps)}, push, {1, 1, 1});
    graph.dispatch("corona", kernels.corona, {load(lamps), sample(texels), update(seen)}, push,
                   cover(view.extent.width, view.extent.height, kernels.corona.group[0], kernels.corona.group[1]));
    return seen;
}

}  // namespace vesper
