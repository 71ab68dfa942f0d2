// Writing a glTF document as one file. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "scene/gltf_document.h"

namespace vesper::scene {

/// The document as a self-contained file: every buffer and picture inside it, in data URIs (.gltf) or in one binary
/// chunk (.glb). The bytes of the pictures are those of the files; one that cannot be had keeps its URI, for which
/// there is a line in `warnings`. Changes the document's JSON. Throws Error.
std::vector<uint8_t> encode_gltf(GltfDocument& document, bool binary, std::vector<std::string>& warnings);

}  // namespace vesper::scene
