// Rules of glTF 2.0 for primitives: attributes, morph targets, texture coordinates that materials need. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "scene/gltf_rules.h"

namespace vesper {
namespace {

using nlohmann::json;

/// What the accessor of an attribute may hold (specification 2.0, section 3.7.2): types, and numbers as `format_of` writes them, in general, in
/// morph targets (none: no such attribute there), and more of either with KHR_mesh_quantization.
struct Attribute {
    const char *types, *numbers, *of_targets, *quantized, *quantized_targets;
};
const std::map<std::string, Attribute, std::less<>> kAttributes{
    {"POSITION", {"VEC3", "f", "f", "b bn B Bn s sn S Sn", "b bn s sn"}},
    {"NORMAL", {"VEC3", "f", "f", "bn sn", "bn sn"}},
    {"TANGENT", {"VEC4", "f", "f", "bn sn", "bn sn"}},
    {"TEXCOORD_", {"VEC2", "f Bn Sn", "f bn Bn sn Sn", "b bn B s sn S", "b s"}},
    {"COLOR_", {"VEC3 VEC4", "f Bn Sn", "f bn Bn sn Sn", "", ""}},
    {"JOINTS_", {"VEC4", "B S", "", "", ""}},
    {"WEIGHTS_", {"VEC4", "f Bn Sn", "", "", ""}},
};

/// A letter for the component type, and n where it is normalized.
std::string format_of(const json& accessor) {
    constexpr uint64_t kFirst = 5120;
    constexpr const char* kLetters[]{"b", "B", "s", "S", "?", "I", "f"};
    const uint64_t type = whole_member(accessor, "componentType");
    if (type < kFirst || type > kFirst + 6) return "?";
    return kLetters[type - kFirst] + std::string(true_member(accessor, "normalized") ? "n" : "");
}

bool is_one_of(const std::string& words, const std::string& word) { return (" " + words + " ").find(" " + word + " ") != std::string::npos; }

/// The name of an attribute without its number; empty for those that glTF does not have.
std::string semantic_of(const std::string& name) {
    const size_t bar = name.find('_');
    if (bar == name.npos) return kAttributes.contains(name) ? name : "";
    const std::string stem = name.substr(0, bar + 1), number = name.substr(bar + 1);
    const bool counts = !number.empty() && (number == "0" || number[0] != '0') && std::all_of(number.begin(), number.end(), [](unsigned char c) { return std::isdigit(c); });
    return counts && kAttributes.contains(stem) ? stem : "";
}

/// A texture of a material, and the set of coordinates it lies by.
struct NeededSet {
    std::string texture, set;
};

/// A texture of a material that needs tangents, which none can be made for without a normalTexture; empty for none.
std::string needed_tangents(const json& material, const std::string& at) {
    if (material.contains("normalTexture")) return "";
    const json& extensions = object_member(material, "extensions");
    for (const auto& [extension, texture] : {std::pair{"KHR_materials_clearcoat", "clearcoatNormalTexture"}, std::pair{"KHR_materials_anisotropy", "anisotropyTexture"}})
        if (object_member(extensions, extension).contains(texture)) return at + "/extensions/" + extension + "/" + texture;
    return "";
}

/// Those of a material, where its extensions have theirs as well.
void find_needed(const json& holder, const std::string& at, std::vector<NeededSet>& needed) {
    for (const auto& [key, value] : holder.items()) {
        if (!value.is_object() || key == "extras") continue;
        if (key.ends_with("Texture") && value.contains("index")) {
            const json& transform = object_member(object_member(value, "extensions"), "KHR_texture_transform");
            needed.push_back({at + "/" + key, "TEXCOORD_" + std::to_string(whole_member(transform, "texCoord", whole_member(value, "texCoord")))});
        } else {
            find_needed(value, at + "/" + key, needed);
        }
    }
}

class Primitives {
public:
    Primitives(const GltfLists& lists, const RuleNote& note) : lists_(lists), note_(note), quantized_(lists.uses("KHR_mesh_quantization")) {}

    void check() {
        needed_.resize(lists_.count("materials"));
        tangents_.resize(needed_.size());
        lists_.each("materials", [&](const json& m, const std::string& at, uint32_t i) { find_needed(m, at, needed_[i]), tangents_[i] = needed_tangents(m, at); });
        lists_.each("meshes", [&](const json& mesh, const std::string& at, uint32_t) { this->mesh(mesh, at); });
    }

private:
    void mesh(const json& mesh, const std::string& at) {
        const json& primitives = array_member(mesh, "primitives");
        GltfLists::each_of(primitives, at + "/primitives", [&](const json& p, const std::string& place, uint32_t) { primitive(p, place); });
        if (primitives.empty() || !primitives[0].is_object()) return;
        const size_t targets = array_member(primitives[0], "targets").size();
        for (const json& p : primitives)
            if (p.is_object() && array_member(p, "targets").size() != targets) return note_(at + "/primitives", "have not all as many morph targets");
        if (mesh.contains("weights") && array_member(mesh, "weights").size() != targets) note_(at + "/weights", "are not one for each of the " + std::to_string(targets) + " morph targets");
    }

