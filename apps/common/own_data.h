// Where the programs find the scenes that come with them. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace vesper::apps {

/// The folder of Vesper's own scenes and tables (`data/` of the source tree), found from where the running program
/// lies: `share/vesper` beside it or of its install prefix, which in a build folder is a link to the source tree.
/// Throws Error if there is none.
std::filesystem::path own_data();

/// The name of a file of own_data() in recordings, the same wherever that folder lies:
/// "vesper:rivoli/rivoli.world.json". Empty if `file` is no such file.
std::string own_data_name(const std::filesystem::path& file);

/// The file of such a name, nothing if `name` does not begin like one. Throws Error if there is no own_data(), and for
/// names that lead out of it.
std::optional<std::filesystem::path> own_data_file(const std::string& name);

}  // namespace vesper::apps
