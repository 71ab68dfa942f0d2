// Numbers out of glTF accessors (specification 2.0, sections 3.6.2 and 5.1). SPDX-License-Identifier: MIT
#include "scene/gltf_accessor.h"
#include "base/budget.h"

#include <algorithm>
#include <cstring>

namespace vesper::scene {
namespace {

/// A component type that glTF has, or its refusal. `holder` states it.
int checked_component(const JsonValue& holder, int type) {
    if (type < TINYGLTF_COMPONENT_TYPE_BYTE || type > TINYGLTF_COMPONENT_TYPE_FLOAT ||
        type == TINYGLTF_COMPONENT_TYPE_INT)
        holder.at("componentType").fail("is no component type of glTF");
    return type;
}

uint32_t size_of(int component) {
    return static_cast<uint32_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(component)));
}

/// Elements lying in a buffer view: checked, so that any of `count` may be read. Addresses need not be aligned.
struct Elements {
    const uint8_t* bytes = nullptr;
    uint64_t stride = 0;
    const uint8_t* at(uint64_t i) const { return bytes + i * stride; }
};

/// `holder` is what names the buffer view: an accessor or a part of a sparse one.
Elements elements_in(GltfDocument& document, const JsonValue& holder, int number, uint64_t offset, uint64_t count,
                     uint32_t element_size) {
    const JsonValue view = document.list("bufferViews")[static_cast<size_t>(number)];
    const auto bytes = document.view(static_cast<uint32_t>(number));
    const uint64_t stride = view.integer_or("byteStride", element_size, 1u << 16);
    if (stride < element_size)
        view.fail("byteStride " + std::to_string(stride) + " is less than the " + std::to_string(element_size) +
                  " bytes of an element");
    // count * stride cannot overflow: both are below 2^32 here.
    if (count > UINT32_MAX || offset > bytes.size() ||
        (count > 0 && (count - 1) * stride + element_size > bytes.size() - offset))
        holder.fail("reaches beyond its buffer view of " + std::to_string(bytes.size()) + " bytes");
    return {bytes.data() + offset, stride};
}

template <class T>
T load(const uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

float load_float(const uint8_t* bytes, int component, bool normalized) {
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const float value = load<int8_t>(bytes);
            return normalized ? std::max(value / 127.f, -1.f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return static_cast<float>(*bytes) / (normalized ? 255.f : 1.f);
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const float value = load<int16_t>(bytes);
            return normalized ? std::max(value / 32767.f, -1.f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return static_cast<float>(load<uint16_t>(bytes)) / (normalized ? 65535.f : 1.f);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
            const double value = load<uint32_t>(bytes);
            return static_cast<float>(normalized ? value / 4294967295.0 : value);
        }
        default:
            return load<float>(bytes);
    }
}

uint32_t load_unsigned(const uint8_t* bytes, int component) {
    if (component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *bytes;
    return component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? load<uint16_t>(bytes) : load<uint32_t>(bytes);
}

int index_component(const JsonValue& holder, int type) {
    const int component = checked_component(holder, type);
    if (component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        component != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        holder.at("componentType").fail("indices must be of an unsigned integer type");
    return component;
}

/// Checks ranges before memory is taken for the elements. Zeros, as specified, where there is no buffer view.
void check_range(GltfDocument& document, const GltfPart<tinygltf::Accessor>& accessor, uint32_t size) {
    if (accessor->bufferView >= 0)
        elements_in(document, accessor.json, accessor->bufferView, accessor->byteOffset, accessor->count, size);
    else
        document.take_unwritten(accessor.json, accessor->count);
}

/// What dense and sparse accessors, of numbers and of indices, have in common: `store(element, bytes)` for each.
template <class Store>
void for_each_element(GltfDocument& document, const GltfPart<tinygltf::Accessor>& accessor, uint32_t size,
                      Store store) {
    const uint64_t count = accessor->count;
    if (accessor->bufferView >= 0) {
        const Elements dense =
            elements_in(document, accessor.json, accessor->bufferView, accessor->byteOffset, count, size);
        for (uint64_t i = 0; i < count; ++i) {
            check_time();
            store(i, dense.at(i));
        }
    }
    if (!accessor->sparse.isSparse) return;
    const auto& [changed, is_sparse, where, what] = accessor->sparse;
    const JsonValue sparse = accessor.json.at("sparse");
    if (static_cast<uint64_t>(changed) > count) sparse.fail("changes more elements than the accessor has");
    const int type = index_component(sparse.at("indices"), where.componentType);
    const auto elements = static_cast<uint64_t>(changed);
    const Elements indices = elements_in(document, sparse.at("indices"), where.bufferView,
                                         static_cast<uint64_t>(where.byteOffset), elements, size_of(type));
    const Elements values = elements_in(document, sparse.at("values"), what.bufferView,
                                        static_cast<uint64_t>(what.byteOffset), elements, size);
    for (uint64_t i = 0; i < elements; ++i) {
        const uint32_t element = load_unsigned(indices.at(i), type);
        if (element >= count)
            sparse.fail("changes element " + std::to_string(element) + " of " + std::to_string(count));
        store(element, values.at(i));
    }
}

void check_count(const GltfPart<tinygltf::Accessor>& accessor, uint64_t max_count) {
    const uint64_t count = accessor->count;
    if (count == 0) accessor.json.at("count").fail("must be at least 1");
    if (count > max_count || count >= UINT32_MAX)
        accessor.json.at("count").fail(std::to_string(count) + " elements are more than the limit of " +
                                       std::to_string(max_count) + " allows");
}

}  // namespace

Floats read_floats(GltfDocument& document, int index, std::initializer_list<int> types, uint64_t max_count) {
    const auto accessor = document.accessor(static_cast<size_t>(index));
    if (std::find(types.begin(), types.end(), accessor->type) == types.end()) {
        const JsonValue type = accessor.json.at("type");
        type.fail("type " + type.text() + " does not fit this use");
    }
    const int component = checked_component(accessor.json, accessor->componentType);
    check_count(accessor, max_count);
    Floats floats;
    floats.components = static_cast<uint32_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor->type)));
    floats.count = static_cast<uint32_t>(accessor->count);
    const uint32_t step = size_of(component), size = step * floats.components;
    check_range(document, accessor, size);
    const TemporaryMemory of_values(uint64_t{floats.count} * floats.components * sizeof(float));
    floats.values.resize(static_cast<size_t>(floats.count) * floats.components);
    for_each_element(document, accessor, size, [&](uint64_t i, const uint8_t* bytes) {
        for (uint32_t c = 0; c < floats.components; ++c)
            floats.values[i * floats.components + c] = load_float(bytes + c * step, component, accessor->normalized);
    });
    return floats;
}

std::vector<uint32_t> read_indices(GltfDocument& document, int index, uint64_t max_count, uint64_t end) {
    const auto accessor = document.accessor(static_cast<size_t>(index));
    if (accessor->type != TINYGLTF_TYPE_SCALAR) accessor.json.at("type").fail("indices must be of type SCALAR");
    const int component = index_component(accessor.json, accessor->componentType);
    check_count(accessor, max_count);
    check_range(document, accessor, size_of(component));
    std::vector<uint32_t> indices(accessor->count);
    for_each_element(document, accessor, size_of(component),
                     [&](uint64_t i, const uint8_t* bytes) { indices[i] = load_unsigned(bytes, component); });
    for (uint64_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= end)
            accessor.json.fail("index " + std::to_string(indices[i]) + " at position " + std::to_string(i) +
                               ": there are only " + std::to_string(end) + " vertices");
    return indices;
}

}  // namespace vesper::scene
