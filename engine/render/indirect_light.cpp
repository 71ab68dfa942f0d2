#include "render/indirect_light.h"

#include "gpu_scene/irradiance_cells.h"

namespace vesper::render {

IndirectCells IndirectLight::cells(graph::FrameGraph& graph, const gpu::Device& device,
                                   const transport::RadiosityLight& light, const std::vector<bool>& moving,
                                   const std::function<void()>& wait) {
    if (radiosity_->cells() == 0) return {};
    Lit lit{std::vector<float>(sources_.size(), 1), light.sky, light.reflections, light.left_out};
    std::vector<float> factors(sources_.empty() ? 0 : sources_.back() + size_t{1});  // of nodes
    for (size_t i = 0; i < sources_.size(); ++i) {
        const uint32_t node = sources_[i];
        if (!light.factors.empty()) lit.factors[i] = light.factors[node];
        if (!moving.empty() && moving[node]) lit.factors[i] = 0;
        factors[node] = lit.factors[i];
    }
    if (lit != lit_) {
        transport::RadiosityLight now = light;
        now.factors = factors;
        const gpu_scene::IrradianceCells table = gpu_scene::irradiance_cells(*radiosity_, radiosity_->solve(now).other);
        wait();
        lit_.reset(), texels_ = {};
        arena_.emplace(device);
        const auto bytes = std::as_bytes(std::span(table.texels));
        texels_ = gpu_scene::upload_buffer(device, *arena_, bytes, gpu_scene::kTexelUsage);
        bytes_ = bytes.size(), log2_places_ = table.log2_places;
        lit_ = std::move(lit);
    }
    return {.texels = graph.external("irradiance cells", texels_.get(), bytes_, VK_FORMAT_R32G32B32A32_UINT),
            .log2_places = log2_places_,
            .grid = radiosity_->grid,
            .sky_above = glm::vec3(transport::open_sky(light, {0, 1, 0})),
            .sky_below = glm::vec3(transport::open_sky(light, {0, -1, 0}))};
}

MovingLight IndirectLight::moving(graph::FrameGraph& graph, const gpu::Device& device,
                                  std::span<const transport::LitPatch> patches, const gpu_scene::SceneFrame& poses,
                                  const gpu_scene::View& view) {
    const transport::MovingBodies& bodies = radiosity_->bodies;
    MovingLight moving{.things = gpu_scene::moving_things(bodies, patches, poses, view)};
    if (bodies.hidden.empty()) return moving;
    if (volume_bytes_ == 0) {
        const std::vector<uint32_t> texels = gpu_scene::volume_texels(bodies);
        const auto bytes = std::as_bytes(std::span(texels));
        volume_arena_.emplace(device);
        volumes_ = gpu_scene::upload_buffer(device, *volume_arena_, bytes, gpu_scene::kTexelUsage);
        volume_bytes_ = bytes.size();
    }
    moving.volumes = graph.external("volumes of occlusion", volumes_.get(), volume_bytes_, VK_FORMAT_R32_UINT);
    return moving;
}

}  // namespace vesper::render
