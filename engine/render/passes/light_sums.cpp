#include "render/passes/light_sums.h"

#include "shaders/light_sums/light_nodes.comp.inc"
#include "shaders/light_sums/light_sums.comp.inc"
#include "shared/light_sums.h"
#include "vision/light_nodes.h"

namespace vesper::render {
namespace {

using graph::Resource, graph::load, graph::store, graph::update;

constexpr gpu::Shader kLightSums{"light_sums.comp", light_sums_comp}, kLightNodes{"light_nodes.comp", light_nodes_comp};

}  // namespace

Resource add_light_sums(const FrameContext& frame, Resource picture, std::span<const uint32_t> nodes) {
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const vision::ImageAngles image = gpu_scene::angles_of(view);
    const vision::LightNodes all(image);
    const glm::vec2 scale = view.ray_scale(), offset = view.ray_offset();
    const auto area = float(image.pixel().x * image.pixel().y);
    const uint32_t pixels = view.extent.width * view.extent.height,
                   coarse = std::max(all.first.back() - pixels, 1u);  // a picture of one pixel has no other level
    const Resource sums = graph.transient("light sums", graph::buffer_shape(uint64_t{coarse} * sizeof(glm::vec4)));
    graph.clear("light sums", sums);
    for (size_t l = 1; l < all.sizes.size(); ++l) {
        const glm::uvec2 from(all.sizes[l - 1]), to(all.sizes[l]);
        const bool first = l == 1;
        const gpu::Kernel& kernel = frame.kernels.get(kLightSums, {first});
        graph.dispatch("light sums " + std::to_string(l), kernel, {load(picture), update(sums)},
                       shared::LightSumsPush{from, to, first ? 0 : all.first[l - 1] - pixels, all.first[l] - pixels,
                                             scale, offset, area},
                       graph::cover(to.x, to.y, kernel.group[0], kernel.group[1]));
    }
    const auto count = uint32_t(nodes.size());
    const Resource light = graph.transient("light of nodes", graph::buffer_shape(count * sizeof(glm::vec4)));
    const gpu::Kernel& kernel = frame.kernels.get(kLightNodes);
    const Resource wanted = graph.upload("nodes", std::as_bytes(nodes));
    graph.dispatch("light of nodes", kernel, {load(picture), load(sums), load(wanted), store(light)},
                   shared::LightNodesPush{{view.extent.width, view.extent.height}, count, scale, offset, area},
                   graph::cover(count, 1, kernel.group[0], 1));
    return light;
}

}  // namespace vesper::render
