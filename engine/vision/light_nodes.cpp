#include "vision/light_nodes.h"

#include <algorithm>

namespace vesper::vision {

LightNodes::LightNodes(const ImageAngles& image) : sizes{{image.width, image.height}}, first{0} {
    const auto texels = [&] { return uint32_t(sizes.back().x) * uint32_t(sizes.back().y); };
    while (std::max(sizes.back().x, sizes.back().y) > 2) {
        first.push_back(first.back() + texels());
        sizes.push_back(sizes.back() / 2 + 1);
    }
    first.push_back(first.back() + texels());
}

}  // namespace vesper::vision
