// Numbers out of glTF accessors. SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>

#include "scene/gltf_document.h"

namespace vesper::scene {

/// An accessor turned to floats: `count` elements of `components` each.
struct Floats {
    uint32_t components = 0, count = 0;
    std::vector<float> values;

    std::span<const float> operator[](size_t i) const { return std::span(values).subspan(i * components, components); }
};

/// Reads the accessor `index`, of any component type, normalized or not, strided, sparse. `types`: those allowed, as
/// TINYGLTF_TYPE_VEC3. At most `max_count` elements. Values may be non-finite: the caller knows whether that is a
/// fault. Throws Error.
Floats read_floats(GltfDocument& document, int index, std::initializer_list<int> types, uint64_t max_count);

/// Reads unsigned scalars, all less than `end`. Throws Error.
std::vector<uint32_t> read_indices(GltfDocument& document, int index, uint64_t max_count, uint64_t end);

}  // namespace vesper::scene
