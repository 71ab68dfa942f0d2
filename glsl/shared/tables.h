// Measured intensities and road surfaces as the shaders read them. SPDX-License-Identifier: MIT
// One texel buffer of rgba32f holds them all. A texel is a cell of a grid: the values at its four corners (low, low),
// (high, low), (low, high), (high, high) of the first and the second coordinate; cells are stored row by row of the first.
#ifndef VESPER_SHARED_TABLES_H
#define VESPER_SHARED_TABLES_H
#include "types.h"
SHARED_BEGIN

// Intensities relative to the largest, over azimuth about the pole of the measurement and the angle from that pole, with
// one more cell before and behind in either direction: what lies outside the measured range. See Lamp.

// Before the cells stand bounds, for a culling that may not lose anything: the largest relative intensity in windows of directions. Ring k of
// kRings has angles a from the pole with sin(a / 2) * kRings from k to k + 1; azimuth from -pi is cut into kSectors equal bins, which go on
// around. A window is some rings by some sectors. Along either, of N bins, there are windows of 1, 2, 4 .. N bins; those of 2^l bins begin
// every max(2^l / 2, 1) bins, and the first of them is window 3 N - 4 N / 2^l (0 for l = 0). Windows 3 N - 2 and 3 N - 1 hold all. Ring window i by
// sector window j is value 3 kSectors i + j, four values to a texel.
const uint kRings = 64u, kSectors = 32u;
const uint kWindowTexels = 3u * kRings * 3u * kSectors / 4u;

// r / Qd of a road surface over tan(gamma), 0 to that of the table's last row, and beta, 0 to 180 degrees: as many cells as it takes for
// the table's nodes to be among theirs; at most kMostRoadCells, of which a node that is none of theirs lies half a cell off. A table has one texel as
// its head: cells per unit of tan(gamma), the last tan(gamma), cells of beta per rad, and the texel of its first cell. Heads stand side by side.
const uvec2 kMostRoadCells = uvec2(960u, 1800u);

SHARED_END
#endif
