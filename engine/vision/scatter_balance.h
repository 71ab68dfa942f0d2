// Energy conservation of the glare pyramid. SPDX-License-Identifier: MIT
#pragma once

#include "vision/scatter_fit.h"

namespace vesper::vision {

/// Makes the light that the picture receives from each pixel equal to that of the function, within a few parts in 1e4:
/// changes the taps of the pixel itself at the nodes, and sets fit.edge.
void conserve_light(const EyeScatter&, ScatterFit& fit);

}  // namespace vesper::vision
