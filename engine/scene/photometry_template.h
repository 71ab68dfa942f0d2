// A photometry file that is ready to fill in, made of what a scene holds. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/read_scene.h"

namespace vesper::scene {

/// Why a rule is there, the strongest reason first.
enum class SourceReason : uint8_t { Light, Emission, Name, Bright };
inline constexpr size_t kSourceReasons = 4;
/// "light of the file", "emission", "name", "bright".
const char* name_of(SourceReason);

/// A photometry file (docs/photometry.md) and figures of it.
struct PhotometryTemplate {
    std::string text;                                 ///< JSON
    size_t lamps = 0, emitters = 0;                   ///< rules
    std::array<size_t, kSourceReasons> rules{};       ///< by reason
    std::array<size_t, kSourceReasons> sources{};     ///< nodes and materials that these rules match, by reason
    size_t left_out_rules = 0, left_out_sources = 0;  ///< beyond the limits of a file
    size_t suns = 0;                                  ///< nodes with directional lights, which get no rule
    size_t nameless = 0;                              ///< sources that no pattern can name
    size_t dark = 0;                                  ///< nodes with black lights or without intensity: no rule
    size_t parts = 0;                                 ///< nodes named as lamps that are parts of others: no rule
};

/// Most rules of lamps, and of emitters, each.
inline constexpr size_t kMostTemplateRules = 200;

/// Rules with usual values for the nodes and materials of a scene without photometry that look like sources of light:
/// lights of the file, materials that emit, names (sounds_like_light), small textures and surfaces that reflect more
/// than real ones. Names that differ by a number share a rule. A "comment" in each rule states the reason. `name` of
/// the scene, for that of the file. Throws OverLimit where the budget is spent.
PhotometryTemplate make_photometry_template(const Scene& scene, const std::string& name,
                                            const SceneSource& source = {});

}  // namespace vesper::scene
