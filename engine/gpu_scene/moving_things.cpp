#include "gpu_scene/moving_things.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/luminance.h"
#include "shared/moving_light.h"

namespace vesper::gpu_scene {
namespace {

constexpr double kLeastLight = 0.01;  // of a patch, lx: farther off it lights nothing

// Pixels of a box of the view frame, as left, top, right and bottom; none if it is out of view. `to_view`: from its own
// frame.
std::optional<glm::vec4> pixels_of(const glm::dmat4& to_view, glm::dvec3 low, glm::dvec3 high, const View& view) {
    const glm::dvec2 all(view.extent.width, view.extent.height), scale(view.ray_scale()), offset(view.ray_offset());
    glm::dvec2 least = all, most(0);
    bool before = false, behind = false;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
        const glm::dvec3 p(to_view * glm::dvec4(at, 1));
        before = before || p.z < -double(view.near), behind = behind || p.z >= -double(view.near);
        const glm::dvec2 pixel = (glm::dvec2(p) / -p.z - offset) / scale;
        least = glm::min(least, pixel), most = glm::max(most, pixel);
    }
    if (!before) return std::nullopt;
    if (behind) least = glm::dvec2(0), most = all;  // it reaches behind the eye
    least = glm::max(glm::floor(least), 0.0), most = glm::min(glm::ceil(most), all);
    if (!(least.x < most.x && least.y < most.y)) return std::nullopt;
    return glm::vec4(least, most);
}

// With its texels, and how near or strong it is.
struct Thing {
    double rank;  // the least first
    std::vector<glm::vec4> texels;
};

uint32_t add_first(std::vector<Thing>& things, size_t most, std::vector<glm::vec4>& texels) {
    std::ranges::stable_sort(things, {}, &Thing::rank);
    if (things.size() > most) things.resize(most);
    for (const Thing& thing : things) texels.insert(texels.end(), thing.texels.begin(), thing.texels.end());
    return uint32_t(things.size());
}

std::optional<Thing> body_thing(const transport::OcclusionVolume& volume, const glm::dmat4& world, const View& view) {
    const glm::dmat4 to_view = view.world_to_view * world;
    const glm::dvec3 size = volume.step * glm::dvec3(volume.count - 1u);
    // A surface may be one step outside and look in.
    const auto pixels = pixels_of(to_view, volume.low - volume.step, volume.low + size + volume.step, view);
    const glm::dmat4 back = glm::inverse(to_view);
    if (!pixels || !std::isfinite(back[0].x + back[3].x)) return std::nullopt;
    Thing thing{glm::length(glm::dvec3(to_view * glm::dvec4(volume.low + 0.5 * size, 1))), {}};
    for (int axis = 0; axis < 3; ++axis)
        thing.texels.emplace_back(
            glm::dvec4(back[0][axis], back[1][axis], back[2][axis], back[3][axis] - volume.low[axis]) / volume.step);
    thing.texels.emplace_back(volume.count, volume.first);
    thing.texels.push_back(*pixels);
    return thing;
}

std::optional<Thing> patch_thing(const transport::LitPatch& patch, const View& view) {
    const double candela = luminance(patch.intensity), reach2 = candela / kLeastLight;
    const glm::dvec3 at(view.world_to_view * glm::dvec4(patch.position, 1));
    const auto pixels = pixels_of(glm::dmat4(1), at - std::sqrt(reach2), at + std::sqrt(reach2), view);
    if (!(candela > 0) || !pixels) return std::nullopt;
    const glm::dvec3 facing = glm::dmat3(view.world_to_view) * patch.normal;
    return Thing{-candela / (glm::dot(at, at) + patch.radius * patch.radius),
                 {glm::vec4(at, patch.radius), glm::vec4(facing, 0), glm::vec4(patch.intensity, 0), *pixels}};
}

}  // namespace

MovingThings moving_things(const transport::MovingBodies& bodies, std::span<const transport::LitPatch> patches,
                           const SceneFrame& poses, const View& view) {
    MovingThings found;
    std::vector<Thing> things;
    for (const transport::MovingBodies::Body& body : bodies.bodies)
        if (auto thing = body_thing(bodies.volumes[body.volume], poses.world[body.node], view))
            things.push_back(std::move(*thing));
    found.bodies = add_first(things, shared::kMostBodies, found.texels);
    things.clear();
    for (const transport::LitPatch& patch : patches)
        if (auto thing = patch_thing(patch, view)) things.push_back(std::move(*thing));
    found.patches = add_first(things, shared::kMostPatches, found.texels);
    return found;
}

std::vector<glm::uvec2> volume_texels(const transport::MovingBodies& bodies) {
    std::vector<glm::uvec2> texels;
    for (const std::array<uint8_t, 8>& parts : bodies.hidden) {
        const auto word = [&](size_t first) {
            return uint32_t{parts[first]} | uint32_t{parts[first + 1]} << 8u | uint32_t{parts[first + 2]} << 16u |
                   uint32_t{parts[first + 3]} << 24u;
        };
        texels.emplace_back(word(0), word(4));
    }
    return texels;
}

}  // namespace vesper::gpu_scene