    void primitive(const json& p, const std::string& at) {
        const json& attributes = object_member(p, "attributes");
        if (p.contains("attributes") && attributes.empty()) note_(at + "/attributes", "is empty");
        const json* first = lists_.named(attributes, attributes.contains("POSITION") ? "POSITION" : attributes.empty() ? "" : attributes.begin().key().c_str(), "accessors");
        const uint64_t count = first ? whole_member(*first, "count") : 0;
        std::map<std::string, std::set<uint64_t>> sets;  // of the attributes with numbers
        for (const auto& [name, value] : attributes.items()) {
            const std::string semantic = semantic_of(name);
            attribute(attributes, name, semantic, at + "/attributes", false, count);
            if (semantic.ends_with('_') && name.size() < semantic.size() + 9) sets[semantic].insert(std::stoull(name.substr(semantic.size())));
        }
        for (const auto& [semantic, numbers] : sets)
            if (*numbers.rbegin() != numbers.size() - 1) note_(at + "/attributes", "has not every " + semantic + "0 to " + semantic + std::to_string(*numbers.rbegin()));
        if (sets["JOINTS_"].size() != sets["WEIGHTS_"].size()) note_(at + "/attributes", "has not as many sets of joints as of weights");
        GltfLists::each_of(array_member(p, "targets"), at + "/targets", [&](const json& t, const std::string& place, uint32_t) { target(t, attributes, place); });
        indices(p, at);
        textures(p, attributes, at);
    }

    void attribute(const json& attributes, const std::string& name, const std::string& semantic, const std::string& at, bool of_target, uint64_t count) {
        const json* accessor = lists_.named(attributes, name.c_str(), "accessors");
        if (accessor && count && whole_member(*accessor, "count") != count) note_(at + "/" + name, "has not as many elements as the others");
        if (name.starts_with('_') && accessor && whole_member(*accessor, "componentType") == 5125) note_(at + "/" + name, "has an accessor of a format that it cannot have");
        if (name.starts_with('_') || name.find(':') != name.npos) return;  // of applications and extensions
        const auto rule = kAttributes.find(semantic);
        if (rule == kAttributes.end() || (of_target && !*rule->second.of_targets)) return note_(at + "/" + name, "is no attribute of glTF");
        if (!accessor) return;
        const Attribute& a = rule->second;
        const std::string type(text_member(*accessor, "type")), format = format_of(*accessor);
        const bool type_fits = of_target && semantic == "TANGENT" ? type == "VEC3" : is_one_of(a.types, type);
        const bool fits = is_one_of(of_target ? a.of_targets : a.numbers, format) || (quantized_ && is_one_of(of_target ? a.quantized_targets : a.quantized, format));
        if (!type_fits || !fits) note_(at + "/" + name, "has an accessor of a format that it cannot have");
        if (semantic == "POSITION" && !(accessor->contains("min") && accessor->contains("max"))) note_(at + "/" + name, "has an accessor without min and max");
    }

    void target(const json& target, const json& attributes, const std::string& at) {
        if (target.empty()) note_(at, "is empty");
        for (const auto& [name, value] : target.items()) {
            const json* base = lists_.named(attributes, name.c_str(), "accessors");
            attribute(target, name, semantic_of(name), at, true, base ? whole_member(*base, "count") : 0);
            if (!attributes.contains(name) && !semantic_of(name).empty()) note_(at + "/" + name, "moves an attribute that the primitive has not");
        }
    }

    void indices(const json& p, const std::string& at) {
        const json* accessor = lists_.named(p, "indices", "accessors");
        if (accessor && (text_member(*accessor, "type") != "SCALAR" || !is_one_of("B S I", format_of(*accessor)))) note_(at + "/indices", "has an accessor of a format that it cannot have");
    }

    void textures(const json& p, const json& attributes, const std::string& at) {
        const uint64_t material = whole_member(p, "material", UINT64_MAX);
        if (material >= needed_.size()) return;
        if (!tangents_[material].empty() && !(attributes.contains("TANGENT") && attributes.contains("NORMAL"))) note_(at, "has no TANGENT, which " + tangents_[material] + " needs where there is no normalTexture");
        for (const NeededSet& needed : needed_[material])
            if (!attributes.contains(needed.set)) return note_(at, "has no " + needed.set + ", which " + needed.texture + " needs: where it is read, then at (0, 0)");
    }

    const GltfLists& lists_;
    const RuleNote& note_;
    const bool quantized_;
    std::vector<std::vector<NeededSet>> needed_;  // by material
    std::vector<std::string> tangents_;           // as well
};

}  // namespace

void check_primitives(const GltfLists& lists, const RuleNote& note) { Primitives(lists, note).check(); }

}  // namespace vesper
