// Writing a glTF document as one file. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/gltf_document.h"

namespace vesper {

/// The document as a self-contained file: every buffer and picture inside it, in data URIs (.gltf) or in one binary
/// chunk (.glb). The bytes of the pictures are those of the files. Changes the document's JSON. Throws Error.
std::vector<uint8_t> encode_gltf(GltfDocument& document, bool binary);

}  // namespace vesper
