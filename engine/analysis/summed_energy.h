// Energy of contrast, summed over the area that an eye sums over. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "analysis/visual_channels.h"

namespace vesper::analysis {

/// At each sample of `grid`, row by row, the mean of `energies` with the weight exp(-pi r^2 / area) / area at distance
/// r in degrees: 1 where they are 1 everywhere. The envelope exp(-r^2 / (2 sigma^2)) of a contrast c has the energy
/// c^2 / (1 + area / (pi sigma^2)) in its middle, which is Barten's sum of 1 / areas (1999, equation 3.20) for its
/// area pi sigma^2. Beyond the grid energies are 0. `area` in deg^2, above 0.
std::vector<double> summed_energies(std::span<const double> energies, const ChannelGrid& grid, double pixels_per_degree,
                                    double area);

}  // namespace vesper::analysis
