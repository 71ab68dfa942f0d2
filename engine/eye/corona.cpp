#include "eye/corona.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "shared/corona.h"
#include "shared/tone.h"

namespace vesper::eye {

static_assert(vision::GlarePattern::kColumns == int(shared::kPatternColumns) &&
              vision::GlarePattern::kRows == int(shared::kPatternRows) &&
              vision::GlarePattern::kReach == int(shared::kPatternReach));

std::vector<glm::vec4> corona_texels(const vision::GlarePattern& pattern) {
    constexpr size_t kColumns = shared::kPatternColumns, kStride = shared::kPatternStride;
    constexpr int kRows = int(shared::kPatternRows);
    std::vector<glm::vec4> texels(size_t(kRows) * kStride);
    for (int row = 0; row < kRows; ++row) {
        const auto angle = float(vision::GlarePattern::angle(row + 0.5)), square = angle * angle;
        const glm::vec3 ring = square * pattern.ring[size_t(row)], needles = square * pattern.needles[size_t(row)];
        glm::vec4* at = &texels[size_t(row) * kStride];
        for (size_t i = 0; i < kColumns; ++i)
            at[i] = glm::vec4(ring + needles * pattern.modulation[size_t(row) * kColumns + i], 0);
    }
    // Along the radius as wide as around, up to 64 rows: a box of twice the width is that of the level below, taken at
    // either side.
    size_t from = 0, to = kColumns;
    for (uint32_t level = 1; level < shared::kPatternLevels; ++level) {
        const int side = level == 1 ? 1 : 1 << std::min(level - 2, 5u);
        const float own = level == 1 ? 0.5f : 0.0f, other = 0.5f * (1 - own);
        const size_t columns = kColumns >> level;
        for (int row = 0; row < kRows; ++row) {
            const glm::vec4* here = &texels[size_t(row) * kStride + from];
            // At its edges the pattern is folded back, so that all of its light stays in it.
            const glm::vec4* inner = &texels[size_t(row < side ? side - row - 1 : row - side) * kStride + from];
            const glm::vec4* outer =
                &texels[size_t(row + side < kRows ? row + side : 2 * kRows - 1 - row - side) * kStride + from];
            const auto both = [](const glm::vec4* at, size_t i) { return 0.5f * (at[2 * i] + at[2 * i + 1]); };
            glm::vec4* made = &texels[size_t(row) * kStride + to];
            for (size_t i = 0; i < columns; ++i)
                made[i] = own * both(here, i) + other * (both(inner, i) + both(outer, i));
        }
        from = to, to += columns;
    }
    return texels;
}

const Corona& CoronaCache::at(const ScatterSettings& settings, double pupil, double seconds) {
    const bool moves = settings.model == ScatterSettings::Model::Temporal;
    const double rest = pupil > 0 ? pupil : double(shared::kFirstPupil);
    const Moment moment{settings, moves ? vision::restless_pupil(rest, seconds, settings.aperture.seed) : 0,
                        moves ? seconds : 0};
    corona_.milliseconds = 0;
    if (moment_ == moment) return corona_;
    const Stopwatch watch;
    const vision::EyeScatter smooth = eye_scatter(settings);
    if (moves) {
        if (!aperture_ || !(moment_->settings.aperture == settings.aperture)) aperture_.emplace(settings.aperture);
        corona_.texels = corona_texels(vision::temporal_pattern(smooth, *aperture_, moment.pupil, seconds));
    } else {
        corona_.texels = corona_texels(vision::spencer_pattern(smooth, settings.state, settings.aperture.seed));
    }
    corona_.pupil = moment.pupil;
    corona_.milliseconds = watch.milliseconds();
    moment_ = moment;
    return corona_;
}

}  // namespace vesper::eye
