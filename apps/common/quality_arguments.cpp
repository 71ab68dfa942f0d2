#include "quality_arguments.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include "print.h"

namespace vesper::apps {
namespace {

// The shortest decimal number that is this float: 0.001 and not 0.0010000000475.
double shortest(float value) {
    char text[32];
    double number = 0;
    std::from_chars(text, std::to_chars(text, text + sizeof text, value).ptr, number);
    return number;
}

}  // namespace

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

bool RecordedQuality::bounds_equal(const RecordedQuality& other) const {
    return float(threshold) == float(other.threshold) && float(merge_error) == float(other.merge_error) &&
           float(shadow_error) == float(other.shadow_error) &&
           float(reflections_left_out) == float(other.reflections_left_out);
}

RecordedQuality recorded_quality(const QualityArguments& a, const render::RenderSettings& settings) {
    return {a.quality, shortest(settings.clusters.threshold), shortest(std::max(settings.merge_error, 0.0f)),
            shortest(settings.shadow_error), settings.reflections_left_out};
}

RecordedQuality recorded_standard() { return recorded_quality({}, {}); }

std::vector<std::pair<std::string, std::string>> quality_texts(const RecordedQuality& q) {
    return {{"quality", q.name},
            {"threshold_lx", format("%.9g", q.threshold)},
            {"merge_error", format("%.9g", q.merge_error)},
            {"shadow_error", format("%.9g", q.shadow_error)},
            {"reflections_left_out", format("%.9g", q.reflections_left_out)}};
}

std::string quality_json(const RecordedQuality& q) {
    std::string members;
    for (const auto& [name, text] : quality_texts(q))
        members += (members.empty() ? "\"" : ", \"") + name + "\": " + (name == "quality" ? '"' + text + '"' : text);
    return members;
}

std::string quality_words(const RecordedQuality& q) {
    const auto texts = quality_texts(q);
    return texts[0].second + " (" + texts[1].second + " lx, merge error " + texts[2].second + ", shadow error " +
           texts[3].second + ", reflections " + texts[4].second + ")";
}

io::Header describe_quality(const RecordedQuality& q) {
    constexpr const char* kNames[]{"quality", "illuminanceThreshold", "mergeError", "shadowError",
                                   "reflectionsLeftOut"};
    io::Header header;
    for (const auto& [name, text] : quality_texts(q))
        header.emplace_back(std::string("vesper:") + kNames[header.size()], text);
    return header;
}

}  // namespace vesper::apps
