#include "gathered_light.h"

#include "arguments/cache_arguments.h"
#include "progress.h"
#include "transport/kept_radiosity.h"

namespace vesper::apps {

std::shared_ptr<const transport::Radiosity> gathered(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                                     const std::vector<bool>& moving, Cache* cache) {
    constexpr unsigned kSteps = 200;
    std::optional<Progress> progress;  // none where it is kept
    unsigned steps = 0;
    std::string problem;
    auto radiosity = transport::kept_or_gathered(
        scene, world, moving, {}, cache,
        [&](double share) {
            if (!progress) progress.emplace("light between surfaces", kSteps);
            for (; steps < unsigned(share * kSteps); ++steps) progress->step();
            return true;
        },
        &problem);
    for (; progress && steps < kSteps; ++steps) progress->step();
    print_cache_note(problem);
    return std::make_shared<const transport::Radiosity>(std::move(*radiosity));
}

void give_indirect(render::Renderer& renderer, const render::RenderSettings& settings, const scene::Scene& scene,
                   std::span<const glm::dmat4> world, const std::vector<bool>& moving, Cache* cache) {
    if (settings.indirect) renderer.set_radiosity(gathered(scene, world, moving, cache));
    if (settings.moving_reflections)
        renderer.set_lamp_reflections(std::make_shared<const transport::LampReflections>(scene, world, moving));
}

}  // namespace vesper::apps
