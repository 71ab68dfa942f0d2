#include <algorithm>
#include <functional>

#include "render/passes/passes.h"
#include "shared/scatter.h"

namespace vesper {
namespace {

Groups cover_strips(VkExtent2D size, const Kernel& kernel, VkExtent2D strip) {
    return cover(size.width, size.height, kernel.group[0] * strip.width, kernel.group[1] * strip.height);
}

VkExtent2D with_margin(VkExtent2D size, uint32_t margin) { return {size.width + 2 * margin, size.height + 2 * margin}; }

}  // namespace

Resource add_scatter(FrameGraph& graph, const Kernels& kernels, Resource scene, const GpuScatter& fit, const std::vector<OffscreenLamp>& lamps,
                     const OffscreenLight* beyond) {
    using namespace shared;
    const int top = fit.levels();
    const auto texels = [&](const char* name, GpuScatter::Texels t, VkFormat format) { return graph.external(name, t.buffer, t.bytes, format); };
    const auto at_least_one = [](std::vector<glm::vec4> list) { return list.empty() ? std::vector{glm::vec4(0)} : list; };
    const Resource taps = texels("scatter taps", fit.taps(), VK_FORMAT_R32G32B32A32_SFLOAT);

    std::vector<Resource> levels{scene};
    std::vector<VkExtent2D> sizes{{uint32_t(fit.image().width), uint32_t(fit.image().height)}};
    for (int l = 1; l <= top; ++l) {
        const VkExtent2D below = sizes.back(), size{(below.width + 1) / 2, (below.height + 1) / 2};
        const VkExtent2D from = l == 1 ? below : with_margin(below, kScatterUpMargin), to = with_margin(size, kScatterUpMargin);
        const std::string name = "scatter up " + std::to_string(l);
        const std::vector<glm::vec4> outside = fit.lamps_of(l, lamps);
        const Resource list = graph.upload(name + " lamps", at_least_one(outside), VK_FORMAT_R32G32B32A32_SFLOAT);
        const bool more = beyond && l > 1;
        const Resource others = graph.upload(name + " beyond", more ? beyond->levels[size_t(l)] : at_least_one({}), VK_FORMAT_R32G32B32A32_SFLOAT);
        const Resource image = graph.transient(name, image_shape(kSceneFormat, to));
        const Kernel& kernel = l == 1 ? kernels.scatter_up_first : kernels.scatter_up;
        graph.dispatch(name, kernel, {load(levels.back()), sample(list), sample(others), store(image)},
                       ScatterUpPush{{from.width, from.height}, {to.width, to.height}, uint32_t(outside.size() / 2), more ? 1u : 0u},
                       cover_strips(to, kernel, kernels.scatter_up_strip));
        levels.push_back(image);
        sizes.push_back(size);
    }

    const VkExtent2D takes = with_margin(sizes.back(), kScatterDownMargin);
    Resource seen = graph.transient("scatter top", image_shape(kSceneFormat, takes));
    const Resource weights = texels("scatter weights", fit.top(), VK_FORMAT_R32G32B32A32_SFLOAT);
    std::vector<glm::vec4> far = fit.far_veil(lamps);
    if (beyond) std::transform(far.begin(), far.end(), beyond->veil.begin(), far.begin(), std::plus());
    const Resource veil = graph.upload("veil of far lamps", far, VK_FORMAT_R32G32B32A32_SFLOAT);
    graph.dispatch("scatter top", kernels.scatter_top, {load(levels.back()), sample(weights), sample(veil), store(seen)},
                   ScatterTopPush{{sizes.back().width, sizes.back().height}}, cover((takes.width * takes.height + 3) / 4, 1, kernels.scatter_top.group[0], 1));

    const bool wide = fit.reach() == kWideTapReach;
    for (int l = top - 1; l >= 0; --l) {
        const VkExtent2D size = l == 0 ? sizes[0] : with_margin(sizes[size_t(l)], kScatterDownMargin);
        const std::string name = "scatter down " + std::to_string(l);
        const Resource image = graph.transient(name, image_shape(kSceneFormat, size));
        const Kernel& kernel = l == 0 ? (wide ? kernels.scatter_down_wide_last : kernels.scatter_down_last) : wide ? kernels.scatter_down_wide : kernels.scatter_down;
        const auto rows = uint32_t(scatter_strip(fit.image(), fit.nodes(), l, int(kernels.scatter_down_strip.height)));
        const glm::vec2 scale = glm::vec2(fit.nodes() - 1) * float(1 << l) / glm::vec2(fit.image().width, fit.image().height);
        graph.dispatch(name, kernel, {load(levels[size_t(l)]), load(seen), sample(taps), store(image)},
                       ScatterDownPush{{size.width, size.height}, glm::uvec2(fit.nodes()), uint32_t(top), uint32_t(l), rows, scale},
                       cover_strips(size, kernel, {kernels.scatter_down_strip.width, rows}));
        seen = image;
    }
    const EdgeLight::Axis &x = fit.edge_x(), &y = fit.edge_y();
    const ScatterEdgePush edge{{sizes[0].width, sizes[0].height}, {uint32_t(x.deep), uint32_t(y.deep)}, {uint32_t(x.between), uint32_t(y.between)}};
    const uint32_t pixels = 2 * (edge.deep.y * edge.size.x + edge.deep.x * (edge.size.y - 2 * edge.deep.y));
    if (pixels > 0)
        graph.dispatch("scatter edge", kernels.scatter_edge, {load(scene), sample(texels("scatter edge light", fit.edge(), VK_FORMAT_R32_SFLOAT)), update(seen)}, edge,
                       cover(pixels, 1, kernels.scatter_edge.group[0], 1));
    return seen;
}

}  // namespace vesper
