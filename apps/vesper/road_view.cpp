#include "road_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "base/angle.h"
#include "roads/layout_scene.h"
#include "scene/colour.h"

namespace vesper::commands {
namespace {

using gpu_scene::View;

constexpr double kDepth = 0.05;   // m of road in a pixel
constexpr double kAcross = 0.02;  // m
constexpr uint32_t kFewest = 256, kMostColumns = 1024;
constexpr float kNear = 1;  // m

/// The world from an eye that looks along the road, level.
glm::mat4 along_road(glm::dvec3 eye) {
    glm::mat4 view(1);
    view[3] = glm::vec4(-glm::vec3(roads::layout_to_world(eye)), 1);
    return view;
}

uint32_t pixels(double span, double size, uint32_t most) {
    return static_cast<uint32_t>(
        std::clamp(std::ceil(span / size), static_cast<double>(kFewest), static_cast<double>(most)));
}

}  // namespace

View road_view(const roads::RoadLayout& layout, const roads::LaneObserver& observer, uint32_t max_rows) {
    const roads::CalculationField field = roads::calculation_field(layout);
    const glm::dvec3 eye = roads::vector_of(observer.eye);
    const double across = layout.width / static_cast<double>(field.y.size());
    const double near = field.x.front() - field.step / 2 - eye.x, far = field.x.back() + field.step - eye.x;
    const double right = (eye.y + across) / near, left = (layout.width - eye.y + across) / near;
    const double bottom = -eye.z / (near - field.step / 2), top = -eye.z / far;
    View view;
    view.extent = {pixels(right + left, kAcross / near, kMostColumns),
                   pixels(top - bottom, kDepth * eye.z / (far * far), max_rows)};
    view.world_to_view = along_road(eye);
    view.tangent_low = {static_cast<float>(-left), static_cast<float>(bottom)};
    view.tangent_high = {static_cast<float>(right), static_cast<float>(top)};
    view.near = kNear;
    return view;
}

View road_point_view(const roads::LaneObserver& observer, glm::dvec2 point) {
    constexpr double kPixels = 8, kOfRoad = 0.001;  // m in one
    const glm::dvec2 away = point - glm::dvec2(roads::vector_of(observer.eye));
    const glm::dvec2 middle(-away.y / away.x, -observer.eye.z / away.x);
    const glm::dvec2 half = 0.5 * kPixels * kOfRoad * glm::dvec2(1 / away.x, observer.eye.z / (away.x * away.x));
    View view;
    view.extent = {uint32_t(kPixels), uint32_t(kPixels)};
    view.world_to_view = along_road(roads::vector_of(observer.eye));
    view.tangent_low = glm::vec2(middle - half);
    view.tangent_high = glm::vec2(middle + half);
    view.near = kNear;
    return view;
}

View road_overview(const roads::RoadLayout& layout, const roads::LaneObserver& observer, uint32_t width) {
    const double near = 40, bottom = -observer.eye.z / near, top = 0.2 * -bottom;
    const double right = (observer.eye.y + 1) / near, left = (layout.width - observer.eye.y + 1) / near;
    View view;
    view.extent = {width, std::max(1u, static_cast<uint32_t>(std::lround(width * (top - bottom) / (right + left))))};
    view.world_to_view = along_road(roads::vector_of(observer.eye));
    view.tangent_low = {static_cast<float>(-left), static_cast<float>(bottom)};
    view.tangent_high = {static_cast<float>(right), static_cast<float>(top)};
    view.near = kNear;
    return view;
}

View road_glare_view(glm::dvec3 eye) {
    const double roof = std::tan(21 * kRadiansPerDegree);
    View view;
    view.extent = {1600, 400};
    view.world_to_view = glm::rotate(glm::mat4(1), float(kRadiansPerDegree), glm::vec3(1, 0, 0)) * along_road(eye);
    view.tangent_low = {-1.2f, float(roof - 0.6)};
    view.tangent_high = {1.2f, float(roof)};
    view.near = kNear;
    return view;
}

glm::dvec2 project(const View& view, glm::dvec3 road_point) {
    const glm::dvec4 seen = view.world_to_view * glm::dvec4(roads::layout_to_world(road_point), 1);
    const glm::dvec2 tangent = glm::dvec2(seen) / -seen.z;
    const glm::dvec2 low(view.tangent_low), high(view.tangent_high);
    return glm::dvec2(view.extent.width, view.extent.height) *
           glm::dvec2((tangent.x - low.x) / (high.x - low.x), (high.y - tangent.y) / (high.y - low.y));
}

double depth_of_pixel(const View& view, const roads::LaneObserver& observer, double x) {
    const double tangent = static_cast<double>(view.tangent_high.y - view.tangent_low.y) / view.extent.height;
    const double away = x - observer.eye.x;
    return tangent * away * away / observer.eye.z;
}

double luminance_at(std::span<const float> rgba, VkExtent2D extent, glm::dvec2 place) {
    const glm::dvec2 corner = glm::floor(place - 0.5), weight = place - 0.5 - corner;
    if (!(corner.x >= 0 && corner.y >= 0 && corner.x + 1 < extent.width && corner.y + 1 < extent.height))
        return std::numeric_limits<double>::quiet_NaN();
    const auto pixel = [&](int dx, int dy) {
        const float* p =
            &rgba[4 * ((static_cast<size_t>(corner.y) + dy) * extent.width + static_cast<size_t>(corner.x) + dx)];
        return luminance({p[0], p[1], p[2]});
    };
    return glm::mix(glm::mix(pixel(0, 0), pixel(1, 0), weight.x), glm::mix(pixel(0, 1), pixel(1, 1), weight.x),
                    weight.y);
}

}  // namespace vesper::commands
