// Luminance as colours, with the scale beside it. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/image_file.h"
#include "plots/canvas.h"

namespace vesper::apps {

/// viridis (Smith and van der Walt, CC0): dark to light in steps that look even. `position` in [0, 1].
CanvasColour map_colour(double position);

/// A logarithmic scale.
struct ColourScale {
    double low = 0.1, high = 10;
    double position(double value) const;  ///< in [0, 1], clamped
};
/// One that begins at the 1st percentile of the positive values, ends at the 99.9th, both rounded to 1, 2 or 5, and
/// spans at least one decade and at most eight.
ColourScale scale_of(std::span<const float> values);

/// A picture of one value per pixel.
struct ValuePicture {
    uint32_t width = 0, height = 0;
    std::vector<float> values;
};
/// Means of blocks where the picture is larger than the size wanted, repeated pixels where it is smaller; blocks with a
/// value that is not finite are not finite.
ValuePicture resized(const ValuePicture&, uint32_t width, uint32_t height);
/// 32-bit OpenEXR of the values in R, G and B alike; `meaning` is its attribute vesper:unit. The file is replaced only
/// when complete. Throws Error.
void save_values(const std::string& file, const ValuePicture&, const std::string& meaning);

/// RGBA: map_colour of each value; black for 0 and less, magenta for what is not finite.
std::vector<uint8_t> false_colours(const ValuePicture&, const ColourScale&);

/// RGBA of a picture in dim greys, by the logarithm of its values, with a colour over each pixel of a strength from 0
/// to
/// 1. Values that are not finite are black.
struct Tint {
    CanvasColour colour;
    double strength = 0;
};
std::vector<uint8_t> tinted(const ValuePicture&, const std::function<Tint(size_t pixel)>&);

/// Where the picture goes through any of the levels, white, over a picture at a corner; not along the edges of black.
void draw_contours(Canvas&, const ValuePicture&, std::span<const double> levels, glm::dvec2 corner);

/// A bar of the scale, `height` px high, with labelled ticks on its right, 90 px wide in all; `unit` above it.
constexpr double kBarWidth = 90;
void draw_colour_bar(Canvas&, glm::dvec2 corner, double height, const ColourScale&, const std::string& unit);

}  // namespace vesper::apps
