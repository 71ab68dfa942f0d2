// Values of textures on the host, as in pictures at close view. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace vesper::rays {

/// A place on an axis of a texture in texels, within the texture (repeated or mirrored: within one turn).
inline double turned(double place, uint32_t size, scene::Wrap wrap) {
    if (wrap == scene::Wrap::Clamp) return std::clamp(place, 0.0, 1.0) * size;
    const double turn = wrap == scene::Wrap::Mirror ? 2 : 1;
    return (place - turn * std::floor(place / turn)) * size;
}

/// The texel of an index, which may lie outside of the texture by one turn.
inline uint32_t texel(double index, uint32_t size, scene::Wrap wrap) {
    const auto last = int64_t(size) - 1;
    int64_t i = int64_t(index);
    if (wrap == scene::Wrap::Clamp) return uint32_t(std::clamp<int64_t>(i, 0, last));
    const int64_t turn = wrap == scene::Wrap::Mirror ? 2 * int64_t(size) : int64_t(size);
    i += i < 0 ? turn : i >= turn ? -turn : 0;
    return uint32_t(std::min(i <= last ? i : turn - 1 - i, last));
}

/// A texture of `size` texels at finite coordinates: between texels linear, unless it says nearest. `value_of`: of the
/// texel with an index, rows from the top.
template <class ValueOf>
auto texture_at(glm::uvec2 size, const scene::TextureUse& use, glm::dvec2 uv, ValueOf value_of) {
    const glm::dvec2 place(turned(uv.x, size.x, use.wrap_u), turned(uv.y, size.y, use.wrap_v));
    const auto value = [&](double x, double y) {
        const size_t column = texel(x, size.x, use.wrap_u), row = texel(y, size.y, use.wrap_v);
        return value_of(row * size.x + column);
    };
    if (use.nearest) return value(std::floor(place.x), std::floor(place.y));
    const glm::dvec2 corner = glm::floor(place - 0.5), share = place - 0.5 - corner;
    return glm::mix(glm::mix(value(corner.x, corner.y), value(corner.x + 1, corner.y), share.x),
                    glm::mix(value(corner.x, corner.y + 1), value(corner.x + 1, corner.y + 1), share.x), share.y);
}

}  // namespace vesper::rays
