#include "render/quality.h"

namespace vesper::render {
namespace {

constexpr QualityInfo kQualities[]{
    {"standard", Quality::Standard, .001f, 1e-3f, .005f, .002},
    {"draft", Quality::Draft, .01f, .01f, .02f, .05},
    {"exact", Quality::Exact, 1e-9f, kMergesNothing, 0, 0},
};

}  // namespace

std::span<const QualityInfo> qualities() { return kQualities; }

void set_quality(RenderSettings& settings, Quality quality) {
    const QualityInfo& set = kQualities[size_t(quality)];
    settings.clusters.threshold = set.threshold;
    settings.merge_error = set.merge_error, settings.shadow_error = set.shadow_error;
    settings.reflections_left_out = set.reflections_left_out;
    settings.shadow_budget = kNoShadowBudget;
}

}  // namespace vesper::render
