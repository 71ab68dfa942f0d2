// What a view sees of obstacles, and how well. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "render/passes/targets.h"
#include "scene/obstacles.h"

namespace vesper::render {

/// An obstacle in a picture. A pixel is the obstacle's if its middle sees one of its surfaces. Luminances are means of
/// pixels that no edge crosses and that are no glare sources; its surroundings are those of add_targets().
struct SeenObstacle {
    enum class State : uint8_t {
        Measured,       ///< the only state with luminances
        OutOfPicture,   ///< beside the picture or behind the eye
        TooNear,        ///< it reaches beside or behind the eye
        Hidden,         ///< by other things, or smaller than a pixel
        TooFewPixels,   ///< less than kLeastPixels that no edge crosses
        NoSurroundings  ///< fewer around it, but glare sources and other obstacles
    };
    State state = State::OutOfPicture;
    double distance = 0;    ///< m, from the eye to the middle of the box around it (along the axes of the world)
    double steradians = 0;  ///< that are seen
    double luminance = 0;   ///< of the scene, cd/m^2
    double around = 0;      ///< likewise, of its surroundings
    double veil = 0;        ///< mean of retina over scene in its surroundings, cd/m^2; at least 0
    glm::dvec2 centre{0};   ///< mean place of its pixels, px from the top left corner
};
constexpr uint32_t kLeastPixels = 4;

/// The state in a few words; empty if it is measured.
const char* words_of(SeenObstacle::State state);

/// Where obstacles may be seen, in their order, and what is known of them before a frame is rendered.
struct ObstaclesInView {
    std::vector<shared::TargetRect> rects;
    std::vector<SeenObstacle> seen;
};
ObstaclesInView obstacles_in_view(const std::vector<scene::Obstacle>&, const gpu_scene::SceneFrame& poses,
                                  const gpu_scene::View& view);

/// 1 + number of the obstacle of each instance of a G-buffer (shared::Instance) of this scene, or 0.
std::vector<uint32_t> obstacles_of_instances(const std::vector<scene::Obstacle>&, const gpu_scene::GpuScene&,
                                             std::span<const std::byte> instances);

/// The same of each pixel, by GBuffer::triangle.
std::vector<uint8_t> obstacles_of_pixels(std::span<const glm::uvec2> triangles, std::span<const uint32_t> of_instances);

/// Takes over what the device has measured.
void measure(ObstaclesInView&, std::span<const shared::TargetSums> sums, const gpu_scene::View& view);

/// Visibility levels (Adrian 1989) of an obstacle that is looked at for 0.2 s by an observer of that age: negative
/// where it is darker. Nothing where it is not measured or the formula does not hold.
struct ObstacleVisibility {
    double size = 0;              ///< arc minutes, of a disc as large; 0: it is not measured
    std::optional<double> level;  ///< with the veil over obstacle and surroundings
    std::optional<double> without_veil;
};
ObstacleVisibility visibility_of(const SeenObstacle&, double age);

}  // namespace vesper::render
