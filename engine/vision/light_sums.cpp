#include "vision/light_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vesper::vision {

using glm::ivec2, glm::vec4;

LightNodes::LightNodes(const ImageAngles& image) : sizes{{image.width, image.height}}, first{0} {
    const auto texels = [&] { return uint32_t(sizes.back().x) * uint32_t(sizes.back().y); };
    while (std::max(sizes.back().x, sizes.back().y) > 2) {
        first.push_back(first.back() + texels());
        sizes.push_back(sizes.back() / 2 + 1);
    }
    first.push_back(first.back() + texels());
}

LightSums::LightSums(const ImageAngles& image)
    : nodes_(image), coarse_(nodes_.first.back() - uint32_t(image.width) * uint32_t(image.height)) {
    const glm::dvec2 size = image.pixel();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            steradians_.push_back(float(size.x * size.y * steradians_per_area(image.at(glm::dvec2(x, y) + 0.5))));
}

vec4 LightSums::pixel(size_t index) const {
    vec4 p;
    std::memcpy(&p, &rgba_[4 * index], sizeof p);
    const bool finite = std::abs(p.x + p.y + p.z) <= 3.4e38f;
    const float w = steradians_[index];
    return {finite ? w * p.x : 0, finite ? w * p.y : 0, finite ? w * p.z : 0, 0};
}

glm::vec3 LightSums::at(uint32_t node) const {
    return node < steradians_.size() ? pixel(node) : coarse_[node - steradians_.size()];
}

std::vector<glm::vec3> LightSums::at(std::span<const uint32_t> nodes) const {
    std::vector<glm::vec3> light;
    light.reserve(nodes.size());
    for (const uint32_t node : nodes) light.push_back(at(node));
    return light;
}

void LightSums::take(std::span<const float> rgba) {
    rgba_ = rgba;
    const size_t pixels = steradians_.size();
    for (size_t l = 1; l < nodes_.sizes.size(); ++l) {
        const ivec2 from = nodes_.sizes[l - 1], to = nodes_.sizes[l];
        const size_t width = size_t(from.x);
        std::vector<vec4> row(width), next(width);  // one row of nodes, whole, and the part of the row after it
        const auto add = [&](std::vector<vec4>& sum, int y, float part) {
            if (y >= from.y) return;
            const size_t begin = size_t(y) * width;
            if (l == 1)
                for (size_t x = 0; x < width; ++x) sum[x] += part * pixel(begin + x);
            else
                for (size_t x = 0; x < width; ++x) sum[x] += part * coarse_[nodes_.first[l - 1] - pixels + begin + x];
        };
        vec4* made = &coarse_[nodes_.first[l] - pixels];
        for (int y = 0; y < to.y; ++y) {
            add(row, 2 * y, 1);
            add(next, 2 * y + 1, 0.5f);
            for (size_t x = 0; x < width; ++x) row[x] += next[x];
            for (int x = 0; x < to.x; ++x) {
                const int at = 2 * x;
                *made = at < from.x ? row[size_t(at)] : vec4(0);
                if (at > 0) *made += 0.5f * row[size_t(at - 1)];
                if (at + 1 < from.x) *made += 0.5f * row[size_t(at + 1)];
                ++made;
            }
            row.swap(next);
            next.assign(width, vec4(0));
        }
    }
}

}  // namespace vesper::vision
