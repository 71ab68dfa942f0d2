#include "road_render.h"

#include <algorithm>
#include <cmath>

#include "arguments.h"
#include "base/error.h"
#include "renderer.h"
#include "resident/road_view.h"
#include "scene/road_scene.h"

namespace vesper {
namespace {

void summarise(const RoadLayout& road, const RoadResult& result, size_t index, RenderedObserver& seen) {
    const RoadObserver& observer = result.observers[index];
    double sum = 0, squares = 0, least = HUGE_VAL, lane_least = HUGE_VAL, lane_greatest = 0;
    for (size_t i = 0; i < result.points.size(); ++i) {
        const double value = seen.luminance[i];
        const double difference =
            difference_percent(value, result.points[i].luminance[index], observer.average_luminance);
        if (!std::isfinite(value)) throw Error(road.name + ": the picture has no luminance at a point of the grid");
        sum += value;
        squares += difference * difference;
        least = std::min(least, value);
        if (std::abs(difference) > std::abs(seen.largest_difference)) {
            seen.largest_difference = difference;
            seen.largest_at = i;
        }
        if (std::abs(result.points[i].y - observer.eye.y) > road.width / road.lanes / 6) continue;
        lane_least = std::min(lane_least, value);
        lane_greatest = std::max(lane_greatest, value);
    }
    const auto count = static_cast<double>(result.points.size());
    seen.average_luminance = sum / count;
    seen.mean_difference = std::sqrt(squares / count);
    seen.average_difference = difference_percent(seen.average_luminance, observer.average_luminance, observer.average_luminance);
    seen.overall_uniformity = sum > 0 ? least / seen.average_luminance : 0;
    seen.lengthwise_uniformity = lane_greatest > 0 ? lane_least / lane_greatest : 0;
}

}  // namespace

double difference_percent(double picture, double calculated, double average) {
    return 100 * (picture - calculated) / std::max(calculated, 1e-3 * average);
}

RenderedRoad render_road(const RoadLayout& road, const RoadResult& result, const std::string& select) {
    const Scene scene = road_scene(road);
    const SceneFrame frame{world_transforms(scene, 0)};
    Device device({.select = select});
    Renderer renderer(device, scene);
    const auto render = [&](const View& view) {
        return renderer.render({}, view, frame, 0, {.display = false, .scene = true}).scene;
    };
    RenderedRoad made{.device = device.name()};
    for (size_t i = 0; i < result.observers.size(); ++i) {
        const RoadObserver& observer = result.observers[i];
        RenderedObserver seen;
        seen.view = road_view(road, observer);
        seen.rgba = render(seen.view);
        for (const RoadPoint& point : result.points)
            seen.luminance.push_back(luminance_at(seen.rgba, seen.view.extent, project(seen.view, {point.x, point.y, 0})));
        seen.longest_pixel = depth_of_pixel(seen.view, observer, result.field.x.back());
        summarise(road, result, i, seen);
        made.observers.push_back(std::move(seen));
        if (observer.average_luminance < result.observers[made.darkest].average_luminance) made.darkest = i;
    }
    made.overview = road_overview(road, result.observers[made.darkest], 1000);
    made.overview_rgba = render(made.overview);
    return made;
}

std::string text_of(const RoadResult& result, const RenderedRoad& rendered) {
    const size_t columns = result.field.x.size();
    std::string text = "\nRendered on " + rendered.device + ": calculated, rendered, difference in %\n";
    for (size_t o = 0; o < result.observers.size(); ++o) {
        const RoadObserver& observer = result.observers[o];
        const RenderedObserver& seen = rendered.observers[o];
        text += format("\nLuminance for the observer of lane %d, cd/m2 (%u x %u px, at most %.1f cm of road in one)\n   y \\ x  ",
                       observer.lane, seen.view.extent.width, seen.view.extent.height, 100 * seen.longest_pixel);
        for (const double x : result.field.x) text += format(" %7.2f", x);
        for (size_t row = result.field.y.size(); row-- > 0;)
            for (int line = 0; line < 3; ++line) {
                text += line == 0 ? format("\n %7.3f  ", result.field.y[row]) : std::string("\n          ");
                for (size_t i = row * columns; i < (row + 1) * columns; ++i) {
                    const double calculated = result.points[i].luminance[o];
                    text += line == 2 ? format(" %+7.2f", difference_percent(seen.luminance[i], calculated, observer.average_luminance))
                                      : format(" %7.3f", line == 0 ? calculated : seen.luminance[i]);
                }
            }
        text += "\n";
    }
    text += "\n  lane    Lav cd/m2                      Uo              Ul           points: rms, largest difference\n";
    const RenderedObserver* worst = &rendered.observers.front();
    double average = 0;
    for (size_t o = 0; o < result.observers.size(); ++o) {
        const RoadObserver& a = result.observers[o];
        const RenderedObserver& b = rendered.observers[o];
        text += format("  %4d  %7.4f %7.4f %+6.2f %%  %6.3f %6.3f   %6.3f %6.3f   ", a.lane, a.average_luminance, b.average_luminance,
                       b.average_difference, a.overall_uniformity, b.overall_uniformity, a.lengthwise_uniformity, b.lengthwise_uniformity);
        text += format("%.2f %%, %+.2f %%\n", b.mean_difference, b.largest_difference);
        if (std::abs(b.largest_difference) > std::abs(worst->largest_difference)) worst = &b;
        if (std::abs(b.average_difference) > std::abs(average)) average = b.average_difference;
    }
    const RoadPoint& at = result.points[worst->largest_at];
    return text + format("Largest difference: %+.2f %% at x = %.2f m, y = %.2f m; of an average: %+.2f %%\n", worst->largest_difference, at.x,
                         at.y, average);
}

}  // namespace vesper
