#include "render/seen_obstacles.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "shared/gbuffer.h"
#include "vision/glare_report.h"
#include "vision/visibility.h"

namespace vesper::render {
namespace {

using glm::dvec2, glm::dvec3;
using State = SeenObstacle::State;

// Boxes grow by what floats of the device and of bounds round.
constexpr double kGrown = 1e-4;

static_assert(double(shared::kGlareContrast) == vision::kSourceContrast);
static_assert(shared::kMostTargets == scene::kMostObstacles);

struct Box {
    dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
    void add(dvec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
};

void place(const scene::Obstacle& obstacle, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
           SeenObstacle& seen, shared::TargetRect& rect) {
    Box world, pixels;
    bool before = false, beside = false;  // the eye
    for (const scene::Obstacle::Part& part : obstacle.parts)
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
            const dvec3 local = glm::mix(dvec3(part.bounds.low), dvec3(part.bounds.high), side);
            const dvec3 point(poses.world.at(part.node) * glm::dvec4(local, 1)),
                at(view.world_to_view * glm::dvec4(point, 1));
            world.add(point);
            const bool ahead = -at.z > double(view.near);
            (ahead ? before : beside) = true;
            if (ahead) pixels.add({(dvec2(at) / -at.z - dvec2(view.ray_offset())) / dvec2(view.ray_scale()), 0});
        }
    const double distance = glm::distance(0.5 * (world.low + world.high), gpu_scene::eye_of(view));
    if (!std::isfinite(distance)) return;
    seen.distance = distance;
    if (before && beside) seen.state = State::TooNear;
    if (!before || beside) return;
    rect = target_rect(dvec2(pixels.low) - kGrown, dvec2(pixels.high) + kGrown, view.extent);
    if (rect.first != rect.end) seen.state = State::Hidden;  // as far as is known
}

}  // namespace

const char* words_of(State state) {
    switch (state) {
        case State::OutOfPicture:
            return "out of the picture";
        case State::TooNear:
            return "beside the eye";
        case State::Hidden:
            return "hidden";
        case State::TooFewPixels:
            return "too few pixels";
        case State::NoSurroundings:
            return "nothing around it to compare with";
        case State::Measured:
            break;
    }
    return "";
}

ObstaclesInView obstacles_in_view(const std::vector<scene::Obstacle>& obstacles, const gpu_scene::SceneFrame& poses,
                                  const gpu_scene::View& view) {
    ObstaclesInView all;
    for (const scene::Obstacle& obstacle : obstacles) {
        all.rects.push_back({.first = {0, 0}, .end = {0, 0}, .stride = 1});
        place(obstacle, poses, view, all.seen.emplace_back(), all.rects.back());
    }
    return all;
}

std::vector<uint32_t> obstacles_of_instances(const std::vector<scene::Obstacle>& obstacles,
                                             const gpu_scene::GpuScene& scene, std::span<const std::byte> instances) {
    std::vector<uint32_t> of_nodes;
    for (uint32_t i = 0; i < obstacles.size(); ++i)
        for (const scene::Obstacle::Part& part : obstacles[i].parts) {
            if (of_nodes.size() <= part.node) of_nodes.resize(part.node + 1);
            of_nodes[part.node] = i + 1;
        }
    std::vector<uint32_t> of_instances;
    for (size_t at = 0; at + sizeof(shared::Instance) <= instances.size(); at += sizeof(shared::Instance)) {
        shared::Instance instance;
        std::memcpy(&instance, instances.data() + at, sizeof instance);
        const auto mesh = size_t(instance.placement);  // 0: there are no instances
        const uint32_t node = mesh == 0 ? scene::kNone : scene.placements()[mesh - 1].node;
        of_instances.push_back(node < of_nodes.size() ? of_nodes[node] : 0);
    }
    return of_instances;
}

std::vector<uint8_t> obstacles_of_pixels(std::span<const glm::uvec2> triangles,
                                         std::span<const uint32_t> of_instances) {
    std::vector<uint8_t> pixels;
    pixels.reserve(triangles.size());
    for (const glm::uvec2& triangle : triangles)
        pixels.push_back(triangle.x == 0 || triangle.x > of_instances.size() ? 0
                                                                             : uint8_t(of_instances[triangle.x - 1]));
    return pixels;
}

void measure(ObstaclesInView& all, std::span<const shared::TargetSums> sums, const gpu_scene::View& view) {
    const dvec2 pixel = glm::abs(dvec2(view.ray_scale()));
    for (size_t i = 0; i < sums.size() && i < all.seen.size(); ++i) {
        const shared::TargetSums& s = sums[i];
        SeenObstacle& seen = all.seen[i];
        if (seen.state != State::Hidden || s.pixels == 0) continue;
        seen.steradians = pixel.x * pixel.y * double(s.solid_angle), seen.centre = dvec2(s.centre);
        seen.state = s.inner < kLeastPixels    ? State::TooFewPixels
                     : s.around < kLeastPixels ? State::NoSurroundings
                                               : State::Measured;
        if (seen.state != State::Measured) continue;
        seen.luminance = double(s.luminance), seen.around = double(s.around_scene);
        seen.veil = std::max(0.0, double(s.around_retina) - double(s.around_scene));
    }
}

ObstacleVisibility visibility_of(const SeenObstacle& seen, double age) {
    if (seen.state != State::Measured) return {};
    const double size = vision::disc_minutes(seen.steradians);
    const vision::Target target{.size = size, .age = age};
    return {.size = size,
            .level = vision::bounded_visibility_level(seen.luminance + seen.veil, seen.around + seen.veil, target),
            .without_veil = vision::bounded_visibility_level(seen.luminance, seen.around, target)};
}

}  // namespace vesper::render
