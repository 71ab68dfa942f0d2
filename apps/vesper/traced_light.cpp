#include "traced_light.h"

#include "render/seen_surfaces.h"

namespace vesper::commands {

TracedPicture traced_light(gpu::Device& device, const scene::Scene& scene, const gpu_scene::GpuScene& resident,
                           const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
                           const transport::TraceSettings& settings, const std::function<void(double)>& progress) {
    TracedPicture picture{render::seen_surfaces(device, resident, poses, view), {}};
    const transport::LightTracer tracer(scene, poses.world);
    picture.light = transport::light_of(tracer, picture.points, settings, [&](double share) {
        progress(share);
        return true;
    });
    return picture;
}

std::vector<glm::vec4> other_light(const TracedPicture& picture) {
    std::vector<glm::vec4> illuminance;
    illuminance.reserve(picture.light.size());
    for (const transport::PointLight& light : picture.light) illuminance.emplace_back(light.other(), 0);
    return illuminance;
}

}  // namespace vesper::commands
