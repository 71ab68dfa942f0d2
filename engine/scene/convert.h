// From a daytime, low-dynamic-range glTF database to a photometric one. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "scene/apply_photometry.h"

namespace vesper::scene {

/// Applies a photometry file (docs/photometry.md, data/photometry.schema.json) to a glTF file and writes one
/// self-contained glTF file (.gltf with data URIs, or .glb). Reading that gives the scene that apply_photometry() makes
/// of the original, and all that Vesper does not know in it stays. `output` is replaced only when the whole file is
/// written. `transfer` overrules what the photometry file says of textures. Throws Error naming file, place and reason.
PhotometryReport convert(const std::filesystem::path& input, const std::filesystem::path& photometry,
                         const std::filesystem::path& output, const std::optional<Transfer>& transfer = std::nullopt,
                         const SceneLimits& limits = {});

}  // namespace vesper::scene
