#include "road_render.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/luminance.h"
#include "print.h"
#include "render/renderer.h"
#include "road_view.h"
#include "roads/layout_scene.h"

namespace vesper::commands {
namespace {

using apps::format;

/// Difference of a point, %: relative to the calculated luminance, but at least to a thousandth of the average.
double difference_percent(double picture, double calculated, double average) {
    return 100 * (picture - calculated) / std::max(calculated, 1e-3 * average);
}

void summarise(const roads::LoadedLayout& layout, const roads::RoadLighting& result, size_t index,
               RoadReading& reading) {
    const roads::LaneObserver& observer = result.observers[index];
    double sum = 0, squares = 0, least = HUGE_VAL, lane_least = HUGE_VAL, lane_greatest = 0;
    for (size_t i = 0; i < result.points.size(); ++i) {
        const double value = reading.luminance[i];
        if (!std::isfinite(value)) throw Error(layout.name + ": the picture has no luminance at a point of the grid");
        const double difference =
            difference_percent(value, result.points[i].luminance[index], observer.average_luminance);
        sum += value;
        squares += difference * difference;
        least = std::min(least, value);
        if (std::abs(difference) > std::abs(reading.largest_difference)) {
            reading.largest_difference = difference;
            reading.largest_at = i;
        }
        if (std::abs(result.points[i].y - observer.eye.y) > layout.width / layout.lanes / 6) continue;
        lane_least = std::min(lane_least, value);
        lane_greatest = std::max(lane_greatest, value);
    }
    const auto count = static_cast<double>(result.points.size());
    reading.average_luminance = sum / count;
    reading.mean_difference = std::sqrt(squares / count);
    reading.average_difference =
        difference_percent(reading.average_luminance, observer.average_luminance, observer.average_luminance);
    reading.overall_uniformity = sum > 0 ? least / reading.average_luminance : 0;
    reading.longitudinal_uniformity = lane_greatest > 0 ? lane_least / lane_greatest : 0;
}

/// Points of the grid of one observer.
struct Wanted {
    size_t observer, point;
};
/// By the luminaires of the scene that light them in the calculation.
using Groups = std::map<std::vector<bool>, std::vector<Wanted>>;

Groups groups_of(const roads::LoadedLayout& layout, const std::vector<roads::PlacedLuminaire>& lamps,
                 const roads::RoadLighting& result) {
    Groups groups;
    for (size_t o = 0; o < result.observers.size(); ++o)
        for (size_t i = 0; i < result.points.size(); ++i) {
            const glm::dvec2 point(result.points[i].x, result.points[i].y);
            std::vector<bool> counted;
            for (const roads::PlacedLuminaire& lamp : lamps)
                counted.push_back(
                    roads::reflected_towards(layout, lamp, point, roads::vector_of(result.observers[o].eye)) > 0);
            groups[counted].push_back({o, i});
        }
    return groups;
}

/// The scene with only some of its luminaires, and tables as the calculation takes them.
scene::Scene with_luminaires(scene::Scene scene, const std::vector<bool>& wanted) {
    scene.beyond_tables = false;
    size_t lamp = 0;
    for (scene::Node& node : scene.nodes)
        if (node.lamp != scene::kNone && !wanted.at(lamp++)) node.lamp = scene::kNone;
    return scene;
}

/// Every lamp counts, as in the calculation, however dim: contributions of 1e-9 lx are left out.
render::RenderSettings road_settings() {
    render::RenderSettings settings;
    settings.threshold = 1e-9f;
    return settings;
}

class RoadPictures {
public:
    RoadPictures(gpu::Device& device, const scene::Scene& scene)
        : frame_{scene::world_transforms(scene, 0)}, renderer_(device, scene) {}
    std::vector<float> render(const gpu_scene::View& view) {
        return renderer_.render(road_settings(), view, frame_, 0, {.display = false, .scene = true}).scene;
    }

private:
    gpu_scene::SceneFrame frame_;
    render::Renderer renderer_;
};

/// Veil and TI off a picture of what dazzles; lamps above the roof of the car do not.
vision::GlareReport read_glare(const roads::LoadedLayout& layout, const roads::LaneObserver& observer,
                               gpu::Device& device) {
    const scene::Scene scene = roads::layout_glare_scene(layout, observer.glare_eye.x);
    render::Renderer renderer(device, scene);
    const gpu_scene::View view = road_glare_view(roads::vector_of(observer.glare_eye));
    const render::Frame frame = renderer.render(road_settings(), view, {scene::world_transforms(scene, 0)}, 0,
                                                {.display = false, .scene = true});
    std::vector<vision::DazzlingLight> beside;
    for (const eye::OffscreenLamp& lamp : frame.outside)
        if (lamp.direction.y < double(view.tangent_high.y) * -lamp.direction.z)
            beside.push_back({lamp.direction, luminance(lamp.illuminance)});
    const vision::ImageAngles image = gpu_scene::angles_of(view);
    const double average = observer.average_luminance / layout.maintenance_factor;
    const glm::dvec2 sight = image.pixels_at({0, 0}) / glm::dvec2(image.width, image.height);
    return vision::report_glare(
        image, frame.scene, beside,
        {.eye = {layout.observer_age}, .gaze = sight, .source_luminance = 0, .average_luminance = average});
}

double read_point(const std::vector<float>& rgba, const gpu_scene::View& view, const roads::FieldPoint& point) {
    return luminance_at(rgba, view.extent, project(view, {point.x, point.y, 0}));
}

std::string summary_line(const roads::LaneObserver& a, const RoadReading& b) {
    std::string text =
        format("  %4d  %7.4f %7.4f %+6.2f %%", a.lane, a.average_luminance, b.average_luminance, b.average_difference);
    text += format("   %6.3f %6.3f   %6.3f %6.3f", a.overall_uniformity, b.overall_uniformity,
                   a.longitudinal_uniformity, b.longitudinal_uniformity);
    return text + format("   %5.2f %%  %+6.2f %%\n", b.mean_difference, b.largest_difference);
}

/// What differs most of all observers.
std::string worst_line(const roads::RoadLighting& result, const RenderedRoad& rendered,
                       RoadReading RenderedObserver::*which) {
    const RoadReading* worst = &(rendered.observers.front().*which);
    double average = 0;
    for (const RenderedObserver& seen : rendered.observers) {
        const RoadReading& reading = seen.*which;
        if (std::abs(reading.largest_difference) > std::abs(worst->largest_difference)) worst = &reading;
        if (std::abs(reading.average_difference) > std::abs(average)) average = reading.average_difference;
    }
    const roads::FieldPoint& at = result.points[worst->largest_at];
    return format("%+.2f %% at x = %.2f m, y = %.2f m; of Lav: %+.2f %%\n", worst->largest_difference, at.x, at.y,
                  average);
}

}  // namespace

RenderedRoad render_road(const roads::LoadedLayout& layout, const roads::RoadLighting& result,
                         const std::string& select) {
    const scene::Scene scene = roads::layout_scene(layout);
    gpu::Device device({.select = select});
    RenderedRoad made{.device = device.name()};
    RoadPictures whole(device, scene);
    for (size_t i = 0; i < result.observers.size(); ++i) {
        RenderedObserver seen;
        seen.view = road_view(layout, result.observers[i]);
        seen.rgba = whole.render(seen.view);
        seen.longest_pixel = depth_of_pixel(seen.view, result.observers[i], result.field.x.back());
        for (const roads::FieldPoint& point : result.points)
            seen.every.luminance.push_back(read_point(seen.rgba, seen.view, point));
        seen.counted.luminance.resize(result.points.size());
        made.observers.push_back(std::move(seen));
        if (result.observers[i].average_luminance < result.observers[made.darkest].average_luminance) made.darkest = i;
    }
    for (size_t i = 0; i < made.observers.size(); ++i)
        made.observers[i].glare = read_glare(layout, result.observers[i], device);
    for (const auto& [counted, wanted] : groups_of(layout, roads::layout_scene_luminaires(layout), result)) {
        RoadPictures some(device, with_luminaires(scene, counted));
        for (const auto& [observer, point] : wanted) {
            const gpu_scene::View view =
                road_point_view(result.observers[observer], {result.points[point].x, result.points[point].y});
            made.observers[observer].counted.luminance[point] =
                read_point(some.render(view), view, result.points[point]);
        }
    }
    for (size_t i = 0; i < made.observers.size(); ++i) {
        summarise(layout, result, i, made.observers[i].counted);
        summarise(layout, result, i, made.observers[i].every);
    }
    made.overview = road_overview(layout, result.observers[made.darkest], 1000);
    made.overview_rgba = whole.render(made.overview);
    return made;
}

std::string text_of(const roads::RoadLighting& result, const RenderedRoad& rendered) {
    const size_t columns = result.field.x.size();
    std::string text =
        "\nRendered on " + rendered.device +
        ", with the luminaires that count for each point, at 1 mm a pixel: calculated, rendered, difference in %\n";
    for (size_t o = 0; o < result.observers.size(); ++o) {
        const roads::LaneObserver& observer = result.observers[o];
        const RenderedObserver& seen = rendered.observers[o];
        text += format(
            "\nLuminance for the observer of lane %d, cd/m2 (the picture by every luminaire: %u x %u px, at most %.1f "
            "cm of road in one)\n   y \\ x  ",
            observer.lane, seen.view.extent.width, seen.view.extent.height, 100 * seen.longest_pixel);
        for (const double x : result.field.x) text += format(" %7.2f", x);
        for (size_t row = result.field.y.size(); row-- > 0;)
            for (int line = 0; line < 3; ++line) {
                text += line == 0 ? format("\n %7.3f  ", result.field.y[row]) : std::string("\n          ");
                for (size_t i = row * columns; i < (row + 1) * columns; ++i) {
                    const double calculated = result.points[i].luminance[o], read = seen.counted.luminance[i];
                    text += line == 2
                                ? format(" %+7.2f", difference_percent(read, calculated, observer.average_luminance))
                                : format(" %7.3f", line == 0 ? calculated : read);
                }
            }
        text += "\n";
    }
    text += "\n  lane  Lav cd/m2                  Uo               Ul              points: rms  largest\n";
    for (size_t o = 0; o < result.observers.size(); ++o)
        text += summary_line(result.observers[o], rendered.observers[o].counted);
    text += "  and by every luminaire, those that the standard leaves out too:\n";
    for (size_t o = 0; o < result.observers.size(); ++o)
        text += summary_line(result.observers[o], rendered.observers[o].every);
    text += "\nGlare, off a picture of the new luminaires: veil in cd/m2 and TI, calculated, rendered\n";
    for (size_t o = 0; o < result.observers.size(); ++o) {
        const roads::LaneObserver& a = result.observers[o];
        const vision::GlareReport& b = rendered.observers[o].glare;
        text += format("  %4d  %7.4f %7.4f   %6.2f %% %6.2f %%\n", a.lane, a.veil, b.road_veil,
                       a.threshold_increment_percent, b.increment);
    }
    text += "\nLargest difference: " + worst_line(result, rendered, &RenderedObserver::counted);
    return text + "By every luminaire: " + worst_line(result, rendered, &RenderedObserver::every);
}

}  // namespace vesper::commands
