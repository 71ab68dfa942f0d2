// What pictures an OpenEXR file holds. Not for others. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include <ImfMultiPartInputFile.h>

namespace vesper::io::hdr {

/// Channels that make a picture.
struct ExrLayer {
    int part = 0;
    std::string prefix;  ///< of its channels' names: "" or "layer."
    std::string name;    ///< of the part where there are several, and of the layer
    /// Whole names of the channels, empty where the layer has none: R, G, B; X, Y, Z; Y, RY, BY; or Y alone.
    std::array<std::string, 3> channels;
    bool vector =
        false;  ///< X, Y and Z in a layer or a named part: normals or places, unless whoever asks for it knows better
    enum class Kind {
        Colour,
        Xyz,
        Chroma,
        Grey
    } kind = Kind::Colour;  ///< any of R, G, B; X, Y and Z; Y with RY or BY; Y alone
};

/// The layer or part of that name. Its channels are R, G, B, X, Y, Z, RY and BY; in place of them also red, green,
/// blue and luminance, or r, g, b, y, ry and by, in letters of any case: r, g and b all three, y without x and z.
/// Without a name channels R, G, B, Y of the first part, or the only picture there is.
/// Throws Error, with the names there are.
ExrLayer choose_layer(const Imf::MultiPartInputFile&, const std::string& wanted);

}  // namespace vesper::io::hdr
