// Geometry that a glTF file has compressed, as the buffers that it stands for. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace vesper::scene {

class GltfDocument;

/// The bytes of a buffer whose views are compressed with EXT_meshopt_compression, or KHR_meshopt_compression. Throws
/// Error where a view of it is not, is damaged, or states more than its bytes can hold.
std::vector<uint8_t> decode_meshopt(GltfDocument& document, uint32_t buffer);

/// Whether KHR_draco_mesh_compression can be read: Vesper was built with libdraco.
bool reads_draco();

/// Gives the accessors of primitives that are compressed with KHR_draco_mesh_compression their bytes, in a buffer that
/// is added, and drops the extension. Accessors that have bytes keep them. Counts of accessors become those of the
/// compressed geometry. Throws Error naming the primitive.
void expand_draco(GltfDocument& document);

}  // namespace vesper::scene
