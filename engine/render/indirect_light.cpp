#include "render/indirect_light.h"

#include "gpu_scene/irradiance_cells.h"

namespace vesper::render {

IndirectCells IndirectLight::cells(graph::FrameGraph& graph, const gpu::Device& device,
                                   const transport::RadiosityLight& light, const std::function<void()>& wait) {
    if (radiosity_->cells() == 0) return {};
    Lit lit{std::vector<float>(sources_.size(), 1), light.sky, light.reflections};
    for (size_t i = 0; i < sources_.size() && !light.factors.empty(); ++i) lit.factors[i] = light.factors[sources_[i]];
    if (lit != lit_) {
        const gpu_scene::IrradianceCells table =
            gpu_scene::irradiance_cells(*radiosity_, radiosity_->solve(light).other);
        wait();
        lit_.reset(), texels_ = {};
        arena_.emplace(device);
        const auto bytes = std::as_bytes(std::span(table.texels));
        texels_ = gpu_scene::upload_buffer(device, *arena_, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
        bytes_ = bytes.size(), log2_places_ = table.log2_places;
        lit_ = std::move(lit);
    }
    return {graph.external("irradiance cells", texels_.get(), bytes_, VK_FORMAT_R32G32B32A32_UINT), log2_places_,
            radiosity_->grid};
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
        volumes_ = gpu_scene::upload_buffer(device, *volume_arena_, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
        volume_bytes_ = bytes.size();
    }
    moving.volumes = graph.external("volumes of occlusion", volumes_.get(), volume_bytes_, VK_FORMAT_R32_UINT);
    return moving;
}

}  // namespace vesper::render
