// Numbers out of glTF accessors (specification 2.0, sections 3.6.2 and 5.1). SPDX-License-Identifier: MIT
#include "scene/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace vesper {
namespace {

enum class Component : uint16_t { Byte = 5120, UByte = 5121, Short = 5122, UShort = 5123, UInt = 5125, Float = 5126 };

Component component_of(const JsonValue& holder) {
    const JsonValue type = holder.at("componentType");
    switch (type.integer()) {
        case 5120:
            return Component::Byte;
        case 5121:
            return Component::UByte;
        case 5122:
            return Component::Short;
        case 5123:
            return Component::UShort;
        case 5125:
            return Component::UInt;
        case 5126:
            return Component::Float;
        default:
            type.fail("is no component type of glTF");
    }
}

uint32_t size_of(Component component) {
    switch (component) {
        case Component::Byte:
        case Component::UByte:
            return 1;
        case Component::Short:
        case Component::UShort:
            return 2;
        default:
            return 4;
    }
}

uint32_t components_of(const JsonValue& type) {
    static constexpr std::pair<std::string_view, uint32_t> kTypes[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, count] : kTypes)
        if (type.text() == name) return count;
    type.fail("is no accessor type of glTF");
}

/// Elements lying in a buffer view: checked, so that any of `count` may be read. Addresses need not be aligned.
struct Elements {
    const uint8_t* bytes = nullptr;
    uint64_t stride = 0;
    const uint8_t* at(uint64_t i) const { return bytes + i * stride; }
};

Elements elements_in(GltfDocument& document, const JsonValue& holder, uint64_t count, uint32_t element_size) {
    const JsonValue reference = holder.at("bufferView");
    const JsonValue view = document.element("bufferViews", reference);
    const auto bytes = document.view(reference.index(UINT32_MAX, "bufferViews"));
    const uint64_t offset = holder.integer_or("byteOffset", 0);
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

float load_float(const uint8_t* bytes, Component component, bool normalized) {
    switch (component) {
        case Component::Byte: {
            const float value = load<int8_t>(bytes);
            return normalized ? std::max(value / 127.f, -1.f) : value;
        }
        case Component::UByte:
            return static_cast<float>(*bytes) / (normalized ? 255.f : 1.f);
        case Component::Short: {
            const float value = load<int16_t>(bytes);
            return normalized ? std::max(value / 32767.f, -1.f) : value;
        }
        case Component::UShort:
            return static_cast<float>(load<uint16_t>(bytes)) / (normalized ? 65535.f : 1.f);
        case Component::UInt: {
            const double value = load<uint32_t>(bytes);
            return static_cast<float>(normalized ? value / 4294967295.0 : value);
        }
        case Component::Float:
            return load<float>(bytes);
    }
    return 0;
}

uint32_t load_unsigned(const uint8_t* bytes, Component component) {
    if (component == Component::UByte) return *bytes;
    return component == Component::UShort ? load<uint16_t>(bytes) : load<uint32_t>(bytes);
}

Component index_component_of(const JsonValue& holder) {
    const Component component = component_of(holder);
    if (component != Component::UByte && component != Component::UShort && component != Component::UInt)
        holder.at("componentType").fail("indices must be of an unsigned integer type");
    return component;
}

/// What dense and sparse accessors, of numbers and of indices, have in common: `store(element, bytes)` for each.
template <class Store>
void for_each_element(GltfDocument& document, const JsonValue& accessor, uint64_t count, uint32_t size, Store store) {
    if (accessor.find("bufferView")) {
        const Elements dense = elements_in(document, accessor, count, size);
        for (uint64_t i = 0; i < count; ++i) store(i, dense.at(i));
    }
    const auto sparse = accessor.find("sparse");
    if (!sparse) return;
    const uint64_t changed = sparse->at("count").integer();
    if (changed > count) sparse->fail("changes more elements than the accessor has");
    const JsonValue where = sparse->at("indices"), what = sparse->at("values");
    const Component type = index_component_of(where);
    const Elements indices = elements_in(document, where, changed, size_of(type));
    const Elements values = elements_in(document, what, changed, size);
    for (uint64_t i = 0; i < changed; ++i) {
        const uint32_t element = load_unsigned(indices.at(i), type);
        if (element >= count)
            sparse->fail("changes element " + std::to_string(element) + " of " + std::to_string(count));
        store(element, values.at(i));
    }
}

uint64_t bounded_count(const JsonValue& accessor, uint64_t max_count) {
    const JsonValue stated = accessor.at("count");
    const uint64_t count = stated.integer();
    if (count == 0) stated.fail("must be at least 1");
    if (count > max_count || count >= UINT32_MAX)
        stated.fail(std::to_string(count) + " elements are more than the limit of " + std::to_string(max_count) +
                    " allows");
    return count;
}

}  // namespace

uint64_t accessor_count(GltfDocument& document, const JsonValue& reference) {
    return document.element("accessors", reference).at("count").integer();
}

Floats read_floats(GltfDocument& document, const JsonValue& reference, std::initializer_list<std::string_view> types,
                   uint64_t max_count) {
    const JsonValue accessor = document.element("accessors", reference);
    const JsonValue type = accessor.at("type");
    if (std::find(types.begin(), types.end(), type.text()) == types.end())
        type.fail("type " + type.text() + " does not fit this use");
    const Component component = component_of(accessor);
    const bool normalized = accessor.boolean_or("normalized", false);
    Floats floats;
    floats.components = components_of(type);
    floats.count = static_cast<uint32_t>(bounded_count(accessor, max_count));
    const uint32_t step = size_of(component), size = step * floats.components;
    // Zeros, as specified, where there is no buffer view. Ranges are checked before memory is taken for them.
    if (accessor.find("bufferView"))
        elements_in(document, accessor, floats.count, size);
    else
        document.take_unwritten(accessor, floats.count);
    floats.values.resize(static_cast<size_t>(floats.count) * floats.components);
    for_each_element(document, accessor, floats.count, size, [&](uint64_t i, const uint8_t* bytes) {
        for (uint32_t c = 0; c < floats.components; ++c)
            floats.values[i * floats.components + c] = load_float(bytes + c * step, component, normalized);
    });
    return floats;
}

std::vector<uint32_t> read_indices(GltfDocument& document, const JsonValue& reference, uint64_t max_count,
                                   uint64_t end) {
    const JsonValue accessor = document.element("accessors", reference);
    if (accessor.at("type").text() != "SCALAR") accessor.at("type").fail("indices must be of type SCALAR");
    const Component component = index_component_of(accessor);
    const uint64_t count = bounded_count(accessor, max_count);
    if (accessor.find("bufferView"))
        elements_in(document, accessor, count, size_of(component));
    else
        document.take_unwritten(accessor, count);
    std::vector<uint32_t> indices(count);
    for_each_element(document, accessor, count, size_of(component),
                     [&](uint64_t i, const uint8_t* bytes) { indices[i] = load_unsigned(bytes, component); });
    for (uint64_t i = 0; i < count; ++i)
        if (indices[i] >= end)
            accessor.fail("index " + std::to_string(indices[i]) + " at position " + std::to_string(i) +
                          ": there are only " + std::to_string(end) + " vertices");
    return indices;
}

}  // namespace vesper
