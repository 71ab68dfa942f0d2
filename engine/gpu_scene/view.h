// One eye's view of the scene. SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan_core.h>
#include <glm/glm.hpp>

#include "vision/image_angles.h"

namespace vesper::gpu_scene {

/// Where an eye stands and what its image covers. The view frame: x right, y up, looking along -z, m.
struct View {
    VkExtent2D extent{1680, 1050};        ///< px
    glm::dmat4 world_to_view{1};          ///< in double, as what is seen may be far from the origin
    glm::vec2 tangent_low{-0.8f, -0.5f};  ///< tangents of the left and bottom edge of the image
    glm::vec2 tangent_high{0.8f, 0.5f};   ///< and of the right and top edge
    float near = 0.1f;                    ///< nothing nearer is drawn, m

    /// A symmetric view of square pixels. `vertical_fov` in rad.
    static View symmetric(VkExtent2D extent, float vertical_fov, const glm::dmat4& world_to_view, float near = 0.1f);
    /// A view that covers the same as a picture.
    static View of(const vision::ImageAngles& image, const glm::dmat4& world_to_view = glm::dmat4(1),
                   float near = 0.1f);

    /// The same, but every pixel sees what lies so many px to the right of its middle, and below it.
    View moved(glm::dvec2 pixels) const;

    /// To the view's frame, from one that has this place in the world.
    glm::mat4 from(const glm::dmat4& to_world) const { return glm::mat4(world_to_view * to_world); }

    /// A pixel (x, y), y down, sees along (ray_scale * (pixel + 0.5) + ray_offset, -1).
    glm::vec2 ray_scale() const;
    glm::vec2 ray_offset() const;
    /// Angle a pixel covers in height at the centre of a symmetric view, degrees.
    double degrees_per_pixel() const;
};

/// Where the eye of a view is, m, world.
glm::dvec3 eye_of(const View& view);
/// What a view covers.
vision::ImageAngles angles_of(const View& view);

}  // namespace vesper::gpu_scene
