#include "gpu_scene/view.h"

#include <cmath>

namespace vesper::gpu_scene {

View View::symmetric(VkExtent2D extent, float vertical_fov, const glm::dmat4& world_to_view, float near) {
    const float y = std::tan(vertical_fov / 2), x = y * float(extent.width) / float(extent.height);
    return {extent, world_to_view, {-x, -y}, {x, y}, near};
}

View View::of(const vision::ImageAngles& image, const glm::dmat4& world_to_view, float near) {
    return {{uint32_t(image.width), uint32_t(image.height)}, world_to_view, image.low, image.high, near};
}

View View::moved(glm::dvec2 pixels) const {
    const glm::vec2 by = ray_scale() * glm::vec2(pixels);
    View view = *this;
    view.tangent_low += by, view.tangent_high += by;
    return view;
}

glm::dvec3 eye_of(const View& view) { return glm::dvec3(glm::inverse(view.world_to_view)[3]); }

vision::ImageAngles angles_of(const View& view) {
    return {int(view.extent.width), int(view.extent.height), view.tangent_low, view.tangent_high};
}

glm::vec2 View::ray_scale() const {
    const glm::vec2 span = tangent_high - tangent_low;
    return {span.x / float(extent.width), -span.y / float(extent.height)};
}

glm::vec2 View::ray_offset() const { return {tangent_low.x, tangent_high.y}; }

double View::degrees_per_pixel() const {
    return double(tangent_high.y - tangent_low.y) / extent.height * 180 / 3.14159265358979;
}

}  // namespace vesper::gpu_scene
