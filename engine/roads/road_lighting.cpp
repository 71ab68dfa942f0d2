#include "roads/road_lighting.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/angle.h"
#include "base/error.h"
#include "roads/occluders.h"
#include "vision/glare.h"

namespace vesper::roads {
namespace {

/// Intensity of a new luminaire towards a point, cd.
double intensity_towards(const LoadedLayout& layout, const PlacedLuminaire& lamp, glm::dvec3 point) {
    return layout.flux_factor *
           photometry::intensity(layout.distribution, glm::transpose(lamp.axes) * (point - lamp.position));
}

/// The luminaires in the reach of all rules for a point of the road.
bool in_reach(const PlacedLuminaire& lamp, glm::dvec2 point) {
    const glm::dvec3 away = lamp.position - glm::dvec3(point, 0);
    return away.x >= -5 * away.z && away.x <= 12 * away.z && std::abs(away.y) <= 5 * away.z;
}

/// The luminaires in reach that a point of the road sees; all of them without occluders.
std::vector<PlacedLuminaire> seen_from(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps,
                                       glm::dvec2 point, RoadLighting* counted = nullptr) {
    if (!layout.hiding) return {lamps.begin(), lamps.end()};
    std::vector<PlacedLuminaire> reaching;
    std::ranges::copy_if(lamps, std::back_inserter(reaching),
                         [&](const PlacedLuminaire& lamp) { return in_reach(lamp, point); });
    std::vector<PlacedLuminaire> seen = seen_from(layout, reaching, glm::dvec3(point, 0));
    if (counted) counted->pairs += reaching.size(), counted->hidden_pairs += reaching.size() - seen.size();
    return seen;
}

/// Mean illuminance on a strip that runs along the field from y = low to high.
double strip_illuminance(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps,
                         const CalculationField& field, double low, double high) {
    double sum = 0;
    for (const double x : field.x)
        for (int j = 0; j < 3; ++j) {
            const glm::dvec2 point(x, low + (j + 0.5) * (high - low) / 3);
            sum += horizontal_illuminance(layout, seen_from(layout, lamps, point), point);
        }
    return sum / (3.0 * static_cast<double>(field.x.size()));
}

void find_worst_glare(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, const CalculationField& field,
                      LaneObserver& observer) {
    const double first =
        -2.75 * (mounting_height(layout) - observer.eye.z);  // the luminaire at x = 0 comes out from behind the roof
    observer.veil = -1;
    for (size_t i = 0; i < field.x.size(); ++i) {
        const glm::dvec3 eye(first + static_cast<double>(i) * field.step, observer.eye.y, observer.eye.z);
        const double veil = veiling_luminance(layout, seen_from(layout, lamps, eye), eye);
        if (veil <= observer.veil) continue;
        observer.veil = veil;
        observer.glare_eye = point_of(eye);
    }
    observer.threshold_increment_percent =
        vision::threshold_increment(observer.veil, observer.average_luminance / layout.maintenance_factor);
}

/// Averages and uniformities of what one observer sees; his lane's middle is the middle one of its three rows.
void summarise(const RoadLayout& layout, const RoadLighting& result, size_t index, LaneObserver& observer) {
    double sum = 0, least = HUGE_VAL, lane_least = HUGE_VAL, lane_greatest = 0;
    for (const FieldPoint& point : result.points) {
        const double value = point.luminance[index];
        sum += value;
        least = std::min(least, value);
        if (std::abs(point.y - observer.eye.y) > layout.width / layout.lanes / 6) continue;
        lane_least = std::min(lane_least, value);
        lane_greatest = std::max(lane_greatest, value);
    }
    observer.average_luminance = sum / static_cast<double>(result.points.size());
    if (!(lane_greatest > 0)) throw Error(layout.name + ": no light of these luminaires is seen on the road");
    observer.overall_uniformity = least / observer.average_luminance;
    observer.longitudinal_uniformity = lane_least / lane_greatest;
}

void summarise_illuminance(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, RoadLighting& result) {
    double sum = 0;
    result.minimum_illuminance = HUGE_VAL;
    for (const FieldPoint& point : result.points) {
        sum += point.illuminance;
        result.minimum_illuminance = std::min(result.minimum_illuminance, point.illuminance);
    }
    result.average_illuminance = sum / static_cast<double>(result.points.size());
    const double w = layout.width, lane = w / layout.lanes;
    const auto ratio = [&](double outside, double inside) {
        const double within = strip_illuminance(layout, lamps, result.field, inside, inside + lane);
        return within > 0 ? strip_illuminance(layout, lamps, result.field, outside, outside + lane) / within : 0;
    };
    result.edge_ratio_right = ratio(-lane, 0);
    result.edge_ratio_left = ratio(w, w - lane);
    result.edge_ratio = std::min(result.edge_ratio_right, result.edge_ratio_left);
}

}  // namespace

std::vector<PlacedLuminaire> seen_from(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps,
                                       glm::dvec3 place) {
    std::vector<PlacedLuminaire> seen;
    for (const PlacedLuminaire& lamp : lamps)
        if (!layout.hiding || !layout.hiding->hide(lamp.position, place)) seen.push_back(lamp);
    return seen;
}

double horizontal_illuminance(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, glm::dvec2 point) {
    double sum = 0;
    for (const PlacedLuminaire& lamp : lamps) {
        const glm::dvec3 away = lamp.position - glm::dvec3(point, 0);
        if (std::hypot(away.x, away.y) > 5 * away.z) continue;
        const double distance = glm::length(away);
        sum += intensity_towards(layout, lamp, {point, 0}) * away.z / (distance * distance * distance);
    }
    return sum * layout.maintenance_factor;
}

double facing_illuminance(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, glm::dvec3 point) {
    double sum = 0;
    for (const PlacedLuminaire& lamp : lamps) {
        const glm::dvec3 away = lamp.position - point;
        if (away.x >= 0 || away.x < -12 * away.z || std::abs(away.y) > 5 * away.z) continue;
        const double distance = glm::length(away);
        sum += intensity_towards(layout, lamp, point) * -away.x / (distance * distance * distance);
    }
    return sum * layout.maintenance_factor;
}

double reflected_towards(const LoadedLayout& layout, const PlacedLuminaire& lamp, glm::dvec2 point,
                         glm::dvec2 observer) {
    const glm::dvec3 away = lamp.position - glm::dvec3(point, 0);
    const double h = away.z;
    if (away.x < -5 * h || away.x > 12 * h || std::abs(away.y) > 5 * h) return 0;
    const double sight = std::atan2(point.y - observer.y, point.x - observer.x);
    const double beta = (std::atan2(away.y, away.x) - sight) * kDegreesPerRadian;
    return photometry::reduced_luminance_coefficient(layout.surface, std::hypot(away.x, away.y) / h, beta);
}

double luminance_towards(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, glm::dvec2 point,
                         glm::dvec2 observer) {
    double sum = 0;
    for (const PlacedLuminaire& lamp : lamps) {
        const double h = lamp.position.z, r = reflected_towards(layout, lamp, point, observer);
        if (r > 0) sum += r * intensity_towards(layout, lamp, {point, 0}) / (h * h);
    }
    return sum * layout.maintenance_factor;
}

double veiling_luminance(const LoadedLayout& layout, std::span<const PlacedLuminaire> lamps, glm::dvec3 eye) {
    static const double kRoof = std::tan(20 / kDegreesPerRadian);
    static const glm::dvec3 kSight(std::cos(1 / kDegreesPerRadian), 0, -std::sin(1 / kDegreesPerRadian));
    double sum = 0;
    for (const PlacedLuminaire& lamp : lamps) {
        const glm::dvec3 away = lamp.position - eye;
        const double distance = glm::length(away);
        if (away.x <= 0 || away.x > kGlareRange || away.z > kRoof * away.x) continue;
        const double cosine = std::min(glm::dot(away, kSight) / distance, 1.0);
        const double glare = vision::en13201_glare(std::acos(cosine) * kDegreesPerRadian, layout.observer_age);
        if (glare > 0) sum += intensity_towards(layout, lamp, eye) * cosine / (distance * distance) * glare;
    }
    return sum;
}

RoadLighting calculate_lighting(const LoadedLayout& layout) {
    check_layout(layout);
    RoadLighting result;
    result.wet = layout.surface.wet;
    result.field = calculation_field(layout);
    result.observers = lane_observers(layout);
    const double height = mounting_height(layout);
    const auto lamps = placed_luminaires(layout, -5 * height, layout.spacing + std::max(12 * height, kGlareRange));

    for (const double y : result.field.y)
        for (const double x : result.field.x) {
            const std::vector<PlacedLuminaire> seen = seen_from(layout, lamps, glm::dvec2(x, y), &result);
            FieldPoint point{x, y, horizontal_illuminance(layout, seen, {x, y}), {}};
            for (const LaneObserver& o : result.observers)
                point.luminance.push_back(luminance_towards(layout, seen, {x, y}, {o.eye.x, o.eye.y}));
            result.points.push_back(std::move(point));
        }
    summarise_illuminance(layout, lamps, result);

    result.average_luminance = result.overall_uniformity = result.longitudinal_uniformity = HUGE_VAL;
    for (size_t i = 0; i < result.observers.size(); ++i) {
        LaneObserver& o = result.observers[i];
        summarise(layout, result, i, o);
        find_worst_glare(layout, lamps, result.field, o);
        result.average_luminance = std::min(result.average_luminance, o.average_luminance);
        result.overall_uniformity = std::min(result.overall_uniformity, o.overall_uniformity);
        result.longitudinal_uniformity = std::min(result.longitudinal_uniformity, o.longitudinal_uniformity);
        result.threshold_increment_percent =
            std::max(result.threshold_increment_percent, o.threshold_increment_percent);
    }
    return result;
}

}  // namespace vesper::roads
