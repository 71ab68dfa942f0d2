// What the checks of glTF's rules share: looking at JSON that may hold anything. SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>

#include "scene/gltf_rules.h"

namespace vesper {

using nlohmann::json;

namespace {

/// What an object has for a key; null for nothing.
const json* member(const json& holder, const char* key) {
    const auto found = holder.find(key);
    return found != holder.end() ? &*found : nullptr;
}

}  // namespace

std::optional<uint64_t> whole_number(const json& value) {
    if (value.is_number_unsigned()) return value.get<uint64_t>();
    if (!value.is_number_float()) return {};
    const double number = value.get<double>();
    return number >= 0 && number < 9e15 && number == std::floor(number) ? std::optional(uint64_t(number)) : std::nullopt;
}

uint64_t whole_member(const json& holder, const char* key, uint64_t otherwise) {
    const json* found = member(holder, key);
    return found ? whole_number(*found).value_or(otherwise) : otherwise;
}

std::string_view text_member(const json& holder, const char* key) {
    const json* found = member(holder, key);
    return found && found->is_string() ? std::string_view(found->get_ref<const std::string&>()) : std::string_view();
}

bool true_member(const json& holder, const char* key) {
    const json* found = member(holder, key);
    return found && found->is_boolean() && found->get<bool>();
}

std::optional<double> number_member(const json& holder, const char* key) {
    const json* found = member(holder, key);
    return found && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

const json& object_member(const json& holder, const char* key) {
    static const json kEmpty = json::object();
    const json* found = member(holder, key);
    return found && found->is_object() ? *found : kEmpty;
}

const json& array_member(const json& holder, const char* key) {
    static const json kEmpty = json::array();
    const json* found = member(holder, key);
    return found && found->is_array() ? *found : kEmpty;
}

GltfLists::GltfLists(const json& root) : root_(root) {
    for (const auto& [key, names] : {std::pair{"extensionsUsed", &used_}, std::pair{"extensionsRequired", &required_}})
        for (const json& name : array_member(root, key))
            if (name.is_string()) names->insert(name.get_ref<const std::string&>());
}

const json* GltfLists::named(const json& holder, const char* key, const char* list) const {
    const json& elements = array_member(root_, list);
    const uint64_t i = whole_member(holder, key, UINT64_MAX);
    return i < elements.size() && elements[i].is_object() ? &elements[i] : nullptr;
}

bool GltfLists::uses(std::string_view extension, bool or_begins_so) const {
    const auto found = used_.lower_bound(extension);
    return found != used_.end() && (or_begins_so ? found->starts_with(extension) : *found == extension);
}

}  // namespace vesper
