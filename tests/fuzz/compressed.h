// Bytes as geometry that glTF has compressed. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace vesper::test {

/// Writes x.gltf beside a file, whose bytes are the compressed geometry of its mesh.
std::filesystem::path scene_around(const std::filesystem::path& file);

}  // namespace vesper::test
