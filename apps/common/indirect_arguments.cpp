#include "indirect_arguments.h"

#include "progress.h"
#include "shadow_arguments.h"
#include "transport/kept_radiosity.h"

namespace vesper::apps {

void add_indirect_options(Command command, IndirectArguments& a, bool exact) {
    const std::string help =
        "cached: emitting surfaces and the sky light what stands still, and so does reflected light; off: a constant "
        "stands for them";
    std::vector<std::string> words{"cached", "off"};
    if (exact) words.emplace_back("exact");
    command
        .add_option("--indirect", a.indirect,
                    help + (exact ? "; exact: they are traced for each pixel of each frame (slow)" : ""))
        .check(one_of(words))
        .shows_default();
    command
        .add_option("--reflections", a.reflections,
                    "Reflections of light, at most; they end where the rest would add little (--quality)")
        .check(range(0u, 100u))
        .shows_default();
    command
        .add_option("--moving-reflections", a.moving,
                    "on: road and walls reflect light of lamps that move, such as headlamps, once: an estimate")
        .check(one_of({"on", "off"}))
        .shows_default();
}

void set_indirect(const IndirectArguments& a, render::RenderSettings& settings) {
    settings.indirect = a.indirect != "off", settings.reflections = a.reflections;
    settings.moving_reflections = a.moving == "on";
    if (settings.moving_reflections && !settings.indirect)
        throw Error("--moving-reflections has no meaning with --indirect off");
}

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
