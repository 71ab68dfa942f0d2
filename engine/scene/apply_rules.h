// The steps of applying a photometry file. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <set>

#include "base/decimal.h"
#include "scene/apply_photometry.h"

namespace vesper::scene {

/// Rules under way. Nodes that rules make come after those of the scene and are put in order at the end.
struct Application {
    Scene& scene;
    const Photometry& photometry;
    PhotometryReport& report;
    const SceneSource& source;
    const std::string& name;                          ///< of the scene
    uint32_t nodes = 0;                               ///< of the scene before
    std::vector<bool> images_before{};                ///< see shown_images
    std::vector<std::vector<uint32_t>> lamp_nodes{};  ///< nodes that each lamp rule matches

    bool is_added(uint32_t node) const { return marked(source.added, node); }
};

/// For each image whether a material shows it.
std::vector<bool> shown_images(const Scene&);

std::string in_quotes(const std::string& name);

/// Names of a node and of as many of those above it as fit into `depth`.
std::vector<std::string> path_of(const Scene&, uint32_t node, size_t depth);
/// For each of these nodes the node that the rule's pattern names as the fixture of its lamp: the nearest of the node
/// itself and those above it that matches, else the only one of the scene that does. Throws Error where no node, or
/// more than one, can be meant.
std::vector<uint32_t> named_fixtures(Application&, const LampRule& rule, const std::vector<uint32_t>& nodes);

/// Removes the lights there are, puts lamps on nodes.
void apply_lamps(Application&);
/// Directional lights, the sky, and what of both is not stated.
void apply_sky(Application&);
/// Emission and reflectance of materials.
void apply_materials(Application&);
/// Warns of what cannot be right: sizes, lamps, things that look like lights and were not matched.
void check_plausibility(Application&, const std::set<uint32_t>& lamp_nodes);

/// Warns of sources whose two descriptions, intensity of the lamp and luminance of the surface, disagree by more than
/// 10 %, and of those that would be seen twice. `emitting`: the materials of every emitter rule.
void check_sources(Application&, const std::vector<std::vector<uint32_t>>& emitting);

/// A factor as people say it: "12 % more", "33 % less".
std::string deviation(double factor);

/// Warns of surfaces that reflect more than there are.
void check_reflectances(const Scene&, PhotometryReport&);

/// Whether a name sounds like a source of light.
bool sounds_like_light(const std::string& name);

/// Puts the scene in the order in which a file of it would be read: new nodes after those below the same parent, lamps
/// by kind and node, no images and nodes that nothing uses any more. Fills PhotometryReport::node_of.
void put_in_order(Application&);

}  // namespace vesper::scene
