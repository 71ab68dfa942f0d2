#include "roads/small_targets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angle.h"
#include "base/error.h"
#include "roads/road_lighting.h"
#include "vision/visibility.h"

namespace vesper::roads {
namespace {

double road_luminance(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, glm::dvec2 point,
                      glm::dvec3 eye) {
    return luminance_towards(layout, seen_from(layout, lamps, glm::dvec3(point, 0)), point, eye);
}

SmallTarget target_at(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, glm::dvec2 foot,
                      double reflectance) {
    const glm::dvec3 centre(foot, kTargetSide / 2), eye(foot.x - kTargetDistance, foot.y, kTargetEyeHeight);
    SmallTarget target{.x = foot.x, .y = foot.y};
    target.vertical_illuminance = facing_illuminance(layout, seen_from(layout, lamps, centre), centre);
    target.luminance = reflectance * target.vertical_illuminance / std::numbers::pi;
    target.background = (road_luminance(layout, lamps, foot, eye) +
                         road_luminance(layout, lamps, foot + glm::dvec2(kBeyondTarget, 0), eye)) /
                        2;
    target.veil = veiling_luminance(layout, seen_from(layout, lamps, eye), eye) * layout.maintenance_factor;
    const vision::Target seen{
        .size = 60 * kDegreesPerRadian * kTargetSide / kTargetDistance, .seconds = kTargetTime, .age = kTargetAge};
    // The veil lies over both: it leaves the difference as it is and raises the threshold.
    target.visibility_level =
        vision::bounded_visibility_level(target.luminance + target.veil, target.background + target.veil, seen);
    return target;
}

}  // namespace

void check_target_reflectance(double reflectance) {
    if (!(reflectance >= 0.01 && reflectance <= 1)) throw Error("the reflectance of targets must be from 0.01 to 1");
}

std::optional<double> small_target_average(std::span<const SmallTarget> targets) {
    std::vector<double> levels;
    for (const SmallTarget& target : targets)
        if (target.visibility_level) levels.push_back(std::abs(*target.visibility_level));
    if (levels.empty()) return std::nullopt;
    const double least = *std::min_element(levels.begin(), levels.end());
    double sum = 0;
    for (const double level : levels) sum += std::pow(10, -0.1 * (level - least));  // a weight alone could be 0
    return least - 10 * std::log10(sum / static_cast<double>(levels.size()));
}

SmallTargetVisibility small_target_visibility(const LoadedLayout& layout, double reflectance) {
    check_layout(layout);
    check_target_reflectance(reflectance);
    LoadedLayout dazzling = layout;
    dazzling.observer_age = kTargetVeilAge;
    const CalculationField field = calculation_field(layout);
    const double height = mounting_height(layout);
    const auto lamps = placed_luminaires(layout, -std::max(12 * height, kTargetDistance),
                                         layout.spacing + std::max(kBeyondTarget + 12 * height, kGlareRange));
    SmallTargetVisibility result{.reflectance = reflectance, .targets = {}};
    for (const double y : field.y)
        for (const double x : field.x) result.targets.push_back(target_at(dazzling, lamps, {x, y}, reflectance));
    result.stv = small_target_average(result.targets);
    return result;
}

}  // namespace vesper::roads
