// Pictures that are rendered smaller than they are shown. SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "eye/projection.h"
#include "gpu_scene/view.h"

namespace vesper::apps {

/// What is rendered of a picture, and how it is enlarged to the size asked for: its displayed light linearly between
/// pixels, so that codes alone have that size. With a scale of 1 nothing is enlarged.
class ScaledPicture {
public:
    /// Throws Error where the enlargement has no room.
    ScaledPicture(VkExtent2D asked, double scale);

    VkExtent2D rendered() const { return rendered_; }  ///< px
    /// The same view with the pixels that are rendered.
    gpu_scene::View rendered(gpu_scene::View asked) const;
    const eye::Projection* enlargement() const { return enlargement_.get(); }  ///< null: none
    /// Says on standard error that pictures are enlarged.
    void print_note() const;

private:
    VkExtent2D asked_, rendered_;
    double scale_;
    std::shared_ptr<const eye::Projection> enlargement_;
};
/// Of a side of a picture, px; at least 1.
uint32_t scaled(uint32_t side, double scale);

}  // namespace vesper::apps
