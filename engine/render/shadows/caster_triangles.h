// Opaque casters, drawn into shadow maps triangle by triangle. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/digest.h"
#include "gpu_scene/gpu_scene.h"
#include "render/frame_context.h"
#include "render/shadows/caster_parts.h"
#include "shared/shadow_map.h"

namespace vesper::render {

/// Whether the device has room for texel buffers of all vertices and indices of the scene.
bool has_caster_triangles(const gpu::Device& device, const gpu_scene::GpuScene& scene);

/// The step to which vertices are snapped in maps, texels: at most 1/16. 1/256 where it is finer.
float map_snap(const gpu::Device& device);

/// The opaque casters of an image: runs of triangles in quadrants.
class CasterTriangles {
public:
    void add_quadrant(const shared::MapQuadrant& quadrant);
    uint32_t quadrants() const { return uint32_t(quadrants_.size()); }
    /// The number of the rows of a matrix from a mesh to the frame of a map, m, for add().
    uint32_t add_rows(const glm::mat4& rows);
    /// All triangles of a part.
    void add(const gpu_scene::GpuScene::Part& part, uint32_t rows, uint32_t quadrant);

    /// Draws into a depth image, and small triangles into words of a buffer, a float for each of its texels: kMapNear
    /// over the distance, where that is more than is there.
    struct Image {
        std::string name;  ///< of what is uploaded for it
        graph::Resource depth, small;
    };
    void draw(const FrameContext& frame, const Image& image, const ShadowMapScratch& scratch) const;

private:
    // Of one dispatch, in the order of quadrants.
    void dispatch(const FrameContext& frame, const Image& image, const ShadowMapScratch& scratch) const;

    std::vector<shared::MapQuadrant> quadrants_;
    std::vector<glm::mat3x4> rows_;
    std::vector<shared::TriangleRun> runs_;
};

/// The shaders that draw them.
void add_caster_triangle_shaders(Digest& digest);

}  // namespace vesper::render
