#include "render/renderer.h"

#include <string>
#include <utility>

#include "base/error.h"
#include "gpu_scene/retro.h"
#include "gpu_scene/sky.h"
#include "graph/times.h"
#include "render/display_average.h"
#include "render/passes/edges.h"
#include "render/passes/luminaires.h"
#include "render/passes/small_emitters.h"

namespace vesper::render {

Renderer::Renderer(gpu::Device& device, const scene::Scene& scene)
    : device_(device), scene_(std::make_unique<SceneData>(device, scene)), frames_(device) {}

Renderer::SceneData::SceneData(const gpu::Device& device, const scene::Scene& scene)
    : resident(device, scene),
      lamps(gpu_scene::placed_lamps(scene)),
      maps(gpu_scene::map_plan(scene, resident, lamps)),
      directional(gpu_scene::directional_plan(lamps)),
      luminaires(gpu_scene::placed_luminaires(scene)),
      emitting(gpu_scene::emitting_parts(scene)),
      tables(gpu_scene::intensity_tables(scene)),
      table_arena(device),
      table_texels(upload(device, tables.texels)),
      ambient{scene.ambient_illuminance * scene.ambient_colour, scene.sky_luminance * scene.sky_colour} {
    tables.texels = std::vector<glm::vec4>();  // the device has them
    if (scene.environment) {
        const photometry::SkyMap map = photometry::make_sky_map(*scene.environment);
        sky_sharp_side = map.sharp.side, sky_on = map.irradiance;
        sky = upload(device, gpu_scene::sky_texels(map));
    }
    if (!scene.retroreflectors.empty()) retro = upload(device, gpu_scene::retro_texels(scene.retroreflectors));
}

Renderer::TexelBuffer Renderer::SceneData::upload(const gpu::Device& device, const std::vector<glm::vec4>& texels) {
    const auto bytes = std::as_bytes(std::span(texels));
    return {gpu_scene::upload_buffer(device, table_arena, bytes, gpu_scene::kTexelUsage), bytes.size()};
}

void Renderer::set_scene(const scene::Scene& scene) {
    auto data = std::make_unique<const SceneData>(device_, scene);
    frames_.wait();  // frames under way use the old scene
    maps_.reset();
    directional_maps_.reset();
    indirect_.reset();
    lamp_reflections_.reset();
    illuminance_.clear();
    scene_ = std::move(data);
}

void Renderer::keep_maps(std::shared_ptr<Cache> cache) {
    map_cache_ = std::move(cache);
    if (maps_) maps_->use(map_cache_.get());
}

void Renderer::set_radiosity(std::shared_ptr<const transport::Radiosity> radiosity) {
    frames_.wait();
    indirect_ = radiosity ? std::make_unique<IndirectLight>(std::move(radiosity)) : nullptr;
}

RenderSettings ldr_baseline(RenderSettings settings) {
    if (settings.tone_operator != Operator::Ldr) return settings;
    settings.paper_lambert = settings.unit_lamps = settings.lamps_alone = true;
    settings.shadows = false;
    settings.offscreen_lamps.clear();
    if (settings.glare == Glare::Scatter) settings.glare = Glare::None;
    return settings;
}

Renderer::FrameInputs Renderer::inputs_of(graph::FrameGraph& graph, const RenderSettings& settings,
                                          const gpu_scene::View& view, const gpu_scene::SceneFrame& poses) {
    const auto texels = [&graph](const char* name, const TexelBuffer& buffer) {
        if (buffer.bytes == 0) return graph::Resource{};
        return graph.external(name, buffer.buffer.get(), buffer.bytes, VK_FORMAT_R32G32B32A32_SFLOAT);
    };
    FrameInputs in;
    in.lamps = gpu_scene::lamp_list(scene_->lamps, scene_->tables, poses, view);
    if (settings.unit_lamps) gpu_scene::set_to_one(in.lamps, settings.ldr_reference_distance);
    const std::optional<float> white = settings.unit_lamps ? std::optional(1.0f) : std::nullopt;
    in.luminaires = gpu_scene::luminaire_list(scene_->luminaires, poses, view, white);
    in.tables = {texels("intensity tables", scene_->table_texels), scene_->tables.roads, scene_->tables.roads != 0};
    in.clusters = settings.clusters;
    in.edges = settings.anti_aliasing && settings.samples == 1;
    if (in.edges && !settings.unit_lamps && has_facets(device_, scene_->resident))
        in.small_emitters = gpu_scene::small_emitter_list(scene_->emitting, scene_->resident, poses, view);
    in.clusters.far = scene_->resident.farthest_depth(poses, view);
    if (settings.shadows)
        add_maps(graph, in, poses, view, settings.samples > 1 ? kNoShadowBudget : settings.shadow_budget);
    in.shading.all_lamps = settings.all_lamps;
    in.shading.merge_tolerance = settings.all_lamps ? kMergesNothing : settings.merge_error;
    in.shading.faint = settings.shadow_error;
    if (settings.paper_lambert) in.shading.lambert = 1;
    if (settings.unit_lamps) in.shading.emission_limit = 1;
    if (settings.lamps_alone) {
        in.luminaires.glare_sources.clear();
        return in;
    }

    const gpu_scene::AmbientLight ambient = poses.ambient.value_or(scene_->ambient);
    if (poses.tunnels.empty()) in.shading.ambient = ambient.illuminance;
    in.shading.sky = ambient.sky;
    in.shading.retro = texels("retroreflection", scene_->retro);
    in.daylight = {poses.tunnels, ambient.illuminance, in.shading.lambert};
    in.sky = {texels("sky map", scene_->sky), scene_->sky_sharp_side, in.shading.lambert};
    if (settings.indirect) add_indirect_light(graph, in, settings, view, poses, ambient);
    return in;
}

ChainInputs Renderer::chain_inputs_of(const FrameInputs& in, const RenderSettings& settings,
                                      const gpu_scene::View& view, float seconds) {
    ChainInputs chain = frames_.inputs(settings, view, seconds);
    chain.scatter.lamps = settings.offscreen_lamps;
    for (const gpu_scene::GlareSource& source : in.luminaires.glare_sources)
        if (source.inside < 1)
            chain.scatter.lamps.push_back({source.direction, (1 - source.inside) * source.illuminance});
    return chain;
}

// In place of the light that is the same everywhere.
void Renderer::add_indirect_light(graph::FrameGraph& graph, FrameInputs& in, const RenderSettings& settings,
                                  const gpu_scene::View& view, const gpu_scene::SceneFrame& poses,
                                  const gpu_scene::AmbientLight& ambient) {
    if (!illuminance_.empty()) {
        in.illuminance = illuminance_image(graph, view.extent);
    } else if (indirect_) {
        const transport::RadiosityLight light{.factors = poses.dimming,
                                              .sky = glm::dvec3(ambient.sky),
                                              .sky_picture = scene_->sky_on ? &*scene_->sky_on : nullptr,
                                              .reflections = settings.reflections,
                                              .left_out = settings.reflections_left_out};
        in.indirect = indirect_->cells(graph, device_, light, poses.moving, [this] { frames_.wait(); });
        if (!in.indirect.texels) return;  // nothing stands still
        std::vector<transport::LitPatch> patches;
        if (settings.moving_reflections && lamp_reflections_)
            patches = lamp_reflections_->patches(poses.world, poses.dimming, gpu_scene::eye_of(view));
        in.moving = indirect_->moving(graph, device_, patches, poses, view);
    } else {
        return;
    }
    in.shading.ambient = glm::vec3(0);
    in.daylight.tunnels.clear();
    in.sky.lambert = 0;
}

graph::Resource Renderer::illuminance_image(graph::FrameGraph& graph, VkExtent2D extent) const {
    if (illuminance_.size() != uint64_t(extent.width) * extent.height)
        throw Error("illuminance of " + std::to_string(illuminance_.size()) + " pixels for a frame of " +
                    std::to_string(extent.width) + " x " + std::to_string(extent.height) + " px");
    const graph::Resource from = graph.upload("illuminance of pixels", illuminance_);
    const graph::Resource to =
        graph.transient("illuminance", graph::image_shape(VK_FORMAT_R32G32B32A32_SFLOAT, extent));
    graph.copy("bring illuminance", from, to);
    return to;
}

// Maps are drawn while no frame uses them.
void Renderer::add_maps(graph::FrameGraph& graph, FrameInputs& in, const gpu_scene::SceneFrame& poses,
                        const gpu_scene::View& view, uint64_t budget) {
    if (!maps_) {
        maps_ = std::make_unique<DistanceMaps>(device_, scene_->resident, scene_->lamps, scene_->maps);
        maps_->use(map_cache_.get());
    }
    if (maps_->plan(in.lamps, poses, view, budget)) {
        frames_.wait();
        maps_->draw(poses);
    }
    in.shading.maps = maps_->maps(graph, in.lamps, poses, view);
    if (in.lamps.counts.directional == 0) return;
    if (!directional_maps_)
        directional_maps_ =
            std::make_unique<DirectionalMaps>(device_, scene_->resident, scene_->lamps, scene_->directional);
    in.directional_levels = directional_maps_->plan(in.lamps, poses, view);
    if (in.directional_levels > 0) {
        frames_.wait();
        directional_maps_->draw(poses);
    }
    in.directional = directional_maps_->maps(graph, in.lamps, poses, view);
}

Renderer::SceneLight Renderer::declare(const FrameContext& frame, const gpu_scene::SceneFrame& poses,
                                       const FrameInputs& inputs) const {
    const GBuffer surfaces = add_gbuffer(frame, scene_->resident, poses, inputs.small_emitters.parts);
    const Clusters clusters = add_clusters(frame, surfaces.surface, inputs.lamps, inputs.tables, inputs.clusters);
    Blocks blocks = add_blocks(frame, surfaces, clusters);
    blocks = add_visibility(frame, surfaces, clusters, blocks, inputs.shading.maps, inputs.shading.faint);
    blocks = add_directional_visibility(frame, surfaces, clusters, blocks, inputs.directional);
    blocks = add_merging(frame, surfaces, clusters, blocks, inputs.shading.merge_tolerance);
    graph::Resource scene = add_shading(frame, surfaces, clusters, blocks, inputs.shading);
    scene = add_daylight(frame, surfaces, scene, inputs.daylight);
    const graph::Resource moving = add_moving_light(frame, surfaces, inputs.moving);
    scene = add_indirect(frame, surfaces, scene, inputs.indirect, moving, inputs.shading.lambert);
    scene = add_illuminance(frame, surfaces, scene, inputs.illuminance, inputs.shading.lambert);
    scene = add_sky(frame, surfaces, scene, inputs.sky);
    if (inputs.edges) add_edges(frame, surfaces, scene);
    scene = add_small_emitters(frame, surfaces, scene, inputs.small_emitters);
    scene = add_luminaires(frame, scene, surfaces.surface, inputs.luminaires);
    return {scene, clusters, blocks, surfaces};
}

// Pixels with samples belong to what the last of them saw.
void Renderer::add_obstacles(const FrameContext& frame, const RenderSettings& settings,
                             const gpu_scene::SceneFrame& poses, const SceneLight& light, const ToneChain& chain,
                             Pending& pending) const {
    if (settings.obstacles.empty() || settings.tone_operator == Operator::Ldr || !chain.whole_retina) return;
    pending.view = frame.view;
    pending.obstacles = obstacles_in_view(settings.obstacles, poses, frame.view);
    const std::span<const std::byte> instances = frame.graph.resources()[light.surfaces.instances.index].contents;
    pending.of_instances = obstacles_of_instances(settings.obstacles, scene_->resident, instances);
    const graph::Resource sums =
        add_targets(frame, {light.surfaces.triangle, light.luminance, chain.retina_light, chain.whole_retina},
                    {pending.of_instances, pending.obstacles.rects});
    pending.targets =
        add_readback(frame.graph, "targets", sums, pending.obstacles.rects.size() * sizeof(shared::TargetSums));
    const uint64_t pixels = uint64_t{frame.view.extent.width} * frame.view.extent.height;
    pending.triangles = add_readback(frame.graph, "triangle", light.surfaces.triangle, pixels * sizeof(glm::uvec2),
                                     settings.obstacle_pixels);
}

// Samples before the last. Lamps, maps and luminaires are those of the view itself, of which samples see other points.
Renderer::Pending Renderer::add_samples(const RenderSettings& settings, const gpu_scene::View& view,
                                        const gpu_scene::SceneFrame& poses, std::span<const glm::dvec2> places) {
    Pending pending{};
    if (places.empty()) return pending;
    frames_.wait();
    samples_.resize(device_, uint64_t(view.extent.width) * view.extent.height);
    for (const glm::dvec2& place : places) {
        const bool first = &place == places.data();
        graph::FrameGraph graph;
        const FrameInputs inputs = inputs_of(graph, settings, view, poses);
        const FrameContext sample = frames_.context(graph, view.moved(place));
        add_sample(sample, declare(sample, poses, inputs).luminance, samples_.declare(graph), first);
        graph::add_times(pending.earlier, frames_.run(graph));
        if (first && settings.shadows) pending.frame.maps = maps_->report();
        pending.frame.directional_levels += inputs.directional_levels;
        if (watch_samples_) watch_samples_(uint32_t(&place - places.data() + 1));
    }
    return pending;
}

Frame Renderer::render(const RenderSettings& settings, const gpu_scene::View& view, const gpu_scene::SceneFrame& frame,
                       float seconds, const Outputs& outputs) {
    submit(settings, view, frame, seconds, outputs, {});
    const ChainInputs chain = pending_->chain;
    Frame rendered = *finish();
    if (settings.display_average && settings.samples > 1 && outputs.display)
        average_display(ldr_baseline(settings), view, frame, chain, outputs.projection, rendered);
    return rendered;
}

// Samples once more, with the curve that their mean led to.
void Renderer::average_display(const RenderSettings& settings, const gpu_scene::View& view,
                               const gpu_scene::SceneFrame& poses, const ChainInputs& of_mean,
                               const gpu_scene::Projection* projection, Frame& frame) {
    ChainInputs chain = of_mean;
    chain.curve = frame.curve;
    DisplayAverage average(settings.display, size_t(frame.shown_extent.width) * frame.shown_extent.height);
    uint32_t done = settings.samples;
    for (const glm::dvec2& place : sample_places(settings.samples)) {
        graph::FrameGraph graph;
        const FrameInputs inputs = inputs_of(graph, settings, view, poses);
        const SceneLight light = declare(frames_.context(graph, view.moved(place)), poses, inputs);
        const ToneChain shown =
            add_tone_chain(frames_.context(graph, view), light.luminance, settings, chain, {.projection = projection});
        graph::add_times(frame.timings, frames_.run(graph));
        average.add(frames_.executor().read_as<uint8_t>(shown.display));
        if (watch_samples_) watch_samples_(++done);
    }
    frame.display = average.codes();
}

void Renderer::submit(const RenderSettings& given, const gpu_scene::View& view, const gpu_scene::SceneFrame& poses,
                      float seconds, const Outputs& outputs, const graph::SubmitSemaphores& semaphores) {
    const RenderSettings settings = ldr_baseline(given);
    frames_.prepare(settings);
    FrameQueue::Declared frame{.extent = view.extent};
    const std::vector<glm::dvec2> places = sample_places(settings.samples);
    const bool sampled = places.size() > 1;
    Pending pending = add_samples(settings, view, poses, std::span(places).first(places.size() - 1));
    const FrameInputs inputs = inputs_of(frame.graph, settings, view, poses);
    ChainInputs chain = chain_inputs_of(inputs, settings, view, seconds);
    const FrameContext context = frames_.context(frame.graph, view);
    const FrameContext sample = sampled ? frames_.context(frame.graph, view.moved(places.back())) : context;
    SceneLight light = declare(sample, poses, inputs);
    if (sampled) {
        const SampleSums sums = samples_.declare(frame.graph);
        add_sample(sample, light.luminance, sums, false);
        light.luminance = add_mean_of_samples(context, sums, settings.samples);
    }
    frame.chain = add_tone_chain(context, light.luminance, settings, chain, outputs);
    add_obstacles(context, settings, poses, light, frame.chain, pending);
    pending.clusters =
        add_readback(frame.graph, "cluster report", light.clusters.report, sizeof(shared::ClusterReport));
    pending.visibility =
        add_readback(frame.graph, "visibility report", light.blocks.visibility, sizeof(shared::VisibilityReport));
    pending.frame.far = light.clusters.push.far;
    frames_.submit(std::move(frame), chain, semaphores);
    // Nothing fails from here on.
    if (settings.shadows && !sampled) pending.frame.maps = maps_->report();
    pending.frame.directional_levels += inputs.directional_levels;
    pending.frame.lamps = uint32_t(inputs.lamps.lamps.size());
    pending.frame.luminaires = uint32_t(inputs.luminaires.luminaires.size());
    pending.frame.glare_sources = inputs.luminaires.glare_sources;
    pending.frame.outside = chain.scatter.lamps;
    pending.chain = std::move(chain);
    pending_ = std::move(pending);
}

std::optional<Frame> Renderer::finish() {
    std::optional<ToneMapped> shown = frames_.finish();
    if (!shown) return std::nullopt;
    Frame frame = std::move(pending_->frame);
    static_cast<ToneMapped&>(frame) = std::move(*shown);
    frame.clusters = read_one<shared::ClusterReport>(frames_.executor(), pending_->clusters);
    frame.visibility = read_one<shared::VisibilityReport>(frames_.executor(), pending_->visibility);
    if (pending_->targets) {
        const auto sums = frames_.executor().read_as<shared::TargetSums>(pending_->targets);
        measure(pending_->obstacles, sums, pending_->view);
        frame.obstacles = std::move(pending_->obstacles.seen);
    }
    if (pending_->triangles)
        frame.obstacle_pixels =
            obstacles_of_pixels(frames_.executor().read_as<glm::uvec2>(pending_->triangles), pending_->of_instances);
    graph::add_times(frame.timings, pending_->earlier);
    return frame;
}

}  // namespace vesper::render
