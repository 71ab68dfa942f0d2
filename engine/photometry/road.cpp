// The figures of road lighting. SPDX-License-Identifier: MIT
#include "photometry/road.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/error.h"

namespace vesper {
namespace {

/// Intensity of a new luminaire towards a point, cd.
double intensity_towards(const RoadLayout& road, const RoadLuminaire& lamp, glm::dvec3 point) {
    return road.flux_factor * intensity(road.distribution, glm::transpose(lamp.axes) * (point - lamp.position));
}

/// Mean illuminance on a strip that runs along the field from y = low to high.
double strip_illuminance(const RoadLayout& road, std::span<const RoadLuminaire> lamps, const RoadField& field,
                         double low, double high) {
    double sum = 0;
    for (const double x : field.x)
        for (int j = 0; j < 3; ++j) sum += horizontal_illuminance(road, lamps, {x, low + (j + 0.5) * (high - low) / 3});
    return sum / (3.0 * static_cast<double>(field.x.size()));
}

void find_worst_glare(const RoadLayout& road, std::span<const RoadLuminaire> lamps, const RoadField& field,
                      RoadObserver& observer) {
    const double first =
        -2.75 * (road_height(road) - observer.eye.z);  // the luminaire at x = 0 comes out from behind the roof
    observer.veil = -1;
    for (size_t i = 0; i < field.x.size(); ++i) {
        const glm::dvec3 eye(first + static_cast<double>(i) * field.step, observer.eye.y, observer.eye.z);
        const double veil = veiling_luminance(road, lamps, eye);
        if (veil <= observer.veil) continue;
        observer.veil = veil;
        observer.glare_eye = eye;
    }
    observer.threshold_increment =
        threshold_increment(observer.veil, observer.average_luminance / road.maintenance_factor);
}

/// Averages and uniformities of what one observer sees; his lane's middle is the middle one of its three rows.
void summarise(const RoadLayout& road, const RoadResult& result, size_t index, RoadObserver& observer) {
    double sum = 0, least = HUGE_VAL, lane_least = HUGE_VAL, lane_greatest = 0;
    for (const FieldPoint& point : result.points) {
        const double value = point.luminance[index];
        sum += value;
        least = std::min(least, value);
        if (std::abs(point.y - observer.eye.y) > road.width / road.lanes / 6) continue;
        lane_least = std::min(lane_least, value);
        lane_greatest = std::max(lane_greatest, value);
    }
    observer.average_luminance = sum / static_cast<double>(result.points.size());
    if (!(lane_greatest > 0)) throw Error(road.name + ": no light of these luminaires is seen on the road");
    observer.overall_uniformity = least / observer.average_luminance;
    observer.lengthwise_uniformity = lane_least / lane_greatest;
}

void summarise_illuminance(const RoadLayout& road, std::span<const RoadLuminaire> lamps, RoadResult& result) {
    double sum = 0;
    result.minimum_illuminance = HUGE_VAL;
    for (const FieldPoint& point : result.points) {
        sum += point.illuminance;
        result.minimum_illuminance = std::min(result.minimum_illuminance, point.illuminance);
    }
    result.average_illuminance = sum / static_cast<double>(result.points.size());
    const double w = road.width, lane = w / road.lanes;
    const auto ratio = [&](double outside, double inside) {
        const double within = strip_illuminance(road, lamps, result.field, inside, inside + lane);
        return within > 0 ? strip_illuminance(road, lamps, result.field, outside, outside + lane) / within : 0;
    };
    result.edge_ratio_right = ratio(-lane, 0);
    result.edge_ratio_left = ratio(w, w - lane);
    result.edge_ratio = std::min(result.edge_ratio_right, result.edge_ratio_left);
}

}  // namespace

double horizontal_illuminance(const RoadLayout& road, std::span<const RoadLuminaire> lamps, glm::dvec2 point) {
    double sum = 0;
    for (const RoadLuminaire& lamp : lamps) {
        const glm::dvec3 away = lamp.position - glm::dvec3(point, 0);
        if (std::hypot(away.x, away.y) > 5 * away.z) continue;
        const double distance = glm::length(away);
        sum += intensity_towards(road, lamp, {point, 0}) * away.z / (distance * distance * distance);
    }
    return sum * road.maintenance_factor;
}

double reflected_towards(const RoadLayout& road, const RoadLuminaire& lamp, glm::dvec2 point, glm::dvec2 observer) {
    const glm::dvec3 away = lamp.position - glm::dvec3(point, 0);
    const double h = away.z;
    if (away.x < -5 * h || away.x > 12 * h || std::abs(away.y) > 5 * h) return 0;
    const double sight = std::atan2(point.y - observer.y, point.x - observer.x);
    const double beta = (std::atan2(away.y, away.x) - sight) * kDegreesPerRadian;
    return reduced_luminance_coefficient(road.surface, std::hypot(away.x, away.y) / h, beta);
}

double road_luminance(const RoadLayout& road, std::span<const RoadLuminaire> lamps, glm::dvec2 point,
                      glm::dvec2 observer) {
    double sum = 0;
    for (const RoadLuminaire& lamp : lamps) {
        const double h = lamp.position.z, r = reflected_towards(road, lamp, point, observer);
        if (r > 0) sum += r * intensity_towards(road, lamp, {point, 0}) / (h * h);
    }
    return sum * road.maintenance_factor;
}

double road_glare(double theta, double age) {
    if (theta > 60 || theta < 0.1) return 0;
    const double inverse = 1 / theta;
    if (theta > 1.5) return 9.86 * (1 + std::pow(age / 66.4, 4)) * inverse * inverse;
    return (10 * inverse + 5 * (1 + std::pow(age / 62.5, 4))) * inverse * inverse;
}

double veiling_luminance(const RoadLayout& road, std::span<const RoadLuminaire> lamps, glm::dvec3 eye) {
    static const double kRoof = std::tan(20 / kDegreesPerRadian);
    static const glm::dvec3 kSight(std::cos(1 / kDegreesPerRadian), 0, -std::sin(1 / kDegreesPerRadian));
    double sum = 0;
    for (const RoadLuminaire& lamp : lamps) {
        const glm::dvec3 away = lamp.position - eye;
        const double distance = glm::length(away);
        if (away.x <= 0 || away.x > kGlareRange || away.z > kRoof * away.x) continue;
        const double cosine = std::min(glm::dot(away, kSight) / distance, 1.0);
        const double glare = road_glare(std::acos(cosine) * kDegreesPerRadian, road.age);
        if (glare > 0) sum += intensity_towards(road, lamp, eye) * cosine / (distance * distance) * glare;
    }
    return sum;
}

double threshold_increment(double veil, double average_luminance) {
    return average_luminance > 5 ? 95 * veil / std::pow(average_luminance, 1.05)
                                 : 65 * veil / std::pow(average_luminance, 0.8);
}

RoadResult calculate_road(const RoadLayout& road) {
    check_road(road);
    RoadResult result;
    result.wet = road.surface.wet;
    result.field = road_field(road);
    result.observers = road_observers(road);
    const double height = road_height(road);
    const auto lamps = road_luminaires(road, -5 * height, road.spacing + std::max(12 * height, kGlareRange));

    for (const double y : result.field.y)
        for (const double x : result.field.x) {
            FieldPoint point{x, y, horizontal_illuminance(road, lamps, {x, y}), {}};
            for (const RoadObserver& o : result.observers)
                point.luminance.push_back(road_luminance(road, lamps, {x, y}, {o.eye.x, o.eye.y}));
            result.points.push_back(std::move(point));
        }
    summarise_illuminance(road, lamps, result);

    result.average_luminance = result.overall_uniformity = result.lengthwise_uniformity = HUGE_VAL;
    for (size_t i = 0; i < result.observers.size(); ++i) {
        RoadObserver& o = result.observers[i];
        summarise(road, result, i, o);
        find_worst_glare(road, lamps, result.field, o);
        result.average_luminance = std::min(result.average_luminance, o.average_luminance);
        result.overall_uniformity = std::min(result.overall_uniformity, o.overall_uniformity);
        result.lengthwise_uniformity = std::min(result.lengthwise_uniformity, o.lengthwise_uniformity);
        result.threshold_increment = std::max(result.threshold_increment, o.threshold_increment);
    }
    return result;
}

std::span<const LightingClass> lighting_classes() {
    static constexpr LightingClass kClasses[] = {
        {"M1", 2.00, 0.40, 0.70, 10, 0.35}, {"M2", 1.50, 0.40, 0.70, 10, 0.35}, {"M3", 1.00, 0.40, 0.60, 15, 0.30},
        {"M4", 0.75, 0.40, 0.60, 15, 0.30}, {"M5", 0.50, 0.35, 0.40, 15, 0.30}, {"M6", 0.30, 0.35, 0.40, 20, 0.30}};
    return kClasses;
}

const LightingClass* find_lighting_class(const std::string& name) {
    for (const LightingClass& c : lighting_classes())
        if (name == c.name) return &c;
    return nullptr;
}

bool fulfils(const RoadResult& result, const LightingClass& wanted) {
    if (result.wet) return result.overall_uniformity >= wanted.overall_wet;
    return result.average_luminance >= wanted.luminance && result.overall_uniformity >= wanted.overall &&
           result.lengthwise_uniformity >= wanted.lengthwise && result.threshold_increment <= wanted.increment &&
           result.edge_ratio >= wanted.edge;
}

const LightingClass* reached_class(const RoadResult& result) {
    if (result.wet) return nullptr;
    for (const LightingClass& c : lighting_classes())
        if (fulfils(result, c)) return &c;
    return nullptr;
}

}  // namespace vesper
