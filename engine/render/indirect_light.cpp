#include "render/indirect_light.h"

namespace vesper::render {

IndirectLight::IndirectLight(const gpu::Device& device, std::shared_ptr<const transport::Radiosity> radiosity)
    : radiosity_(std::move(radiosity)), sources_(radiosity_->source_nodes()), arena_(device) {
    if (radiosity_->cells() > 0) {
        const gpu_scene::IrradianceCells dark =
            gpu_scene::irradiance_cells(*radiosity_, std::vector<glm::vec3>(radiosity_->cells()));
        bytes_ = std::as_bytes(std::span(dark.texels)).size(), log2_places_ = dark.log2_places;
        texels_ = gpu::make_buffer(device, bytes_, gpu::kTexelUsage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        arena_.bind(texels_.get());
    }
    if (radiosity_->bodies.hidden.empty()) return;
    const std::vector<glm::uvec4> volumes = gpu_scene::volume_texels(radiosity_->bodies);
    const auto bytes = std::as_bytes(std::span(volumes));
    volumes_ = gpu::upload_buffer(device, arena_, bytes, gpu::kTexelUsage);
    volume_bytes_ = bytes.size();
}

bool IndirectLight::solve(const transport::RadiosityLight& light, const std::vector<bool>& moving) {
    if (radiosity_->cells() == 0) return false;
    Lit lit{std::vector<float>(sources_.size(), 1), light.sky, light.reflections, light.reflection_error};
    std::vector<float> factors(sources_.empty() ? 0 : sources_.back() + size_t{1});  // of nodes
    for (size_t i = 0; i < sources_.size(); ++i) {
        const uint32_t node = sources_[i];
        if (!light.factors.empty()) lit.factors[i] = light.factors[node];
        if (!moving.empty() && moving[node]) lit.factors[i] = 0;
        factors[node] = lit.factors[i];
    }
    if (lit == lit_) return true;
    transport::RadiosityLight now = light;
    now.factors = factors;
    table_ = gpu_scene::irradiance_cells(*radiosity_, radiosity_->solve(now).other);
    lit_ = std::move(lit);
    return true;
}

IndirectCells IndirectLight::cells(graph::FrameGraph& graph, const transport::RadiosityLight& light) {
    const graph::Resource texels = graph.persistent("irradiance cells", texels_, bytes_, VK_FORMAT_R32G32B32A32_UINT);
    if (!table_.texels.empty()) graph.copy("bring irradiance cells", graph.upload("irradiance", table_.texels), texels);
    table_ = {};
    return {.texels = texels,
            .log2_places = log2_places_,
            .grid = radiosity_->grid,
            .sky_above = glm::vec3(transport::open_sky(light, {0, 1, 0})),
            .sky_below = glm::vec3(transport::open_sky(light, {0, -1, 0}))};
}

MovingLight IndirectLight::moving(graph::FrameGraph& graph, std::span<const transport::LitPatch> patches,
                                  const gpu_scene::SceneFrame& poses, const gpu_scene::View& view) const {
    const transport::MovingBodies& bodies = radiosity_->bodies;
    MovingLight moving{.things = gpu_scene::moving_things(bodies, patches, poses, view)};
    if (!bodies.hidden.empty())
        moving.volumes = graph.external("volumes of occlusion", volumes_, volume_bytes_, VK_FORMAT_R32G32B32A32_UINT);
    return moving;
}

}  // namespace vesper::render
