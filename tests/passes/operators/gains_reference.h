// Ferwerda, Pattanaik, Shirley and Greenberg 1996; Durand and Dorsey 2000, reconstructed. SPDX-License-Identifier: MIT
#pragma once

#include "passes/operators/operator_reference.h"

namespace vesper::reference {

/// Responses of cones to linear Rec. 709: XYZ (IEC 61966-2-1) through Estevez 1979.
inline dvec3 cone_responses(dvec3 rgb) {
    const glm::dmat3 xyz = glm::transpose(
        glm::dmat3(0.412391, 0.357584, 0.180481, 0.212639, 0.715169, 0.072192, 0.019331, 0.119195, 0.950532));
    const glm::dmat3 estevez =
        glm::transpose(glm::dmat3(0.38971, 0.68898, -0.07868, -0.22981, 1.18340, 0.04641, 0, 0, 1));
    return estevez * (xyz * rgb);
}
inline glm::dmat3 cone_matrix() {
    return {cone_responses({1, 0, 0}), cone_responses({0, 1, 0}), cone_responses({0, 0, 1})};
}

/// ln of cones' responses, averaged over tiles, over those to white of the luminance they stand for.
inline dvec3 looked_at_chroma(const PyramidLevel& tiles, dvec3 before) {
    dvec3 sum(0);
    double pixels = 0;
    for (const dvec4& t : tiles.texels)
        sum += t.w * glm::log(glm::max(cone_responses(glm::max(dvec3(t), dvec3(0))), dvec3(kFloor))), pixels += t.w;
    if (pixels == 0) return before;
    const dvec3 cones = glm::exp(sum / pixels);
    return glm::log(cones /
                    (std::max(luminance(glm::inverse(cone_matrix()) * cones), kFloor) * cone_responses(dvec3(1))));
}

/// Von Kries's adaptation as far as CIECAM02 has it at a luminance (Moroney et al. 2002), for Rec. 709.
inline glm::dmat3 chromatic_adaptation(dvec3 chroma, double luminance) {
    const double degree = 1 - std::exp((-luminance - 42) / 92) / 3.6;
    const dvec3 gain = degree * glm::exp(-chroma) + dvec3(1 - degree);
    glm::dmat3 diagonal(0);
    for (int i = 0; i < 3; ++i) diagonal[i][i] = gain[i];
    return glm::inverse(cone_matrix()) * diagonal * cone_matrix();
}

/// Ferwerda et al. 1996, Eq. 7 to 11: thresholds become those of the display.
inline void gains_frame(const OperatorFrame& f, Adapted& out) {
    const shared::ToneParameters& p = f.in.parameters;
    const bool in_state = p.ceiling == shared::kCeilingEye;
    const double shown = vision::cone_threshold(p.display_high / 2.0, f.breaks);
    const double cone_gain =
        shown / (in_state ? f.cones.threshold(f.adaptation, f.cone_sigma) : f.cones.adapted_threshold(f.adaptation));
    const double rod_gain =
        shown / (in_state ? f.rods.threshold(f.scotopic, f.rod_sigma) : f.rods.adapted_threshold(f.scotopic));
    const double k = std::pow(std::clamp(1 - (f.adaptation / 2 - 0.01) / 9.99, 0.0, 1.0), 2);
    out.tone.block[0] = {float(p.display_low / cone_gain),
                         float(cone_gain / (double(p.display_high) - double(p.display_low))), 0, 0};
    out.tone.block[1] = glm::vec4(glm::vec3(dvec3(p.settings[0]) * (k * rod_gain * p.scotopic / cone_gain)), 0);
    dvec3 chroma(f.in.previous.chroma);
    glm::dmat3 seen(1);
    if (!f.in.colours.texels.empty()) {
        const dvec3 goal = looked_at_chroma(
            f.in.colours, chroma);  // half at once, half with a half-life of 20 s (Rinner and Gegenfurtner 2000)
        chroma = f.first ? goal : goal + (chroma - goal) * std::exp2(-double(p.seconds) / 20);
        seen = chromatic_adaptation((goal + chroma) / 2.0, f.adaptation);
    }
    const glm::dmat3 rows = glm::transpose(seen);
    for (int i = 0; i < 3; ++i) out.tone.block[2 + i] = glm::vec4(glm::vec3(rows[i]), 0);
    out.eye.chroma = glm::vec3(chroma);
}

}  // namespace vesper::reference
