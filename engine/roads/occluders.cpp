#include "roads/occluders.h"

#include <algorithm>
#include <span>
#include <utility>

#include "roads/layout_scene.h"
#include "scene/fixtures.h"
#include "scene/read_scene.h"

namespace vesper::roads {

Occluders::Occluders(const std::filesystem::path& file) : Occluders(scene::read_scene(file).scene) {}

Occluders::Occluders(scene::Scene scene)
    : scene_(std::move(scene)), world_(scene::world_transforms(scene_, 0)), rays_(scene_, world_) {
    const std::vector<uint32_t> nodes = scene::nodes_with_lamps(scene_);
    for (const uint32_t node : nodes) lamps_.emplace_back(world_[node][3]);
    fixtures_ = scene::fixture_nodes(scene_, nodes, world_);
}

bool Occluders::hide(glm::dvec3 luminaire, glm::dvec3 point) const {
    const glm::dvec3 from = layout_to_world(luminaire), way = layout_to_world(point) - from;
    std::span<const uint32_t> own;
    double nearest = kSameLamp;
    for (size_t i = 0; i < lamps_.size(); ++i)
        if (const double distance = glm::distance(lamps_[i], from); distance <= nearest)
            nearest = distance, own = fixtures_[i];
    const double begin = kHousing / glm::length(way);
    const double end = point.z < kKerb ? (luminaire.z - kKerb) / (luminaire.z - point.z) : 1;
    return begin < end && rays_.blocked(from + begin * way, from + end * way, own);
}

}  // namespace vesper::roads
