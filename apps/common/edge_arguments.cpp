#include "edge_arguments.h"
#include "render/passes/samples.h"

namespace vesper::apps {

void add_edge_options(Command command, EdgeArguments& a) {
    command
        .add_option("--anti-aliasing", a.anti_aliasing,
                    "Of scenes. on: pixels at edges show the mean luminance of the surfaces that fill them; off: of "
                    "one of them")
        .check(one_of({"on", "off"}))
        .shows_default();
    command
        .add_option("--samples", a.samples,
                    "Of scenes: points of each pixel whose luminance is averaged, before one glare and one eye; 64 "
                    "make a reference")
        .check(range(1u, render::kMostSamples))
        .shows_default();
}

void set_edges(const EdgeArguments& a, render::RenderSettings& settings) {
    settings.anti_aliasing = a.anti_aliasing == "on", settings.samples = a.samples;
}

io::Header describe_edges(const render::RenderSettings& settings) {
    const bool one = settings.samples == 1;
    return {{"vesper:samples", std::to_string(settings.samples)},
            {"vesper:antiAliasing", one && settings.anti_aliasing ? "on" : "off"},
            {"vesper:meanOf", !one && settings.display_average ? "what the display shows" : "luminance"}};
}

}  // namespace vesper::apps
