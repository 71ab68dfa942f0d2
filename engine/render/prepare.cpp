#include "render/prepare.h"

#include <optional>
#include <string>

#include "base/error.h"
#include "render/passes/edges.h"

namespace vesper::render {
namespace {

void prepare_shadows(Prepared& frame, ResidentScene& scene, const gpu::Device& device, Cache* map_cache,
                     const RenderSettings& settings, const gpu_scene::View& view, const gpu_scene::SceneFrame& poses) {
    const SceneData& data = scene.data;
    if (!scene.maps) {
        scene.maps = std::make_unique<ShadowMaps>(device, data.resident, data.lamps, data.maps, map_sizes(settings));
        scene.maps->use(map_cache);
    }
    const float unshadowed = settings.samples > 1 ? 0 : settings.unshadowed_share;
    scene.maps->plan(frame.lamps, poses, view, settings.caster_error, unshadowed);
    frame.shadows = true, frame.maps = scene.maps->report();
    if (frame.lamps.counts.directional == 0) return;
    if (!scene.directional)
        scene.directional = std::make_unique<Clipmaps>(device, data.resident, data.lamps, data.directional);
    frame.directional_levels = scene.directional->plan(frame.lamps, poses, view);
}

// In place of the light that is the same everywhere.
void prepare_indirect(Prepared& frame, ResidentScene& scene, const RenderSettings& settings,
                      const gpu_scene::View& view, const gpu_scene::SceneFrame& poses,
                      const gpu_scene::AmbientLight& ambient) {
    if (!scene.illuminance.empty()) {
        if (scene.illuminance.size() != uint64_t(view.extent.width) * view.extent.height)
            throw Error("illuminance of " + std::to_string(scene.illuminance.size()) + " pixels for a frame of " +
                        std::to_string(view.extent.width) + " x " + std::to_string(view.extent.height) + " px");
        frame.indirect = Prepared::Indirect::Pixels;
    } else if (scene.indirect) {
        frame.radiosity = {.factors = poses.dimming,
                           .sky = glm::dvec3(ambient.sky),
                           .sky_picture = scene.data.sky_on ? &*scene.data.sky_on : nullptr,
                           .reflections = settings.reflections,
                           .reflection_error = settings.reflection_error};
        if (!scene.indirect->solve(frame.radiosity, poses.moving)) return;  // nothing stands still
        frame.indirect = Prepared::Indirect::Cells;
        if (settings.moving_reflections && scene.lamp_reflections)
            frame.patches = scene.lamp_reflections->patches(poses.world, poses.dimming, gpu_scene::eye_of(view));
    } else {
        return;
    }
    frame.shading.ambient = glm::vec3(0);
    frame.daylight.tunnels.clear();
    frame.sky_lambert = 0;
}

}  // namespace

Prepared prepare(ResidentScene& scene, const gpu::Device& device, Cache* map_cache, const RenderSettings& settings,
                 const gpu_scene::View& view, const gpu_scene::SceneFrame& poses) {
    const SceneData& data = scene.data;
    Prepared frame;
    frame.lamps = gpu_scene::lamp_list(data.lamps, data.tables, poses, view);
    if (settings.unit_lamps) gpu_scene::set_to_one(frame.lamps, settings.ldr_reference_distance);
    const std::optional<float> white = settings.unit_lamps ? std::optional(1.0f) : std::nullopt;
    frame.luminaires = gpu_scene::luminaire_list(data.luminaires, poses, view, white);
    frame.clusters.threshold = settings.threshold;
    if (settings.anti_aliasing && settings.samples == 1) frame.edge_points = settings.edge_points;
    if (frame.edge_points > 0 && !settings.unit_lamps && has_facets(device, data.resident))
        frame.small_emitters = gpu_scene::small_emitter_list(data.emitting, data.resident, poses, view);
    frame.clusters.far = data.resident.farthest_depth(poses, view);
    if (settings.shadows) prepare_shadows(frame, scene, device, map_cache, settings, view, poses);
    frame.shading.all_lamps = settings.all_lamps;
    frame.shading.merge_error = settings.all_lamps ? 0 : settings.merge_error;
    frame.shading.shadow_error = settings.shadow_error;
    frame.shading.probe_error = settings.probe_error;
    if (settings.paper_lambert) frame.shading.lambert = 1;
    if (settings.unit_lamps) frame.shading.emission_limit = 1;
    if (settings.lamps_alone) {
        frame.luminaires.glare_sources.clear();
        return frame;
    }
    const gpu_scene::AmbientLight ambient = poses.ambient.value_or(data.ambient);
    if (poses.tunnels.empty()) frame.shading.ambient = ambient.illuminance;
    frame.shading.sky = ambient.sky;
    frame.outside = true;
    frame.daylight = {poses.tunnels, ambient.illuminance, frame.shading.lambert};
    frame.sky_lambert = frame.shading.lambert;
    if (settings.indirect) prepare_indirect(frame, scene, settings, view, poses, ambient);
    return frame;
}

}  // namespace vesper::render
