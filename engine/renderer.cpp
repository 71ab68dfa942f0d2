#include "renderer.h"

#include <chrono>
#include <cstring>

#include "resident/sky.h"

namespace vesper {
namespace {

uint32_t tone_of(Operator tone_operator) {
    switch (tone_operator) {
        case Operator::Reinhard: return shared::kToneReinhard;
        case Operator::Linear: return shared::kToneLinear;
        case Operator::Ldr: return shared::kToneLdr;
        default: return shared::kToneCurve;
    }
}

// A readback of a resource; none, and no copy, unless it is wanted.
Resource bring_back(FrameGraph& graph, const std::string& name, Resource from, uint64_t bytes) {
    const Resource to = graph.readback(name + " on the host", bytes);
    graph.copy("read " + name, from, to);
    return to;
}

template <class T>
T read_one(const Executor& executor, Resource readback) {
    T value;
    std::memcpy(&value, executor.read(readback).data(), sizeof value);
    return value;
}

}  // namespace

Renderer::Renderer(Device& device, const Scene& scene)
    : kernels_(device),
      resident_(device, scene),
      lights_(placed_lights(scene)),
      sources_(placed_sources(scene)),
      maps_(light_maps(scene)),
      map_arena_(device),
      map_texels_(upload_texels(device, maps_.texels)),
      ambient_illuminance_(scene.ambient_illuminance),
      sky_luminance_(scene.sky_luminance),
      ambient_colour_(scene.ambient_colour),
      sky_colour_(scene.sky_colour),
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
                                     const LightList& lights, const SourceList& sources, float seconds, Outputs outputs) const {
    const bool ldr = settings.tone_operator == Operator::Ldr;
    const uint32_t tone = tone_of(settings.tone_operator);
    ClusterSettings clustering = settings.clusters;
    clustering.far = resident_.farthest_depth(frame, view.world_to_view);
    ShadeSettings shading{.all_lights = settings.all_lights};
    if (ldr || settings.paper_lambert) shading.lambert = 1;
    if (ldr)
        shading.emission_limit = 1;
    else
        shading.ambient = ambient_illuminance_ * ambient_colour_, shading.sky = sky_luminance_ * sky_colour_;

    const GBuffer surfaces = add_gbuffer(graph, resident_, frame, view);
    const MapTexels maps{map_texels_.in(graph, "maps"), maps_.roads.empty() ? 0 : maps_.roads.front(), !maps_.roads.empty()};
    const Clusters clusters = add_clusters(graph, kernels_, lights, maps, view, clustering);
    if (retro_ && !ldr) shading.retro = retro_.in(graph, "retroreflection");
    Resource scene = add_shading(graph, kernels_, surfaces, clusters, view, shading);
    if (sky_ && !ldr) {
        const Resource sky = sky_.in(graph, "sky map");
        scene = add_sky(graph, kernels_, surfaces, scene, sky, sky_sharp_side_, view, shading.lambert);
    }
    scene = add_sources(graph, kernels_, scene, surfaces.surface, sources, view);
    const Pyramid luminance = add_pyramid(graph, kernels_, scene, view.extent);
    const uint32_t level = settings.foveal_level.value_or(foveal_level(view, luminance));
    const Resource histogram = add_histogram(graph, kernels_, luminance, level, view.extent, settings.histogram);
    const Adaptation adaptation = add_adaptation(graph, kernels_, luminance, histogram, settings.histogram, settings.tone, settings.display, seconds);
    Resource glare;
    if (settings.glare == Glare::Ldr)
        glare = add_ldr_glare(graph, kernels_, scene, adaptation.curve, tone, view, settings.display, settings.ldr_glare);
    const Resource display = add_composite(graph, kernels_, {.scene = scene, .curve = adaptation.curve, .luminance_glare = {}, .ldr_glare = glare}, tone, view, settings.display, settings.ldr_glare.gain);

    const uint64_t pixels = uint64_t(view.extent.width) * view.extent.height;
    Declared declared{.display = {}, .scene = {},
                      .curve = bring_back(graph, "tone curve", adaptation.curve, sizeof(shared::ToneCurve)),
                      .histogram = bring_back(graph, "histogram", histogram, sizeof(shared::Histogram)),
                      .eye = bring_back(graph, "eye", adaptation.eye.current, sizeof(shared::EyeState)),
                      .clusters = bring_back(graph, "cluster report", clusters.report, sizeof(shared::ClusterReport)),
                      .foveal_level = level, .far = clusters.push.far};
    if (outputs.display) declared.display = bring_back(graph, "display", display, pixels * 4);
    if (outputs.scene) declared.scene = bring_back(graph, "scene", scene, pixels * 16);
    return declared;
}

Frame Renderer::render(const RenderSettings& settings, const View& view, const SceneFrame& frame, float seconds, Outputs outputs) {
    const auto start = std::chrono::steady_clock::now();
    const bool ldr = settings.tone_operator == Operator::Ldr;
    LightList lights = light_list(lights_, maps_, frame, view);
    if (ldr) set_to_one(lights, settings.ldr_reference_distance);
    const SourceList sources = source_list(sources_, frame, view, ldr ? std::optional(1.0f) : std::nullopt);

    FrameGraph graph;
    const Declared declared = declare(graph, settings, view, frame, lights, sources, seconds, outputs);
    executor_.run(graph);
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    plan_ = graph.describe(executor_.plan());

    Frame result;
    result.extent = view.extent;
    if (declared.display) {
        const auto codes = executor_.read_as<uint8_t>(declared.display);
        result.display.assign(codes.begin(), codes.end());
    }
    if (declared.scene) {
        const auto luminance = executor_.read_as<float>(declared.scene);
        result.scene.assign(luminance.begin(), luminance.end());
    }
    result.curve = read_one<shared::ToneCurve>(executor_, declared.curve);
    result.histogram = read_one<shared::Histogram>(executor_, declared.histogram);
    result.eye = read_one<shared::EyeState>(executor_, declared.eye);
    result.clusters = read_one<shared::ClusterReport>(executor_, declared.clusters);
    result.foveal_level = declared.foveal_level;
    result.lights = uint32_t(lights.lights.size());
    result.sources = uint32_t(sources.sources.size());
    result.far = declared.far;
    result.timings = executor_.timings();
    result.milliseconds = elapsed.count();
    return result;
}

void Renderer::reset_adaptation() { executor_.reset("eye"); }

}  // namespace vesper
