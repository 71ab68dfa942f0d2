#include "renderer.h"

#include <optional>

#include "base/stopwatch.h"
#include "resident/retro.h"
#include "resident/sky.h"

namespace vesper {
Renderer::Renderer(Device& device, const Scene& scene)
    : kernels_(device),
      resident_(device, scene),
      lights_(placed_lights(scene)),
      sources_(placed_sources(scene)),
      maps_(light_maps(scene)),
      map_arena_(device),
      map_texels_(upload_texels(device, maps_.texels)),
      ambient_{scene.ambient_illuminance * scene.ambient_colour, scene.sky_luminance * scene.sky_colour},
      scatter_(device),
      executor_(device) {
    maps_.texels = std::vector<glm::vec4>();  // the device has them
    if (scene.environment) {
        const SkyMap map = make_sky_map(*scene.environment);
        sky_sharp_side_ = map.sharp.side;
        sky_ = upload_texels(device, sky_texels(map));
    }
    if (!scene.retroreflectors.empty()) retro_ = upload_texels(device, retro_texels(scene.retroreflectors));
}

Renderer::TexelBuffer Renderer::upload_texels(const Device& device, const std::vector<glm::vec4>& texels) {
    const auto bytes = std::as_bytes(std::span(texels));
    return {upload_buffer(device, map_arena_, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT), bytes.size()};
}

Resource Renderer::TexelBuffer::in(FrameGraph& graph, const std::string& name) const {
    return graph.external(name, buffer.get(), bytes, VK_FORMAT_R32G32B32A32_SFLOAT);
}

Renderer::Declared Renderer::declare(FrameGraph& graph, const RenderSettings& settings, const View& view, const SceneFrame& frame,
                                     const LightList& lights, const SourceList& sources, const ChainInputs& given, Outputs outputs) const {
    const bool ldr = settings.tone_operator == Operator::Ldr;
    ClusterSettings clustering = settings.clusters;
    clustering.far = resident_.farthest_depth(frame, view.world_to_view);
    ShadeSettings shading{.all_lights = settings.all_lights};
    if (ldr || settings.paper_lambert) shading.lambert = 1;
    const AmbientLight ambient = frame.ambient.value_or(ambient_);
    if (ldr)
        shading.emission_limit = 1;
    else
        shading.ambient = frame.tunnels.empty() ? ambient.illuminance : glm::vec3(0), shading.sky = ambient.sky;

    const GBuffer surfaces = add_gbuffer(graph, resident_, frame, view);
    const MapTexels maps{map_texels_.in(graph, "maps"), maps_.roads.empty() ? 0 : maps_.roads.front(), !maps_.roads.empty()};
    const Clusters clusters = add_clusters(graph, kernels_, lights, maps, view, clustering);
    if (retro_ && !ldr) shading.retro = retro_.in(graph, "retroreflection");
    Resource scene = add_shading(graph, kernels_, surfaces, clusters, view, shading);
    if (!frame.tunnels.empty() && !ldr) scene = add_daylight(graph, kernels_, surfaces, scene, frame.tunnels, view, ambient.illuminance, shading.lambert);
    if (sky_ && !ldr) {
        const Resource sky = sky_.in(graph, "sky map");
        scene = add_sky(graph, kernels_, surfaces, scene, sky, sky_sharp_side_, view, shading.lambert);
    }
    scene = add_sources(graph, kernels_, scene, surfaces.surface, sources, view);
    return {.chain = add_tone_chain(graph, kernels_, scene, view, settings, given, outputs),
            .clusters = bring_back(graph, "cluster report", clusters.report, sizeof(shared::ClusterReport)),
            .far = clusters.push.far};
}

Frame Renderer::render(const RenderSettings& settings, const View& view, const SceneFrame& frame, float seconds, Outputs outputs) {
    const Stopwatch watch;
    const bool ldr = settings.tone_operator == Operator::Ldr;
    LightList lights = light_list(lights_, maps_, frame, view);
    if (ldr) set_to_one(lights, settings.ldr_reference_distance);
    SourceList sources = source_list(sources_, frame, view, ldr ? std::optional(1.0f) : std::nullopt);

    ChainInputs given{.seconds = seconds, .remembered = eye_ ? &*eye_ : nullptr, .scatter = nullptr, .corona = nullptr, .outside = {}};
    if (!ldr) {
        const shared::EyeState& before = eye_ ? *eye_ : last_eye_;
        if (settings.glare == Glare::Scatter) given.scatter = &scatter_.at(settings.scatter, view);
        if (given.scatter && settings.scatter.has_corona()) given.corona = &corona_.at(settings.scatter, double(before.adaptation), double(before.seconds + seconds));
        given.outside = settings.lamps_elsewhere;
        for (const GlareSource& source : sources.dazzling)
            if (source.inside < 1) given.outside.push_back({source.direction, (1 - source.inside) * source.illuminance});
    }

    FrameGraph graph;
    const Declared declared = declare(graph, settings, view, frame, lights, sources, given, outputs);
    const double declared_after = watch.milliseconds();
    executor_.run(graph);
    eye_.reset();
    const double milliseconds = watch.milliseconds();
    plan_ = graph.describe(executor_.plan());

    Frame result;
    read_tone_chain(executor_, declared.chain, view.extent, result);
    last_eye_ = result.eye;
    if (given.corona) result.pupil = given.corona->pupil, result.pattern_milliseconds = given.corona->milliseconds;
    result.clusters = read_one<shared::ClusterReport>(executor_, declared.clusters);
    result.lights = uint32_t(lights.lights.size());
    result.sources = uint32_t(sources.sources.size());
    result.far = declared.far;
    if (!ldr) result.glare_sources = std::move(sources.dazzling);
    result.outside = std::move(given.outside);
    result.host_times.declare = declared_after;
    result.milliseconds = milliseconds;
    return result;
}

void Renderer::reset_adaptation() {
    executor_.reset(kEyeHistory);
    eye_.reset();
    last_eye_ = {};
}

}  // namespace vesper
