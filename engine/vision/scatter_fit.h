// Eye scatter by small kernels on a pyramid. SPDX-License-Identifier: MIT
// All functions use angles: pixels of a plane picture differ in size, shape and distance at its edges.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "vision/glare.h"
#include "vision/image_angles.h"

namespace vesper::vision {

/// Solid angle of the plane at a point over its area, sr: cos^3 of the angle to its middle.
double steradians_per_area(glm::dvec2 tangents);
/// Angle between two points of the plane, degrees.
double degrees_between(glm::dvec2 a, glm::dvec2 b);
/// Part of the light of a point that is scattered into a rectangle of the plane about it, from `low` (below 0) to
/// `high` beside it.
double light_within(const EyeScatter&, glm::dvec2 point, glm::dvec2 low, glm::dvec2 high);
/// Luminance at `to` for 1 cd/m^2 in a rectangle of the plane about `from`, `half` wide to either side: sr * sr^-1.
double light_from(const EyeScatter&, glm::dvec2 to, glm::dvec2 from, glm::dvec2 half);

/// Filter of the pyramid, a quartic B-spline: texel j of a level sums texels 2j - 2 .. 2j + 3 of the level below, over
/// 32; on the way back it adds to the same texels.
constexpr std::array<double, 6> kScatterFilter{1, 5, 10, 10, 5, 1};
/// Texels that each level has beyond the picture, on every side: light of a lamp less than 6 texels outside goes into
/// them.
constexpr int kScatterMargin = 9;
/// Texels beyond the picture that contribute to it.
constexpr int kScatterReach = 2;
/// Texels that kernels reach in each direction, and in wide pictures.
constexpr int kTapReach = 2, kWideTapReach = 3;

/// A level of `width` x `height` px halved (rounding up) so many times, in texels, without margin.
glm::ivec2 scatter_size(const ImageAngles&, int level);

/// The level that is the top.
int scatter_levels(const ImageAngles&);

/// Entry of off-screen light into the pyramid: a level, 1 .. the top, whose margin contains it, and its place.
struct ScatterEntry {
    int level;
    glm::dvec2 pixels, tangents;
};
/// Entry of light from a direction (view frame) at the finest possible level from `finest` on; empty if it is too far
/// or behind the plane of the eye.
std::optional<ScatterEntry> scatter_entry(const ImageAngles&, glm::dvec3 direction, int finest = 1);

/// Neighbours of a texel that its level is filtered with, each with its opposite, and the texel itself: the rest of its
/// row, then rows below. x right, y down.
std::vector<glm::ivec2> scatter_taps(int reach);

/// Texels of the top, in each direction, whose weights are fitted.
constexpr int kScatterNear = 3;

/// Between which nodes a part of the picture, 0 to 1, lies, and how far beyond the first.
struct BetweenNodes {
    int first;
    double part;
};
BetweenNodes between_nodes(double part, int nodes);

/// Rows of a level, an even number of at most `most`, over which taps may be taken as linear: no more than from node to
/// node.
int scatter_strip(const ImageAngles&, glm::ivec2 nodes, int level, int most);

/// Correction of the light that pixels near the border keep, as a part of their light: at places, row by row, linear
/// between them. Along an axis the places are the first and last `deep` pixels and `between` evenly spaced ones.
struct EdgeLight {
    /// Pixels from the border with a correction.
    static constexpr int kDeep = 8;
    struct Axis {
        int pixels = 1, deep = 0, between = 1;
        int places() const { return 2 * deep + between; }
        /// Which place a pixel is, or between which.
        double place(double pixel) const;
        /// The pixel of a place.
        int pixel(int place) const;
    };
    Axis x, y;
    std::vector<float> kept;
};

/// The operator: seen = sum over levels 0 .. levels - 1 of U^l K_l D^l + U^levels M D^levels, with small kernels K that
/// depend on the place and a full matrix M between the texels of the top; and a correction of the own light of pixels
/// near the border, so that the sum over the picture is right.
struct ScatterFit {
    ImageAngles image;
    int levels = 1;              ///< the top is this one
    int reach = kTapReach;       ///< of the kernels
    glm::ivec2 strip{1, 2};      ///< texels over which passes take taps as linear, at most (scatter_strip)
    glm::ivec2 nodes{2};         ///< places where kernels are given: columns, rows, evenly from edge to edge of
                                 ///< the picture
    std::vector<float> kernels;  ///< for each node, row by row, and each level: taps() weights
    /// For each texel of the top with kScatterReach around: the weights of all with kScatterMargin around.
    std::vector<float> top;
    EdgeLight edge;

    int taps() const { return 1 + 2 * reach * (reach + 1); }
    glm::ivec2 top_rows() const { return scatter_size(image, levels) + 2 * kScatterReach; }
    glm::ivec2 top_columns() const { return scatter_size(image, levels) + 2 * kScatterMargin; }
};

/// Fits the kernels by least squares of relative differences to the exact function, with conservation of light.
ScatterFit fit_scatter(const EyeScatter&, const ImageAngles&, glm::ivec2 strip);

}  // namespace vesper::vision
