#include "scaled_picture.h"

#include <algorithm>
#include <cmath>

#include "print.h"

namespace vesper::apps {

uint32_t scaled(uint32_t side, double scale) { return uint32_t(std::max(1.0, std::round(side * scale))); }

ScaledPicture::ScaledPicture(VkExtent2D asked, double scale)
    : asked_(asked), rendered_{scaled(asked.width, scale), scaled(asked.height, scale)}, scale_(scale) {
    if (scale < 1) enlargement_ = std::make_shared<const eye::Projection>(eye::projection_of(rendered_, asked));
}

gpu_scene::View ScaledPicture::rendered(gpu_scene::View asked) const {
    asked.extent = rendered_;
    return asked;
}

void ScaledPicture::print_note() const {
    if (enlargement_)
        apps::print_note(format("pictures of %ux%u are rendered as %ux%u and enlarged (--scale %g)", asked_.width,
                                asked_.height, rendered_.width, rendered_.height, scale_));
}

}  // namespace vesper::apps
