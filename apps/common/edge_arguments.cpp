#include "edge_arguments.h"

namespace vesper::apps {

void add_edge_options(Command command, EdgeArguments& a) {
    command
        .add_option("--anti-aliasing", a.anti_aliasing,
                    "on: pixels at edges show the mean luminance of the surfaces that fill them; off: of one of them")
        .check(one_of({"on", "off"}))
        .shows_default();
    command
        .add_option("--samples", a.samples,
                    "Points of each pixel whose luminance is averaged, before glare and the eye; 64 make a reference")
        .check(range(1u, render::kMostSamples))
        .shows_default();
}

void set_edges(const EdgeArguments& a, render::RenderSettings& settings) {
    settings.anti_aliasing = a.anti_aliasing == "on", settings.samples = a.samples;
}

}  // namespace vesper::apps
