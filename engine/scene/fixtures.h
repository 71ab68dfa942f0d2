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

/// How far around a lamp meshes of its fixture are its housing, such as its glass: its intensities hold what they emit
/// and get of it. Everywhere where Node::fixture states the fixture. m
double housing_reach(const Node& lamp);

}  // namespace vesper::scene
