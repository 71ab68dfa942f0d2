// Photometry of a scene, put into the document that the scene was read from. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/apply_photometry.h"
#include "scene/gltf_reader.h"

namespace vesper::scene {

/// Counts of a scene before rules were applied to it.
struct SceneBefore {
    explicit SceneBefore(const GltfReader& reader)
        : materials(reader.scene.materials),
          lights(reader.punctual_lights),
          profiles(reader.scene.distributions.size()) {}

    std::vector<Material> materials;
    size_t lights, profiles;
};

/// Changes a document so that reading it gives the scene of `reader`, to which rules have been applied since it was
/// read from this document. All that the scene does not know stays. Returns the extras block, which is not yet in the
/// document. Throws Error.
nlohmann::json patch_gltf(GltfDocument& document, const GltfReader& reader, const SceneBefore& before,
                          const Photometry& photometry, const PhotometryReport& report);

/// The object member of that name, made when missing. Throws Error when it is something else.
nlohmann::json& object_member(const GltfDocument& document, nlohmann::json& holder, const std::string& key);

/// patch_gltf, for materials. Returns "luminous" of the block.
nlohmann::json patch_materials(GltfDocument& document, const GltfReader& reader, const SceneBefore& before);
/// Puts an extension on the list of those used.
void use_extension(nlohmann::json& root, const std::string& name);

}  // namespace vesper::scene
