// Opaque casters, drawn into shadow maps triangle by triangle. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/digest.h"
#include "gpu_scene/gpu_scene.h"
#include "render/frame_context.h"
#include "render/shadows/caster_parts.h"
#include "render/shadows/map_bindings.h"
#include "shared/shadow_map.h"

namespace vesper::render {

/// Whether the device has room for texel buffers of all vertices and indices of the scene.
bool has_caster_triangles(const gpu::Device& device, const gpu_scene::GpuScene& scene);

/// The step to which a device snaps vertices that it rasterizes, texels; at least 1/256, which a distance from an edge
/// in 32 bits allows.
float map_snap(const gpu::Device& device);

/// Collects casters of the quadrants of maps, and draws them.
class CasterTriangles {
public:
    /// Rows of the matrix from a mesh to the frame of a map, m: the columns of `rows`. Returns their number.
    uint32_t add_rows(const glm::mat3x4& rows);
    /// A part, for the quadrant of that number.
    void add(const gpu_scene::GpuScene::Part& part, uint32_t rows, uint32_t quadrant);
    /// Adds all casters of others, whose quadrants are numbered from `first_quadrant` on here.
    void append(const CasterTriangles& others, uint32_t first_quadrant);

    /// Draws them. `name` follows those of passes.
    void draw(const FrameContext& frame, const std::string& name, const MapTargets& to,
              const ShadowMapScratch& scratch) const;

private:
    std::vector<glm::mat3x4> rows_;
    std::vector<shared::TriangleRun> runs_;
};

/// The shaders that draw them.
void add_caster_triangle_shaders(Digest& digest);

}  // namespace vesper::render
