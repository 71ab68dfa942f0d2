// Diagrams of measured lamps. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "photometry/beam.h"
#include "plots/canvas.h"

namespace vesper::commands {

/// Two diagrams side by side, in cd. Type C: polar in the planes C0-180, C90-270 and that of the greatest intensity;
/// gamma over C in false colours with lines of equal intensity. Types A and B: cuts along H and V through the greatest
/// intensity; V over H, with the points of UN R112 where the grid holds them.
void draw_distribution(apps::Canvas&, const photometry::Distribution&, const photometry::BeamFigures&);
constexpr uint32_t kPlotWidth = 1360, kPlotHeight = 700;

}  // namespace vesper::commands
