// Reflection tables in JSON: named in a photometry file or a road layout, in full in a converted scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "photometry/reflection_table.h"
#include "scene/json_value.h"

namespace vesper::scene {

/// The members "reflection_table" (a built-in name, or a file relative to `folder`) and "q0" (optional) of an object.
photometry::ReflectionTable read_named_table(const JsonValue& holder, const std::filesystem::path& folder);

/// All numbers of a table, and back.
nlohmann::json json_of(const photometry::ReflectionTable& table);
photometry::ReflectionTable read_whole_table(const JsonValue& source);

}  // namespace vesper::scene
