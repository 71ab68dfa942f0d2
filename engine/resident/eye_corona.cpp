#include "resident/eye_corona.h"

#include <cmath>

#include "base/stopwatch.h"
#include "perception/thresholds.h"
#include "shared/corona.h"

namespace vesper {

static_assert(GlarePattern::kColumns == int(shared::kPatternColumns) && GlarePattern::kRows == int(shared::kPatternRows) &&
              GlarePattern::kReach == int(shared::kPatternReach));

std::vector<glm::vec4> corona_texels(const GlarePattern& pattern) {
    constexpr size_t kColumns = shared::kPatternColumns, kStride = shared::kPatternStride;
    std::vector<glm::vec4> texels(shared::kPatternRows * kStride);
    for (size_t row = 0; row < shared::kPatternRows; ++row) {
        const auto angle = float(GlarePattern::angle(double(row) + 0.5)), square = angle * angle;
        const glm::vec3 ring = square * pattern.ring[row], needles = square * pattern.needles[row];
        glm::vec4* at = &texels[row * kStride];
        for (size_t i = 0; i < kColumns; ++i) at[i] = glm::vec4(ring + needles * pattern.modulation[row * kColumns + i], 0);
        for (size_t i = kColumns; i < kStride; ++i) at[i] = 0.5f * (at[2 * (i - kColumns)] + at[2 * (i - kColumns) + 1]);
    }
    return texels;
}

const Corona& CoronaCache::at(const ScatterSettings& settings, double adaptation, double seconds) {
    const bool moves = settings.model == ScatterSettings::Model::Temporal;
    const double first = pupil_moon_spencer(kFirstAdaptation), goal = adaptation > 0 ? pupil_moon_spencer(adaptation) : first;
    const double diameter = goal + (first - goal) * std::exp(-seconds / kPupilSeconds);
    const Moment moment{settings, moves ? restless_pupil(diameter, seconds, settings.aperture.seed) : 0, moves ? seconds : 0};
    corona_.milliseconds = 0;
    if (moment_ == moment) return corona_;
    const Stopwatch watch;
    const EyeScatter smooth = eye_scatter(settings);
    if (moves) {
        if (!aperture_ || !(moment_->settings.aperture == settings.aperture)) aperture_.emplace(settings.aperture);
        corona_.texels = corona_texels(temporal_pattern(smooth, *aperture_, moment.pupil, seconds));
    } else {
        corona_.texels = corona_texels(spencer_pattern(smooth, settings.state, settings.aperture.seed));
    }
    corona_.pupil = moment.pupil;
    corona_.milliseconds = watch.milliseconds();
    moment_ = moment;
    return corona_;
}

}  // namespace vesper
