// Measured intensities and road surfaces as the shaders read them. SPDX-License-Identifier: MIT
// One texel buffer of rgba32f holds them all. A texel is a cell of a grid: the values at its four corners (low, low),
// (high, low), (low, high), (high, high) of the first and the second coordinate; cells are stored row by row of the first.
#ifndef VESPER_SHARED_MAPS_H
#define VESPER_SHARED_MAPS_H
#include "types.h"
SHARED_BEGIN

// Intensities relative to the largest, over azimuth about the pole of the measurement and the angle from that pole, with
// one more cell before and behind in either direction: what lies outside the measured range. See Light.

// The largest relative intensity of some rings about the axis, for a culling that may not lose anything: ring k has angles a with
// sin(a / 2) * kEnvelope from k to k + 1, and texel k of row l is for the 2^l rings from k on.
const uint kEnvelope = 64u, kEnvelopeRows = 7u;

// r x 1e4 (sr^-1) of a road surface over tan(gamma), 0 to that of the table's last row, and beta, a degree a cell; the nodes
// of the standard tables are among its own. Before the cells one texel: cells per unit of tan(gamma), and the last
// tan(gamma).
const uint kRoadTanCells = 48u;
const uint kRoadBetaCells = 180u;

SHARED_END
#endif
