// Saliency of pictures on the host. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "gpu/graphics_pipeline.h"
#include "gpu/kernel_cache.h"
#include "graph/executor.h"
#include "render/host_picture.h"

namespace vesper::analysis {

/// Saliency below this is rounding: contrasts of some 1e-4 and less.
constexpr float kLeastSaliency = 1e-6f;

/// How much places of a picture draw the eye.
struct SaliencyMap {
    VkExtent2D extent{};  ///< texels
    double texel = 16;    ///< px, of the side of a texel
    /// 0 to 1, rows from the top; those of two pictures have no common scale. 0 below kLeastSaliency.
    std::vector<float> values;
    uint32_t pairs = 0;  ///< of levels that were compared, of 6: fewer in pictures of less than 256 px on a side
    std::vector<graph::Timing> timings;
};

/// Finds where pictures draw the eye (passes/saliency.h), one after the other. Not thread-safe.
class SaliencyMapper {
public:
    explicit SaliencyMapper(gpu::Device& device)
        : kernels_(device), pipelines_(device), upload_(device), executor_(device) {}

    /// The angle of the picture has no influence. Throws Error, also for pictures of less than 32 px on a side, in
    /// which there are no levels to compare.
    SaliencyMap map(const render::HostPicture& picture);

private:
    gpu::KernelCache kernels_;
    gpu::GraphicsPipelineCache pipelines_;
    render::PictureUpload upload_;
    graph::Executor executor_;  // waits for its frames, which use the members above
};

}  // namespace vesper::analysis
