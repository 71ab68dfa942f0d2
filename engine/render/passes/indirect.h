// Light of emitting surfaces and of the sky, and reflected light. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/gbuffer.h"
#include "transport/cell_grid.h"

namespace vesper::render {

/// Illuminance of surfaces on the device.
struct IndirectCells {
    graph::Resource texels;    ///< rgba32ui, as shared/indirect.h says; none: there is no such light
    uint32_t log2_places = 1;  ///< of the table
    transport::CellGrid grid;
    glm::vec3 sky_above{0}, sky_below{0};  ///< where no cell is near: on surfaces that face up and down, lx
};

/// Adds that light, and that of what moves (add_moving_light), to shaded luminance, in place: E rho lambert. Without
/// cells returns `scene`.
graph::Resource add_indirect(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                             const IndirectCells& cells, graph::Resource moving_light, float lambert);

/// The same light where it is known for each pixel: an image of its illuminance, rgba32f, RGB lx. Without one returns
/// `scene`.
graph::Resource add_illuminance(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                                graph::Resource illuminance, float lambert);

}  // namespace vesper::render
