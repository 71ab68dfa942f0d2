// Holds the pyramid of glare to the light there is. SPDX-License-Identifier: MIT
#pragma once

#include "vision/scatter_fit.h"

namespace vesper {

/// Makes what the picture has of the light of each pixel that of the function, within a few parts in 1e4: what each keeps of
/// its own is changed at the nodes, and fit.edge is set.
void conserve_light(const EyeScatter&, ScatterFit& fit);

}  // namespace vesper
