// The tone operators: what each is, and what it needs. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vesper {

/// How scene luminance becomes display luminance.
enum class Operator : uint8_t {
    Irawan,    ///< Irawan, Ferwerda and Marschner 2005, reconstructed: histogram adjustment under the thresholds of an eye that adapts over time
    Ward,      ///< Ward Larson, Rushmeier and Piatko 1997: histogram adjustment under the thresholds of an adapted eye
    Reinhard,  ///< Reinhard et al. 2002, global
    Linear,    ///< linear between two luminances
    Ldr,       ///< no HDR at all: lamps and sources of 1.0, values clamped to [0, 1]
    Pattanaik, ///< Pattanaik, Tumblin, Yee and Greenberg 2000: responses of an eye that adapts over time
    Ferwerda,  ///< Ferwerda, Pattanaik, Shirley and Greenberg 1996: linear gains of cones and rods
    Durand,    ///< Durand and Dorsey 2000, reconstructed: the same with the thresholds of an eye that adapts over time
    Grave,     ///< Grave and Bremond 2008, reconstructed: contrast in bands, each as visible as in the scene
};

struct OperatorInfo {
    Operator tone_operator;
    std::string_view name;      ///< as users write it
    std::string_view summary;   ///< author, year, in a line
    uint32_t form;              ///< how pixels are mapped: shared::kTone*
    uint32_t model;             ///< what makes the parameters: shared::kModel*
    uint32_t ceiling;           ///< default of the thresholds: shared::kCeiling*
    uint32_t adapt_to;          ///< default of what the eye adapts to: shared::kAdapt*
    bool remembers;             ///< the picture depends on the frames before, and not only to smooth flicker
    float rod_tint[3] = {0, 0, 0};  ///< colour of what rods see; 0: grey
    bool chromatic = false;     ///< the eye adapts to the colour it looks at
    bool bands = false;         ///< contrast is mapped in bands (add_bands), and only what lies above them by the curve
};

/// Every operator, in the order of the enumeration.
std::span<const OperatorInfo> operators();
const OperatorInfo& operator_info(Operator);

}  // namespace vesper
