// URIs as glTF uses them: relative paths and data. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vesper::scene {

/// Whether the URI holds its bytes itself ("data:...", in small or capital letters).
bool is_data_uri(std::string_view uri);

/// The bytes of a data URI, base64 or percent-encoded. Throws Error (reason only).
std::vector<uint8_t> decode_data_uri(std::string_view uri);

/// Makes a base64 data URI.
std::string encode_data_uri(std::string_view media_type, std::span<const uint8_t> bytes);

/// The file a relative URI names, from the folder of the file that names it. Percent-encoding is undone, unless a file
/// of just that name exists. It lies in that folder or in an AllowedFolder; schemes and absolute paths are refused.
/// Throws Error (reason only).
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri);

}  // namespace vesper::scene
