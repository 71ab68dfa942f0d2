#include "gpu_scene/moving_things.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/luminance.h"
#include "shared/moving_light.h"

namespace vesper::gpu_scene {

static_assert(shared::kMostHidden == transport::MovingBodies::kAll);

namespace {

// With how near or strong it is.
template <class Thing>
using Ranked = std::vector<std::pair<double, Thing>>;

// The least ranks first.
template <class Thing, class Take>
void take_first(Ranked<Thing>& things, size_t most, Take take) {
    std::ranges::stable_sort(things, {}, &std::pair<double, Thing>::first);
    for (size_t i = 0; i < std::min(most, things.size()); ++i) take(things[i].second);
}

// Pixels and depths of a box, which `to_view` takes to the view frame; false if it is out of view.
bool cover(const glm::dmat4& to_view, glm::dvec3 low, glm::dvec3 high, const View& view, shared::HidingBody& body) {
    const glm::dvec2 all(view.extent.width, view.extent.height), scale(view.ray_scale()), offset(view.ray_offset());
    const double near = double(view.near);
    glm::dvec2 least = all, most(0);
    double nearest = HUGE_VAL, farthest = 0;
    const auto add = [&](glm::dvec3 p) {
        const glm::dvec2 pixel = (glm::dvec2(p) / -p.z - offset) / scale;
        least = glm::min(least, pixel), most = glm::max(most, pixel);
        nearest = std::min(nearest, -p.z), farthest = std::max(farthest, -p.z);
    };
    const auto corner = [&](int k) {
        const glm::dvec3 at(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
        return glm::dvec3(to_view * glm::dvec4(at, 1));
    };
    for (int k = 0; k < 8; ++k) {
        const glm::dvec3 p = corner(k);
        if (-p.z >= near) add(p);
        for (const int axis : {1, 2, 4})  // edges that pass through the near plane
            if (const glm::dvec3 q = corner(k ^ axis); (k & axis) == 0 && (-p.z >= near) != (-q.z >= near))
                add(glm::dvec3(glm::dvec2(glm::mix(p, q, (near + p.z) / (p.z - q.z))), -near));
    }
    least = glm::max(glm::floor(least), 0.0), most = glm::max(glm::min(glm::ceil(most), all), 0.0);
    body.pixels = {glm::uvec2(glm::min(least, all)), glm::uvec2(most)};
    body.depths = glm::vec2(nearest, farthest);
    return farthest >= near && least.x < most.x && least.y < most.y;
}

void add_body(const transport::OcclusionVolume& volume, const glm::dmat4& world, const View& view,
              Ranked<shared::HidingBody>& found) {
    const glm::dmat4 to_view = view.world_to_view * world, back = glm::inverse(to_view);
    if (!std::isfinite(back[0].x + back[3].x)) return;
    const glm::dvec3 size = volume.step * glm::dvec3(volume.count - 1u);
    const auto row = [&](int axis) {
        const glm::dvec4 own(back[0][axis], back[1][axis], back[2][axis], back[3][axis] - volume.low[axis]);
        return glm::vec4(own / volume.step);
    };
    shared::HidingBody body{.pixels = {},
                            .depths = {},
                            .unused = {},
                            .volume = {volume.count, volume.first},
                            .x = row(0),
                            .y = row(1),
                            .z = row(2)};
    // A surface may be one step outside and look in.
    if (cover(to_view, volume.low - volume.step, volume.low + size + volume.step, view, body))
        found.emplace_back(glm::length(glm::dvec3(to_view * glm::dvec4(volume.low + 0.5 * size, 1))), body);
}

}  // namespace

MovingThings moving_things(const transport::MovingBodies& bodies, std::span<const transport::LitPatch> patches,
                           const SceneFrame& poses, const View& view) {
    MovingThings found;
    Ranked<shared::HidingBody> near;
    for (const transport::MovingBodies::Body& body : bodies.bodies)
        add_body(bodies.volumes[body.volume], poses.world[body.node], view, near);
    take_first(near, shared::kMostBodies, [&](const shared::HidingBody& body) { found.bodies.push_back(body); });
    Ranked<const transport::LitPatch*> strong;
    for (const transport::LitPatch& patch : patches) {
        const glm::dvec3 off = patch.position - eye_of(view);
        const double lux = luminance(patch.intensity) / (glm::dot(off, off) + patch.radius * patch.radius);
        if (std::isfinite(lux)) strong.emplace_back(-lux, &patch);
    }
    take_first(strong, shared::kMostPatches, [&](const transport::LitPatch* patch) {
        const glm::dvec3 at(view.world_to_view * glm::dvec4(patch->position, 1)),
            facing = glm::dmat3(view.world_to_view) * patch->normal;
        found.patches.emplace_back(at, patch->radius);
        found.patches.emplace_back(facing, 0), found.patches.emplace_back(patch->intensity, 0);
    });
    return found;
}

std::vector<glm::uvec4> volume_texels(const transport::MovingBodies& bodies) {
    const auto word = [&](const transport::OcclusionVolume& volume, glm::uvec3 place) {
        if (place.x >= volume.count.x || place.y >= volume.count.y) return 0u;
        const size_t at = volume.first + (size_t{place.z} * volume.count.y + place.y) * volume.count.x + place.x;
        uint32_t sides = 0;
        for (uint32_t side = 0; side < transport::kSides; ++side)
            sides |= uint32_t{bodies.hidden[at][side]} << side * shared::kHiddenBits;
        return sides;
    };
    std::vector<glm::uvec4> texels(bodies.hidden.size());
    for (const transport::OcclusionVolume& volume : bodies.volumes) {
        glm::uvec4* texel = texels.data() + volume.first;
        for (uint32_t z = 0; z < volume.count.z; ++z)
            for (uint32_t y = 0; y < volume.count.y; ++y)
                for (uint32_t x = 0; x < volume.count.x; ++x, ++texel)
                    for (uint32_t k = 0; k < 4; ++k)
                        (*texel)[glm::length_t(k)] = word(volume, {x + (k & 1), y + (k >> 1), z});
    }
    return texels;
}

}  // namespace vesper::gpu_scene
