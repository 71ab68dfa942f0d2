// Parts of the check of glTF's rules. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include <nlohmann/json.hpp>

namespace vesper {

/// Takes a place, as a JSON pointer, and what is wrong there.
using RuleNote = std::function<void(const std::string& at, const std::string& what)>;

/// The extensions of the object at a place.
void check_extensions(const nlohmann::json& root, const nlohmann::json& extensions, const std::string& at, const RuleNote&);
/// What a file requires, it uses.
void check_required_extensions(const nlohmann::json& root, const RuleNote&);

}  // namespace vesper
