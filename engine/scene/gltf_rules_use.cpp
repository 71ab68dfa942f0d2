// Rules of glTF 2.0 for what accessors and buffer views are used for: one thing each, packed as that asks for. SPDX-License-Identifier: MIT
#include "scene/gltf_rules.h"

namespace vesper {
namespace {

using nlohmann::json;
using Kind = AccessorUse::Kind;

const char* name_of(Kind kind) {
    constexpr const char* kNames[]{"", "indices", "an attribute", "times of keys", "values of keys", "matrices of joints"};
    return kNames[static_cast<size_t>(kind)];
}

/// What a buffer view holds.
enum class Holds : uint8_t { Nothing, Vertices, Indices, Matrices, Picture, Other };

struct ViewUse {
    Holds holds = Holds::Nothing;
    uint64_t accessor = UINT64_MAX;  ///< the first of vertices
    bool noted = false;
};

class Uses {
public:
    Uses(const GltfLists& lists, const RuleNote& note) : lists_(lists), note_(note), accessors_(lists.count("accessors")), views_(lists.count("bufferViews")) {}

    std::vector<AccessorUse> check() {
        lists_.each("bufferViews", [&](const json& view, const std::string& at, uint32_t i) { stated(view, at, i); });
        lists_.each("meshes", [&](const json& mesh, const std::string&, uint32_t) {
            for (const json& p : array_member(mesh, "primitives"))
                if (p.is_object()) primitive(p);
        });
        lists_.each("skins", [&](const json& skin, const std::string&, uint32_t) { use(skin, "inverseBindMatrices", Kind::Matrices); });
        lists_.each("animations", [&](const json& animation, const std::string&, uint32_t) {
            for (const json& sampler : array_member(animation, "samplers")) {
                if (!sampler.is_object()) continue;
                use(sampler, "input", Kind::KeyTimes);
                use(sampler, "output", Kind::KeyValues);
            }
        });
        lists_.each("accessors", [&](const json& a, const std::string&, uint32_t) {
            const json& sparse = object_member(a, "sparse");
            for (const char* part : {"indices", "values"}) hold(object_member(sparse, part), Holds::Other);
        });
        lists_.each("images", [&](const json& image, const std::string&, uint32_t) { hold(image, Holds::Picture); });
        return accessors_;
    }

private:
    // What a view says of itself.
    void stated(const json& view, const std::string& at, uint32_t i) {
        const uint64_t target = whole_member(view, "target"), stride = whole_member(view, "byteStride");
        if (target == 34962) views_[i].holds = Holds::Vertices;
        if (target == 34963) views_[i].holds = Holds::Indices;
        if (stride % 4 != 0) note_(at + "/byteStride", "is no multiple of four");
        if (stride > whole_member(view, "byteLength", UINT64_MAX)) note_(at + "/byteStride", "is more than its bytes");
        if (target == 34963 && view.contains("byteStride")) note_(at, "holds indices, and has a stride");
    }

    void primitive(const json& p) {
        use(p, "indices", Kind::Indices);
        const json& attributes = object_member(p, "attributes");
        for (const auto& [name, value] : attributes.items())
            if (AccessorUse* used = use(attributes, name.c_str(), Kind::Attribute); used && name == "TANGENT") used->tangent = true;
        for (const json& target : array_member(p, "targets"))
            for (const auto& [name, value] : target.items())
                if (target.is_object()) use(target, name.c_str(), Kind::Attribute);
    }

    AccessorUse* use(const json& holder, const char* key, Kind kind) {
        const uint64_t index = whole_member(holder, key, UINT64_MAX);
        const json* accessor = lists_.named(holder, key, "accessors");
        if (!accessor) return nullptr;
        AccessorUse& used = accessors_[index];
        if (used.kind == kind || used.mixed) return &used;  // seen before
        const std::string at = "/accessors/" + std::to_string(index);
        if (used.kind != Kind::None) {
            used.mixed = true;
            note_(at, std::string("is used as ") + name_of(used.kind) + " and as " + name_of(kind));
            return &used;
        }
        used.kind = kind;
        const json* view = lists_.named(*accessor, "bufferView", "bufferViews");
        if (!view) return &used;
        const bool vertices = kind == Kind::Attribute;
        hold(*accessor, vertices ? Holds::Vertices : kind == Kind::Indices ? Holds::Indices : kind == Kind::Matrices ? Holds::Matrices : Holds::Other);
        if (!vertices && view->contains("byteStride")) note_(at, "holds " + std::string(name_of(kind)) + ", and lies in a buffer view with a stride");
        if (vertices) beside(*accessor, *view, index, at);
        return &used;
    }

    // Attributes lie at multiples of four, and beside others with a stride.
    void beside(const json& accessor, const json& view, uint64_t index, const std::string& at) {
        ViewUse& use = views_[whole_member(accessor, "bufferView")];
        if (use.accessor == UINT64_MAX) use.accessor = index;
        const bool stride = view.contains("byteStride");
        if (!stride && use.accessor != index) note_(at, "lies in one buffer view with accessor " + std::to_string(use.accessor) + ", which has no stride");
        const uint64_t type = whole_member(accessor, "componentType"), size = type < 5122 ? 1 : type < 5124 ? 2 : 4;
        const std::string_view name = text_member(accessor, "type");
        const uint64_t numbers = name == "SCALAR" ? 1 : name == "VEC2" ? 2 : name == "VEC3" ? 3 : 4;
        if (whole_member(accessor, "byteOffset") % 4 != 0 || (!stride && numbers * size % 4 != 0)) note_(at, "holds an attribute whose elements do not begin at multiples of four");
    }

    void hold(const json& holder, Holds holds) {
        if (!lists_.named(holder, "bufferView", "bufferViews")) return;
        const uint64_t index = whole_member(holder, "bufferView");
        ViewUse& use = views_[index];
        if (use.holds == Holds::Nothing) use.holds = holds;
        if (use.holds == holds || use.noted) return;
        use.noted = true;
        note_("/bufferViews/" + std::to_string(index), "is used for different things, or not for what its target says");
    }

    const GltfLists& lists_;
    const RuleNote& note_;
    std::vector<AccessorUse> accessors_;
    std::vector<ViewUse> views_;
};

}  // namespace

std::vector<AccessorUse> check_uses(const GltfLists& lists, const RuleNote& note) { return Uses(lists, note).check(); }

}  // namespace vesper
