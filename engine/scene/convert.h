// From a daytime, low-dynamic-range glTF database to a photometric one. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/colour.h"  // colour_of_temperature
#include "scene/read_scene.h"

namespace vesper::scene {

struct ConversionReport {
    std::vector<std::string> changes;   ///< what was changed, one line each
    std::vector<std::string> warnings;  ///< rules that matched nothing, implausible values, what was left out
};

/// Applies a photometry file (docs/photometry.md, data/photometry.schema.json) to a glTF file and writes one
/// self-contained glTF file (.gltf with data URIs, or .glb). `output` is replaced only when the whole file is written.
/// `transfer` overrules what the photometry file says of textures. Throws Error naming file, place and reason.
ConversionReport convert(const std::filesystem::path& input, const std::filesystem::path& photometry,
                         const std::filesystem::path& output, const std::optional<Transfer>& transfer = std::nullopt,
                         const SceneLimits& limits = {});

}  // namespace vesper::scene
