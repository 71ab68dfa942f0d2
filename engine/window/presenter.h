// Draws a picture and what lies over it into a window. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/descriptors.h"
#include "gpu/graphics_pipeline.h"
#include "gpu/memory.h"
#include "graph/frame_graph.h"
#include "window/swapchain.h"

namespace vesper::window {

/// Display codes, 4 bytes a pixel from the top left: RGBA, or words of A2B10G10R10. On the host, or in an image on the
/// device, of such a format in UNORM, that can be sampled in its layout VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL.
struct Picture {
    std::span<const uint8_t> codes;
    VkExtent2D extent{};
    uint32_t bits = 8;
    VkImageView image = VK_NULL_HANDLE;  ///< if it is not null, in place of `codes`
};

/// An image that frames are shown in (render::Outputs::shown) and a presenter draws, in the order in which both are
/// handed to the queue.
class PictureImage {
public:
    explicit PictureImage(gpu::Device& device) : device_(device) {}

    /// Where the next frame goes. Waits for the device where extent or bits change. Throws Error.
    graph::ExternalImage target(VkExtent2D extent, uint32_t bits);
    /// The picture of that frame.
    Picture picture() const { return {.codes = {}, .extent = extent_, .bits = bits_, .image = view_.get()}; }

private:
    gpu::Device& device_;
    VkExtent2D extent_{0, 0};
    uint32_t bits_ = 0;
    std::optional<gpu::Arena> arena_;
    gpu::OwnedImage image_;
    gpu::OwnedImageView view_;
};

/// How a picture of one size is shown in a window of another. What is left is black.
enum class Scaling : uint8_t {
    Fit,    ///< as large as the window allows, filtered
    Whole,  ///< enlarged a whole number of times, without a filter; where it does not fit even once, as Fit
};

/// Where a picture lies in a window, px. `times` is 1 or more where pixels are repeated whole, 0 where they are
/// filtered.
struct Placement {
    VkRect2D area{};
    uint32_t times = 0;
};
Placement place(VkExtent2D picture, VkExtent2D window, Scaling);

/// Triangles over the picture, in px of the window.
struct Overlay {
    struct Vertex {
        glm::vec2 position, uv;  ///< px of the window; of the coverage, [0, 1]
        uint32_t colour;         ///< RGBA, sRGB codes, red in the lowest bits; not premultiplied
    };
    struct Batch {
        uint32_t first_index, indices;
        VkRect2D clip;  ///< from an offset that is not negative
    };
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<Batch> batches;
};

/// Draws into the images of a swapchain, or of any other colour attachment.
class Presenter {
public:
    /// `coverage` is what overlays take their letters from: a byte a texel.
    Presenter(gpu::Device&, VkExtent2D coverage_extent, std::span<const uint8_t> coverage);
    ~Presenter();  ///< waits for what was drawn
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    /// White of overlays in a HDR10 window, cd/m^2: graphics white of ITU-R BT.2408.
    static constexpr float kOverlayWhite = 203;

    /// Copies what is shown of the host, so none of it is needed afterwards. Throws Error.
    void draw(VkCommandBuffer, const WindowImage&, const Picture&, Scaling, const Overlay&);

private:
    struct Slot {
        gpu::HostBuffer words, vertices, indices;
        gpu::OwnedBufferView texels;
        std::optional<gpu::Descriptors> descriptors;
    };
    void upload_coverage(VkExtent2D, std::span<const uint8_t>);
    void draw_picture(VkCommandBuffer, const WindowImage&, const Picture&, Scaling, Slot&);
    void upload(const Picture&, Slot&) const;
    void draw_overlay(VkCommandBuffer, const WindowImage&, const Overlay&, Slot&);

    gpu::Device& device_;
    gpu::GraphicsPipelineCache pipelines_;
    gpu::Arena arena_;
    gpu::OwnedImage coverage_;
    gpu::OwnedImageView coverage_view_;
    gpu::OwnedSampler sampler_;
    std::array<Slot, Swapchain::kSlots> slots_;
};

}  // namespace vesper::window
