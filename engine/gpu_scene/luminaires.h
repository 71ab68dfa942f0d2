// Lamps seen directly: where their openings lie in the image, and how bright they are. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "gpu_scene/lamps.h"
#include "gpu_scene/silhouette_tiles.h"
#include "shared/luminaire.h"

namespace vesper::gpu_scene {

/// The lamps of a scene that have a place. Keeps no reference to the Scene.
struct LuminaireSet {
    std::vector<PlacedLamp> lamps;
    std::vector<photometry::Distribution> distributions;
};
LuminaireSet placed_luminaires(const scene::Scene& scene);

/// A flat opening seen at less than this angle to its plane is drawn as if turned to it: its intensity there comes from
/// what is not flat, and would be of infinite luminance.
constexpr double kGrazing = 0.0871557427476582;  // sin 5 deg
/// How far in front of a lamp a surface must lie to hide it, besides half the opening's diagonal and 0.1 % of the
/// distance: its own glass and housing do not. m
constexpr double kHousing = 0.25;
/// Half the width of the smallest silhouette that is drawn, px. Smaller openings are widened to it, their luminance
/// lowered by as much: so their light moves from pixel to pixel without a step, and its centre is where the lamp is.
constexpr double kSmallest = 0.5;

/// A glare source: the light of a lamp at the eye, without occlusion.
struct GlareSource {
    uint32_t node;           ///< of the scene, that carries it
    glm::dvec3 direction;    ///< from the eye, view frame, of unit length
    double distance;         ///< m
    double candela;          ///< towards the eye
    glm::dvec3 illuminance;  ///< RGB lx, on a plane at the eye that faces the lamp
    /// Part of its light inside the picture, 0 to 1. A lamp without opening counts as 0.4 m wide: inside, only its
    /// modelled surfaces cause glare; outside, it is a point.
    double inside;
};

/// The openings in the image: silhouette i is that of luminaire i.
struct LuminaireList : SilhouetteList {
    std::vector<shared::Luminaire> luminaires;
    std::vector<GlareSource> glare_sources;  ///< all lamps before the eye, in the order of the scene
};

/// The openings a view sees, with the luminance L = I(towards the eye) / projected area, I / d^2 being what arrives at
/// the eye. `white` is what the largest component of each is instead: the LDR baseline.
LuminaireList luminaire_list(const LuminaireSet& set, const SceneFrame& frame, const View& view,
                             std::optional<float> white = {});

}  // namespace vesper::gpu_scene
