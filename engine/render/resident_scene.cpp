#include "render/resident_scene.h"

#include "gpu_scene/retro.h"
#include "gpu_scene/sky.h"
#include "scene/scene.h"

namespace vesper::render {

graph::Resource SceneTexels::declare(graph::FrameGraph& graph, const char* name) const {
    if (bytes == 0) return {};
    return graph.external(name, buffer, bytes, VK_FORMAT_R32G32B32A32_SFLOAT);
}

SceneData::SceneData(const gpu::Device& device, const scene::Scene& scene, Cache* cache)
    : resident(device, scene, gpu_scene::PictureFormat::Float, cache),
      lamps(gpu_scene::placed_lamps(scene)),
      maps(shadow_map_plan(scene, resident, lamps)),
      directional(clipmap_plan(lamps)),
      luminaires(gpu_scene::placed_luminaires(scene)),
      emitting(gpu_scene::emitting_parts(scene)),
      tables(gpu_scene::intensity_tables(scene)),
      texel_arena(device),
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

SceneTexels SceneData::upload(const gpu::Device& device, const std::vector<glm::vec4>& texels) {
    const auto bytes = std::as_bytes(std::span(texels));
    return {gpu::upload_buffer(device, texel_arena, bytes, gpu::kTexelUsage), bytes.size()};
}

void ResidentScene::forget() {
    if (maps) maps->forget();
    if (directional) directional->forget();
    if (indirect) indirect->forget();
}

uint64_t ResidentScene::device_bytes() const {
    return data.resident.bytes() + data.texel_arena.bytes() + (maps ? maps->bytes() : 0) +
           (directional ? directional->bytes() : 0) + (indirect ? indirect->device_bytes() : 0);
}

}  // namespace vesper::render
