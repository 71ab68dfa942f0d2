// The meshes that hold a lamp and never hide it. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace vesper::scene {

/// The nodes that have a lamp, ascending.
std::vector<uint32_t> nodes_with_lamps(const Scene& scene);

/// Whether there is a mesh at or below each node.
std::vector<bool> nodes_above_meshes(const Scene& scene);

/// For each of these nodes, which have lamps, the nodes with meshes that are its fixture, ascending: those at and below
/// Node::fixture. Without that those at and below the nearest node, of its own and those above it, that has any; none
/// if one of their primitives reaches 20 m to the side of the lamp, or 50 m up or down. `world` as of
/// world_transforms().
std::vector<std::vector<uint32_t>> fixture_nodes(const Scene& scene, std::span<const uint32_t> lamp_nodes,
                                                 std::span<const glm::dmat4> world);

/// Of those, the nodes of its housing, such as its glass: the intensities of the lamp hold what they emit, reflect and
/// get of it. They are all where Node::fixture says so; otherwise those at most 6 m across with a triangle whose box is
/// within 0.5 m of the lamp.
std::vector<std::vector<uint32_t>> housing_nodes(const Scene& scene, std::span<const uint32_t> lamp_nodes,
                                                 std::span<const glm::dmat4> world);

}  // namespace vesper::scene
