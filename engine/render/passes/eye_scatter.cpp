#include "render/passes/eye_scatter.h"

#include <algorithm>
#include <functional>

#include "shaders/eye_scatter/scatter_down.comp.inc"
#include "shaders/eye_scatter/scatter_edge.comp.inc"
#include "shaders/eye_scatter/scatter_top.comp.inc"
#include "shaders/eye_scatter/scatter_up.comp.inc"
#include "shared/eye_scatter.h"

namespace vesper::render {
namespace {

using graph::Resource, graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kScatterUp{"scatter_up.comp", scatter_up_comp, scatter_up_comp_storage},
    kScatterTop{"scatter_top.comp", scatter_top_comp, scatter_top_comp_storage},
    kScatterDown{"scatter_down.comp", scatter_down_comp, scatter_down_comp_storage},
    kScatterEdge{"scatter_edge.comp", scatter_edge_comp, scatter_edge_comp_storage};

// Texels that one invocation of scatter_up.comp does.
VkExtent2D scatter_up_strip(const gpu::Device& device) {
    return device.is_cpu() ? VkExtent2D{8, 32} : VkExtent2D{1, 1};
}

graph::Groups cover_strips(VkExtent2D size, const gpu::Kernel& kernel, VkExtent2D strip) {
    return graph::cover(size.width, size.height, kernel.group[0] * strip.width, kernel.group[1] * strip.height);
}

VkExtent2D with_margin(VkExtent2D size, uint32_t margin) { return {size.width + 2 * margin, size.height + 2 * margin}; }

}  // namespace

Resource add_eye_scatter(const FrameContext& frame, Resource scene, const ScatterInputs& inputs) {
    using namespace shared;
    if (!inputs.fit) return scene;
    graph::FrameGraph& graph = frame.graph;
    const eye::GpuScatter& fit = *inputs.fit;
    const glm::ivec2 down = eye::scatter_down_strip(frame.kernels.device());
    const VkExtent2D up_strip = scatter_up_strip(frame.kernels.device()),
                     down_strip{uint32_t(down.x), uint32_t(down.y)};
    const int top = fit.levels();
    const auto texels = [&](const char* name, eye::GpuScatter::Texels t, VkFormat format) {
        return graph.external(name, t.buffer, t.bytes, format);
    };
    const auto at_least_one = [](std::vector<glm::vec4> list) {
        return list.empty() ? std::vector{glm::vec4(0)} : list;
    };
    const Resource taps = texels("scatter taps", fit.taps(), VK_FORMAT_R32G32B32A32_SFLOAT);

    std::vector<Resource> levels{scene};
    std::vector<VkExtent2D> sizes{{uint32_t(fit.image().width), uint32_t(fit.image().height)}};
    for (int l = 1; l <= top; ++l) {
        const VkExtent2D below = sizes.back(), size{(below.width + 1) / 2, (below.height + 1) / 2};
        const VkExtent2D from = l == 1 ? below : with_margin(below, kScatterUpMargin),
                         to = with_margin(size, kScatterUpMargin);
        const std::string name = "scatter up " + std::to_string(l);
        const std::vector<glm::vec4> outside = fit.lamps_of(l, inputs.lamps);
        const Resource list = graph.upload(name + " lamps", at_least_one(outside), VK_FORMAT_R32G32B32A32_SFLOAT);
        const bool more = inputs.pictures && l > 1;
        const Resource others =
            graph.upload(name + " pictures", more ? inputs.pictures->levels[size_t(l)] : at_least_one({}),
                         VK_FORMAT_R32G32B32A32_SFLOAT);
        const Resource image = graph.transient(name, graph::image_shape(kSceneFormat, to));
        const gpu::Kernel& kernel = frame.kernels.get(kScatterUp, {up_strip.width, up_strip.height, l == 1});
        graph.dispatch(
            name, kernel, {load(levels.back()), sample(list), sample(others), store(image)},
            ScatterUpPush{
                {from.width, from.height}, {to.width, to.height}, uint32_t(outside.size() / 2), more ? 1u : 0u},
            cover_strips(to, kernel, up_strip));
        levels.push_back(image);
        sizes.push_back(size);
    }

    const VkExtent2D takes = with_margin(sizes.back(), kScatterDownMargin);
    Resource seen = graph.transient("scatter top", graph::image_shape(kSceneFormat, takes));
    const Resource weights = texels("scatter weights", fit.top(), VK_FORMAT_R32G32B32A32_SFLOAT);
    std::vector<glm::vec4> far = fit.far_veil(inputs.lamps);
    if (inputs.pictures)
        std::transform(far.begin(), far.end(), inputs.pictures->veil.begin(), far.begin(), std::plus());
    const Resource veil = graph.upload("veil of far lamps", far, VK_FORMAT_R32G32B32A32_SFLOAT);
    const gpu::Kernel& top_kernel = frame.kernels.get(kScatterTop);
    graph.dispatch("scatter top", top_kernel, {load(levels.back()), sample(weights), sample(veil), store(seen)},
                   ScatterTopPush{{sizes.back().width, sizes.back().height}},
                   graph::cover((takes.width * takes.height + 3) / 4, 1, top_kernel.group[0], 1));

    for (int l = top - 1; l >= 0; --l) {
        const VkExtent2D size = l == 0 ? sizes[0] : with_margin(sizes[size_t(l)], kScatterDownMargin);
        const std::string name = "scatter down " + std::to_string(l);
        const Resource image = graph.transient(name, graph::image_shape(kSceneFormat, size));
        const gpu::Kernel& kernel = frame.kernels.get(kScatterDown, {down_strip.width, l == 0, uint32_t(fit.reach())});
        const auto rows = uint32_t(vision::scatter_strip(fit.image(), fit.nodes(), l, int(down_strip.height)));
        const glm::vec2 scale =
            glm::vec2(fit.nodes() - 1) * float(1 << l) / glm::vec2(fit.image().width, fit.image().height);
        graph.dispatch(name, kernel, {load(levels[size_t(l)]), load(seen), sample(taps), store(image)},
                       ScatterDownPush{
                           {size.width, size.height}, glm::uvec2(fit.nodes()), uint32_t(top), uint32_t(l), rows, scale},
                       cover_strips(size, kernel, {down_strip.width, rows}));
        seen = image;
    }
    const vision::EdgeLight::Axis &x = fit.edge_x(), &y = fit.edge_y();
    const ScatterEdgePush edge{{sizes[0].width, sizes[0].height},
                               {uint32_t(x.deep), uint32_t(y.deep)},
                               {uint32_t(x.between), uint32_t(y.between)}};
    const uint32_t pixels = 2 * (edge.deep.y * edge.size.x + edge.deep.x * (edge.size.y - 2 * edge.deep.y));
    const gpu::Kernel& edge_kernel = frame.kernels.get(kScatterEdge);
    if (pixels > 0)
        graph.dispatch(
            "scatter edge", edge_kernel,
            {load(scene), sample(texels("scatter edge light", fit.edge(), VK_FORMAT_R32_SFLOAT)), update(seen)}, edge,
            graph::cover(pixels, 1, edge_kernel.group[0], 1));
    return seen;
}

}  // namespace vesper::render
