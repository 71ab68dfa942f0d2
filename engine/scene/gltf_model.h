// Reading the lists of a glTF file with tinygltf. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "scene/gltf_document.h"

namespace vesper::scene {

/// Refuses a value of a wrong type or length and a reference to an element that is not there. tinygltf leaves such a
/// value out, without a word, and cuts whole numbers to 32 bits. Throws Error.
void check_parts(GltfDocument& document);

/// What GltfDocument::model() gives. Throws Error.
std::unique_ptr<const tinygltf::Model> read_model(GltfDocument& document);

}  // namespace vesper::scene
