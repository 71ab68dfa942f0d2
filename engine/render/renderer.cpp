#include "render/renderer.h"

#include <optional>

#include "gpu_scene/retro.h"
#include "gpu_scene/sky.h"

namespace vesper {

Renderer::Renderer(Device& device, const Scene& scene)
    : device_(device), kernels_(device), scene_(std::make_unique<Drawn>(device, scene)), eye_(device), executor_(device) {}

Renderer::Drawn::Drawn(const Device& device, const Scene& scene)
    : resident(device, scene),
      lamps(placed_lamps(scene)),
      luminaires(placed_luminaires(scene)),
      tables(intensity_tables(scene)),
      table_arena(device),
      table_texels(upload(device, tables.texels)),
      ambient{scene.ambient_illuminance * scene.ambient_colour, scene.sky_luminance * scene.sky_colour} {
    tables.texels = std::vector<glm::vec4>();  // the device has them
    if (scene.environment) {
        const SkyMap map = make_sky_map(*scene.environment);
        sky_sharp_side = map.sharp.side;
        sky = upload(device, sky_texels(map));
    }
    if (!scene.retroreflectors.empty()) retro = upload(device, retro_texels(scene.retroreflectors));
}

Renderer::TexelBuffer Renderer::Drawn::upload(const Device& device, const std::vector<glm::vec4>& texels) {
    const auto bytes = std::as_bytes(std::span(texels));
    return {upload_buffer(device, table_arena, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT), bytes.size()};
}

void Renderer::set_scene(const Scene& scene) {
    auto drawn = std::make_unique<const Drawn>(device_, scene);
    executor_.wait();  // what is under way uses the one that goes
    scene_ = std::move(drawn);
}

Resource Renderer::TexelBuffer::in(FrameGraph& graph, const std::string& name) const {
    return graph.external(name, buffer.get(), bytes, VK_FORMAT_R32G32B32A32_SFLOAT);
}

Renderer::Declared Renderer::declare(FrameGraph& graph, const RenderSettings& settings, const View& view, const SceneFrame& frame,
                                     const LampList& lamps, const LuminaireList& luminaires, const ChainInputs& given, const Outputs& outputs) const {
    const bool ldr = settings.tone_operator == Operator::Ldr;
    ClusterSettings clustering = settings.clusters;
    clustering.far = scene_->resident.farthest_depth(frame, view);
    ShadeSettings shading{.all_lamps = settings.all_lamps};
    if (ldr || settings.paper_lambert) shading.lambert = 1;
    const AmbientLight ambient = frame.ambient.value_or(scene_->ambient);
    if (ldr)
        shading.emission_limit = 1;
    else
        shading.ambient = frame.tunnels.empty() ? ambient.illuminance : glm::vec3(0), shading.sky = ambient.sky;

    const GBuffer surfaces = add_gbuffer(graph, scene_->resident, frame, view);
    const TableTexels tables{scene_->table_texels.in(graph, "maps"), scene_->tables.roads, scene_->tables.roads != 0};
    const Clusters clusters = add_clusters(graph, kernels_, surfaces.surface, lamps, tables, view, clustering);
    if (scene_->retro && !ldr) shading.retro = scene_->retro.in(graph, "retroreflection");
    Resource scene = add_shading(graph, kernels_, surfaces, clusters, view, shading);
    if (!frame.tunnels.empty() && !ldr) scene = add_daylight(graph, kernels_, surfaces, scene, frame.tunnels, view, ambient.illuminance, shading.lambert);
    if (scene_->sky && !ldr) {
        const Resource sky = scene_->sky.in(graph, "sky map");
        scene = add_sky(graph, kernels_, surfaces, scene, sky, scene_->sky_sharp_side, view, shading.lambert);
    }
    scene = add_luminaires(graph, kernels_, scene, surfaces.surface, luminaires, view);
    return {.chain = add_tone_chain(graph, kernels_, scene, view, settings, given, outputs),
            .clusters = add_readback(graph, "cluster report", clusters.report, sizeof(shared::ClusterReport)),
            .far = clusters.push.far};
}

Frame Renderer::render(const RenderSettings& settings, const View& view, const SceneFrame& frame, float seconds, const Outputs& outputs) {
    submit(settings, view, frame, seconds, outputs, {});
    return *finish();
}

void Renderer::submit(const RenderSettings& settings, const View& view, const SceneFrame& frame, float seconds, const Outputs& outputs, const SubmitSemaphores& semaphores) {
    if (EyeKeeper::looks_back(settings)) finish();
    Pending pending{};
    const bool ldr = settings.tone_operator == Operator::Ldr;
    LampList lamps = lamp_list(scene_->lamps, scene_->tables, frame, view);
    if (ldr) set_to_one(lamps, settings.ldr_reference_distance);
    LuminaireList luminaires = luminaire_list(scene_->luminaires, frame, view, ldr ? std::optional(1.0f) : std::nullopt);

    ToneChainSettings chain = settings;
    if (ldr && chain.glare == Glare::Scatter) chain.glare = Glare::None;
    ChainInputs given = eye_.inputs(executor_, chain, view, seconds);
    if (!ldr) {
        given.outside = settings.offscreen_lamps;
        for (const GlareSource& source : luminaires.glare_sources)
            if (source.inside < 1) given.outside.push_back({source.direction, (1 - source.inside) * source.illuminance});
    }

    FrameGraph graph;
    pending.declared = declare(graph, settings, view, frame, lamps, luminaires, given, outputs);
    Frame& result = pending.frame;
    result.extent = view.extent;
    result.host_times.declare = pending.watch.milliseconds();
    if (given.corona) result.pupil = given.corona->pupil, result.pattern_milliseconds = given.corona->milliseconds;
    result.lamps = uint32_t(lamps.lamps.size());
    result.luminaires = uint32_t(luminaires.luminaires.size());
    result.far = pending.declared.far;
    if (!ldr) result.glare_sources = std::move(luminaires.glare_sources);
    result.outside = std::move(given.outside);

    executor_.submit(graph, semaphores);
    // Nothing fails from here on.
    eye_.submitted();
    graph_ = std::move(graph);
    pending_ = std::move(pending);
}

std::optional<Frame> Renderer::finish() {
    if (!executor_.finish()) pending_.reset();
    if (!pending_) return std::nullopt;
    Frame result = std::move(pending_->frame);
    const double declared_after = result.host_times.declare;
    result.milliseconds = pending_->watch.milliseconds();
    read_tone_chain(executor_, pending_->declared.chain, result.extent, result);
    result.host_times.declare = declared_after;
    eye_.read(result.eye);
    result.clusters = read_one<shared::ClusterReport>(executor_, pending_->declared.clusters);
    pending_.reset();
    return result;
}

}  // namespace vesper
