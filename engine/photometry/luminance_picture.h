// A picture of a light source: its luminance, texel by texel. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::io {
struct HdrImage;
}  // namespace vesper::io

namespace vesper::photometry {

/// Luminance of an emitting surface. Values times a factor of the surface are cd/m^2.
struct LuminancePicture {
    std::string name;
    uint32_t width = 0, height = 0;
    std::vector<float> rgb;  ///< linear Rec. 709, rows from the top, in [0, kLargestValue]
};

constexpr float kLargestValue = 1e30f;

/// From a picture, its values as they are. A colour outside of Rec. 709 (a negative component) is mixed with the grey
/// of its luminance until it is inside; one without luminance, or of a negative one, becomes black. The number of such
/// pixels is added to `changed`. Throws Error (reason only) naming the first pixel that is NaN, infinite or beyond
/// kLargestValue.
LuminancePicture make_luminance_picture(io::HdrImage, uint64_t* changed = nullptr);

/// Mean RGB of all texels.
glm::dvec3 mean_colour(const LuminancePicture&);
/// Luminance of the brightest texel.
double largest_luminance(const LuminancePicture&);

/// Means of luminance over parts of a picture, which repeats beyond its borders.
class PictureMeans {
public:
    explicit PictureMeans(const LuminancePicture&);
    /// Over the triangle of these texture coordinates: exact along rows, each row taken at its middle. Without an area,
    /// or over more than 64 repetitions: of the texel in the middle, or of the whole picture.
    double over(const std::array<glm::dvec2, 3>& uv) const;

private:
    double row_up_to(int64_t y, double x) const;  // integral over a row from 0 to x texels

    uint32_t width_, height_;
    std::vector<double> sums_;  // per row width + 1 sums of luminance from the left
    double mean_ = 0;
};

}  // namespace vesper::photometry
