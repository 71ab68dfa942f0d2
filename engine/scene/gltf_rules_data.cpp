// Rules of glTF 2.0 for accessors and for the numbers that they hold. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "scene/gltf_reader.h"
#include "scene/gltf_rules.h"

namespace vesper {
namespace {

using nlohmann::json;

constexpr uint64_t kMostNumbers = 1'000'000;  // of all accessors, that are compared with what is stated of them: large files are read once only

uint64_t size_of(uint64_t component_type) {
    switch (component_type) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

class Accessors {
public:
    Accessors(GltfReader& reader, const GltfLists& lists, const std::vector<AccessorUse>& uses, const RuleNote& note) : reader_(reader), lists_(lists), uses_(uses), note_(note) {}

    void check() {
        lists_.each("accessors", [&](const json& a, const std::string& at, uint32_t i) { accessor(a, at, i); });
        for (const uint32_t accessor : reader_.scaled_normals) note_("/accessors/" + std::to_string(accessor), "holds normals that are not of length 1: they are made so");
    }

private:
    void accessor(const json& a, const std::string& at, uint32_t index) {
        static const std::map<std::string, uint64_t> kColumns{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 2}, {"MAT3", 3}, {"MAT4", 4}};
        const uint64_t component = whole_member(a, "componentType"), elements = whole_member(a, "count"), size = size_of(component);
        const auto type = kColumns.find(a.contains("type") && a["type"].is_string() ? a["type"].get<std::string>() : "");
        if (size == 0 || type == kColumns.end()) return;  // noted as missing, or refused where it is read
        const bool matrix = type->first.starts_with("MAT");
        if (true_member(a, "normalized") && (component == 5125 || component == 5126)) note_(at, "is normalized, which numbers of its type cannot be");
        const uint64_t components = matrix ? type->second * type->second : type->second;
        for (const char* key : {"min", "max"})
            if (a.contains(key) && array_member(a, key).size() != components) note_(at + "/" + key, "has not " + std::to_string(components) + " numbers");
        sparse(a, at + "/sparse", elements);
        const json* view = lists_.named(a, "bufferView", "bufferViews");
        if (!view) return;
        // Columns of matrices begin at multiples of four.
        const uint64_t column = type->second * size, padded = matrix ? (column + 3) / 4 * 4 * type->second : column;
        const uint64_t offset = whole_member(a, "byteOffset"), stride = whole_member(*view, "byteStride", padded), bytes = whole_member(*view, "byteLength");
        if (offset % (matrix ? 4 : size) != 0 || (offset + whole_member(*view, "byteOffset")) % size != 0) note_(at, "does not begin at a multiple of the size of its numbers");
        if (stride < padded) note_(at, "lies in a buffer view with a stride of " + std::to_string(stride) + " bytes");
        if (elements > 0 && elements < UINT32_MAX && stride <= UINT32_MAX && offset <= bytes && (elements - 1) * stride + padded - (matrix ? (4 - column % 4) % 4 : 0) > bytes - offset) note_(at, "reaches beyond its buffer view");
        if (padded == components * size && has_bytes(*view)) numbers(a, at, index, type->first, elements * components);
    }

    bool has_bytes(const json& view) {
        const uint64_t buffer = whole_member(view, "buffer", UINT64_MAX);
        return buffer < lists_.count("buffers") && reader_.document.has_bytes(uint32_t(buffer));
    }

    void sparse(const json& a, const std::string& at, uint64_t elements) {
        if (!a.contains("sparse") || !a["sparse"].is_object()) return;
        const json& sparse = a["sparse"];
        const uint64_t changed = whole_member(sparse, "count");
        if (changed > elements) note_(at + "/count", "is more than the " + std::to_string(elements) + " elements there are");
        for (const char* part : {"indices", "values"})
            if (const json* view = lists_.named(object_member(sparse, part), "bufferView", "bufferViews"); view && view->contains("byteStride")) note_(at + "/" + part, "lies in a buffer view with a stride");
        // Indices ascend.
        const json& indices = object_member(sparse, "indices");
        const json* view = lists_.named(indices, "bufferView", "bufferViews");
        const uint64_t size = size_of(whole_member(indices, "componentType")), offset = whole_member(indices, "byteOffset");
        if (!view || !has_bytes(*view) || size == 0 || !take(changed)) return;
        const auto bytes = reader_.document.view(static_cast<uint32_t>(whole_member(indices, "bufferView")));
        if (offset > bytes.size() || changed > (bytes.size() - offset) / size) return note_(at + "/indices", "reach beyond their buffer view");
        uint64_t last = 0;
        for (uint64_t i = 0; i < changed; ++i) {
            uint64_t index = 0;
            for (uint64_t b = 0; b < size; ++b) index |= uint64_t(bytes[offset + i * size + b]) << 8 * b;
            if (index >= elements) return note_(at + "/indices", "name elements that there are not");
            if (i > 0 && index <= last) return note_(at + "/indices", "do not ascend");
            last = index;
        }
    }

    bool take(uint64_t numbers) { return numbers <= kMostNumbers && (numbers_ += numbers) <= kMostNumbers; }

    // What is stated of the numbers of an accessor, and what they have to be by their use. Normals were looked at as they were read.
    void numbers(const json& a, const std::string& at, uint32_t index, const std::string& type, uint64_t count) {
        if (!take(count)) return;
        const JsonFile reference{"", json(index)};
        const auto read = [&](Numbers numbers) { return read_floats(reader_.document, JsonValue(reference), {type}, kMostNumbers, numbers); };
        try {
            const Floats floats = read(Numbers::Meant);
            for (const float value : floats.values)
                if (!std::isfinite(value)) return note_(at, "holds numbers that are not finite");
            if (a.contains("min") || a.contains("max")) limits(a, at, true_member(a, "normalized") ? read(Numbers::Stored) : floats);
            const AccessorUse& use = uses_[index];
            if (use.kind == AccessorUse::Kind::KeyTimes && floats.components == 1) times(floats, at);
            if (use.kind == AccessorUse::Kind::Matrices && floats.components == 16) matrices(floats, at);
            if (use.kind == AccessorUse::Kind::Indices && floats.components == 1) indices(floats, at, whole_member(a, "componentType"));
            if (use.tangent && floats.components == 4) tangents(floats, at);
        } catch (const Error& error) {
            note_(at, error.what());
        }
    }

    // Limits are those of the numbers as they are stored.
    void limits(const json& a, const std::string& at, const Floats& floats) {
        for (size_t c = 0; c < floats.components; ++c)
            if (!limits(a, at, floats, c)) return;
    }

    bool limits(const json& a, const std::string& at, const Floats& floats, size_t c) {
        float least = INFINITY, most = -INFINITY;
        for (size_t i = c; i < floats.values.size(); i += floats.components) least = std::min(least, floats.values[i]), most = std::max(most, floats.values[i]);
        for (const auto& [key, found] : {std::pair{"min", least}, std::pair{"max", most}}) {
            const json& stated = array_member(a, key);
            if (c >= stated.size() || !stated[c].is_number() || stated[c].get<float>() == found) continue;
            note_(at + "/" + key, "is not that of its numbers");
            return false;
        }
        return true;
    }

    void times(const Floats& floats, const std::string& at) {
        if (floats.values[0] < 0) note_(at, "holds times of keys before 0");
        for (size_t i = 1; i < floats.values.size(); ++i)
            if (floats.values[i] <= floats.values[i - 1]) return note_(at, "holds times of keys that do not ascend");
    }

    void matrices(const Floats& floats, const std::string& at) {
        for (size_t i = 0; i < floats.count; ++i)
            if (const auto m = floats[i]; m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) return note_(at, "holds matrices of joints whose last row is not 0 0 0 1");
    }

    // The largest index there can be would begin a new strip elsewhere. (Of 32 bits there are more than vertices may be.)
    void indices(const Floats& floats, const std::string& at, uint64_t component) {
        const float last = component == 5121 ? 255 : 65535;
        if (component != 5125 && std::find(floats.values.begin(), floats.values.end(), last) != floats.values.end()) note_(at, "holds the index " + std::to_string(int(last)) + ", the last of its type, which is none");
    }

    void tangents(const Floats& floats, const std::string& at) {
        for (size_t i = 0; i < floats.count; ++i) {
            const auto t = floats[i];
            if (std::abs(std::hypot(double(t[0]), double(t[1]), double(t[2])) - 1) > kUnitTolerance) return note_(at, "holds tangents that are not of length 1");
            if (std::abs(t[3]) != 1) return note_(at, "holds tangents with a sign that is neither 1 nor -1");
        }
    }

    GltfReader& reader_;
    const GltfLists& lists_;
    const std::vector<AccessorUse>& uses_;
    const RuleNote& note_;
    uint64_t numbers_ = 0;
};

}  // namespace

void check_accessors(GltfReader& reader, const GltfLists& lists, const std::vector<AccessorUse>& uses, const RuleNote& note) { Accessors(reader, lists, uses, note).check(); }

}  // namespace vesper
