// Rules for extensions of glTF 2.0: listed where they are used, standing where they may, lamps as KHR_lights_punctual has them. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <map>

#include "scene/gltf_rules.h"

namespace vesper {
namespace {

using nlohmann::json;

/// Places of an extension's objects, with # for numbers. (Khronos' registry of extensions; those of others may stand anywhere.)
const std::multimap<std::string, std::string, std::less<>> kPlaces{
    {"KHR_lights_punctual", ""},
    {"KHR_lights_punctual", "/nodes/#"},
    {"EXT_lights_ies", ""},
    {"EXT_lights_ies", "/nodes/#"},
    {"EXT_lights_image_based", ""},
    {"EXT_lights_image_based", "/scenes/#"},
    {"EXT_mesh_gpu_instancing", "/nodes/#"},
    {"KHR_node_visibility", "/nodes/#"},
    {"KHR_draco_mesh_compression", "/meshes/#/primitives/#"},
    {"KHR_materials_variants", ""},
    {"KHR_materials_variants", "/meshes/#/primitives/#"},
    {"EXT_meshopt_compression", "/buffers/#"},
    {"EXT_meshopt_compression", "/bufferViews/#"},
    {"KHR_texture_basisu", "/textures/#"},
    {"EXT_texture_webp", "/textures/#"},
    {"EXT_texture_avif", "/textures/#"},
    {"KHR_animation_pointer", "/animations/#/channels/#/target"},
};

/// A place with its numbers as #.
std::string kind_of(const std::string& at) {
    std::string kind;
    for (size_t i = 0; i < at.size();) {
        const size_t next = std::min(at.find('/', i + 1), at.size());
        const std::string_view step = std::string_view(at).substr(i, next - i);
        const bool number = step.size() > 1 && std::all_of(step.begin() + 1, step.end(), [](unsigned char c) { return std::isdigit(c); });
        kind += number ? "/#" : step;
        i = next;
    }
    return kind;
}

bool may_stand(const std::string& extension, const std::string& kind) {
    if (extension == "KHR_texture_transform") return kind.ends_with("Texture");
    const auto [first, last] = kPlaces.equal_range(extension);
    if (first == last) return !extension.starts_with("KHR_materials_") || kind == "/materials/#";
    return std::any_of(first, last, [&](const auto& place) { return place.second == kind; });
}

void check_lights(const json& punctual, const RuleNote& note) {
    const std::string lamps = "/extensions/KHR_lights_punctual/lights";
    const auto list = punctual.find("lights");
    if (list == punctual.end()) return note("/extensions/KHR_lights_punctual", "has no lights");
    if (!list->is_array()) return;
    if (list->empty()) return note(lamps, "is empty");
    for (size_t i = 0; i < list->size(); ++i) {
        const json& lamp = (*list)[i];
        if (!lamp.is_object() || text_member(lamp, "type") != "spot") continue;
        const std::string at = lamps + "/" + std::to_string(i);
        const auto spot = lamp.find("spot");
        if (spot == lamp.end()) {
            note(at, "has no spot to its type");
        } else if (spot->is_object()) {
            const json inner = spot->value("innerConeAngle", json(0.0)), outer = spot->value("outerConeAngle", json(0.785398163397448));  // the defaults
            if (inner.is_number() && outer.is_number() && outer.get<double>() <= inner.get<double>()) note(at + "/spot", "has an outer cone that is no wider than its inner one");
        }
    }
}

// The variants that a file has: each has a name.
void check_variants(const json& extension, const std::string& at, const RuleNote& note) {
    const json& variants = array_member(extension, "variants");
    if (!extension.contains("variants")) note(at, "has no variants");
    if (variants.empty() && extension.contains("variants") && extension["variants"].is_array()) note(at + "/variants", "is empty");
}

// The materials of a primitive in some of them: one in each.
void check_mappings(const GltfLists& lists, const json& extension, const std::string& at, const RuleNote& note) {
    const size_t count = array_member(object_member(object_member(lists.root(), "extensions"), "KHR_materials_variants"), "variants").size();
    if (!extension.contains("mappings")) note(at, "has no mappings");
    std::map<uint64_t, uint32_t> mapped;  // by variant: the mapping that has it
    GltfLists::each_of(array_member(extension, "mappings"), at + "/mappings", [&](const json& mapping, const std::string& place, uint32_t number) {
        if (array_member(mapping, "variants").empty() && mapping.contains("variants")) note(place + "/variants", "is empty");
        for (const json& name : array_member(mapping, "variants")) {
            const auto variant = whole_number(name);
            if (!variant) continue;  // noted as such
            if (*variant >= count) return note(place + "/variants", "names none of the " + std::to_string(count) + " variants");
            if (const auto [first, added] = mapped.try_emplace(*variant, number); !added && first->second != number) return note(place + "/variants", "names a variant that another mapping names");
        }
    });
}

}  // namespace

void check_extensions(const GltfLists& lists, const json& extensions, const std::string& at, const RuleNote& note) {
    const std::string kind = kind_of(at);
    for (const auto& [name, value] : extensions.items()) {
        const std::string here = at + "/extensions/" + name;
        if (!lists.uses(name)) note(here, "is not listed in extensionsUsed");
        if (!may_stand(name, kind)) note(here, "is an extension that has no place there");
        if (!value.is_object()) {
            note(here, "is no object");
        } else if (at.empty() && name == "KHR_lights_punctual") {
            check_lights(value, note);
        } else if (at.empty() && name == "KHR_materials_variants") {
            check_variants(value, here, note);
        } else if (kind == "/meshes/#/primitives/#" && name == "KHR_materials_variants") {
            check_mappings(lists, value, here, note);
        }
    }
}

void check_required_extensions(const GltfLists& lists, const RuleNote& note) {
    const json& required = array_member(lists.root(), "extensionsRequired");
    for (size_t i = 0; i < required.size(); ++i)
        if (const json& name = required[i]; name.is_string() && !lists.uses(name.get_ref<const std::string&>())) note("/extensionsRequired/" + std::to_string(i), "is not listed in extensionsUsed");
    // Without it, attributes have formats that they cannot have.
    if (lists.uses("KHR_mesh_quantization") && !lists.requires_it("KHR_mesh_quantization")) note("/extensionsUsed", "lists KHR_mesh_quantization, which extensionsRequired has to list too");
}

}  // namespace vesper
