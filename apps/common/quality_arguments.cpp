#include "quality_arguments.h"

#include <algorithm>
#include <vector>

#include "print.h"

namespace vesper::apps {

void add_quality_option(Command command, QualityArguments& a) {
    std::vector<std::string> names;
    for (const render::QualityInfo& set : render::qualities()) names.emplace_back(set.name);
    command.add_option("--quality", a.quality, "Of scenes: draft leaves out more, exact nothing (docs/quality.md)")
        .check(one_of(names))
        .shows_default();
}

void add_bound_options(Command command, QualityArguments& a) {
    const auto standard = [](float value) { return format("%g, or as --quality says", double(value)); };
    const render::RenderSettings defaults;
    command
        .add_option("--threshold", a.threshold,
                    "Illuminance below which a lamp counts as dark: on matt surfaces, or on a plane facing it, lx")
        .check(between(1e-9, 1e3))
        .shows_default(standard(defaults.clusters.threshold));
    command
        .add_option("--merge-error", a.merge_error,
                    "Relative error of a lamp whose light is taken as smooth over 8x8 pixels; 0: of none")
        .check(between(0, 1))
        .shows_default(standard(defaults.merge_error));
    command
        .add_option("--shadow-error", a.shadow_error,
                    "Share of the light of 8x8 pixels: lamps of less are not looked at by each of them")
        .check(between(0, 1))
        .shows_default(standard(defaults.shadow_error));
}

void set_quality(const QualityArguments& a, render::RenderSettings& settings) {
    const auto sets = render::qualities();
    const auto named = std::ranges::find(sets, a.quality, &render::QualityInfo::name);
    render::set_quality(settings, named->quality);
    settings.clusters.threshold = a.threshold.value_or(settings.clusters.threshold);
    if (a.merge_error) settings.merge_error = *a.merge_error > 0 ? *a.merge_error : render::kMergesNothing;
    settings.shadow_error = a.shadow_error.value_or(settings.shadow_error);
}

io::Header describe_quality(const QualityArguments& a) { return {{"vesper:quality", a.quality}}; }

}  // namespace vesper::apps
