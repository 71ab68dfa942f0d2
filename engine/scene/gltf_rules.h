// Parts of the check of glTF's rules. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace vesper {

/// Takes a place, as a JSON pointer, and what is wrong there.
using RuleNote = std::function<void(const std::string& at, const std::string& what)>;

/// A number that is whole, also where it is written as 1.0.
std::optional<uint64_t> whole_number(const nlohmann::json& value);
/// That of a member of an object.
uint64_t whole_member(const nlohmann::json& holder, const char* key, uint64_t otherwise = 0);
/// The text of a member; empty where it is none. Values are looked at in place: to compare a value with a text nlohmann::json makes another value
/// where nothing may be thrown, and a copy of an object takes memory to go, so that the program would end where there is none.
std::string_view text_member(const nlohmann::json& holder, const char* key);
/// Whether a member is `true`.
bool true_member(const nlohmann::json& holder, const char* key);
/// The number of a member.
std::optional<double> number_member(const nlohmann::json& holder, const char* key);
/// An object or array of a member; an empty one where there is none.
const nlohmann::json& object_member(const nlohmann::json& holder, const char* key);
const nlohmann::json& array_member(const nlohmann::json& holder, const char* key);

/// The lists of a glTF file, whatever stands in them.
class GltfLists {
public:
    explicit GltfLists(const nlohmann::json& root);

    const nlohmann::json& root() const { return root_; }
    size_t count(const char* list) const { return array_member(root_, list).size(); }
    /// The element that a key of an object names, if there is one and it is an object.
    const nlohmann::json* named(const nlohmann::json& holder, const char* key, const char* list) const;
    /// `see(element, its place, its number)` for all that are objects.
    template <class See>
    void each(const char* list, const See& see) const {
        each_of(array_member(root_, list), "/" + std::string(list), see);
    }
    template <class See>
    static void each_of(const nlohmann::json& list, const std::string& at, const See& see) {
        for (size_t i = 0; i < list.size(); ++i)
            if (list[i].is_object()) see(list[i], at + "/" + std::to_string(i), static_cast<uint32_t>(i));
    }
    /// Whether the file uses an extension, or any whose name begins so; whether it requires one.
    bool uses(std::string_view extension, bool or_begins_so = false) const;
    bool requires_it(std::string_view extension) const { return required_.contains(extension); }

private:
    const nlohmann::json& root_;
    std::set<std::string_view> used_, required_;
};

/// What the numbers of an accessor are to be, by what it is used for.
struct AccessorUse {
    enum class Kind : uint8_t { None, Indices, Attribute, KeyTimes, KeyValues, Matrices };
    Kind kind = Kind::None;
    bool mixed = false;    ///< used as another kind as well, and noted
    bool tangent = false;  ///< three numbers of length 1 and a sign
};
std::vector<AccessorUse> check_uses(const GltfLists&, const RuleNote&);
/// Accessors and their numbers; those of large files as far as the first million.
void check_accessors(struct GltfReader&, const GltfLists&, const std::vector<AccessorUse>&, const RuleNote&);

/// Types, ranges and lengths of all that the specification and Khronos' extensions name, required properties, lists without doubles, and what those
/// extensions refer to.
void check_schema(const GltfLists&, const RuleNote&);
/// Attributes, morph targets, and the texture coordinates that materials need.
void check_primitives(const GltfLists&, const RuleNote&);
void check_cameras(const GltfLists&, const RuleNote&);
void check_animations(const GltfLists&, const RuleNote&);
void check_skins(const GltfLists&, const RuleNote&);

/// The extensions of the object at a place.
void check_extensions(const GltfLists&, const nlohmann::json& extensions, const std::string& at, const RuleNote&);
/// What a file requires, it uses; what nobody can do without, it requires.
void check_required_extensions(const GltfLists&, const RuleNote&);

}  // namespace vesper
