// Reflection tables of a converted file, and the materials that have them. SPDX-License-Identifier: MIT
#include "scene/gltf_reader.h"
#include "scene/reflection_json.h"

namespace vesper::scene {

void read_reflection_tables(GltfReader& reader, const JsonValue& block) {
    constexpr size_t kMaxTables = 256;
    const auto tables = block.elements_of("reflection_tables");
    if (tables.size() > kMaxTables) block.at("reflection_tables").fail("must not have more than 256 elements");
    for (const JsonValue& table : tables) reader.scene.reflection_tables.push_back(read_whole_table(table));
    const size_t materials = reader.document.list("materials").size();
    for (const JsonValue& road : block.elements_of("roads")) {
        road.allow_only({"material", "table"});
        reader.scene.materials[road.at("material").index(materials, "materials")].reflection_table =
            road.at("table").index(tables.size(), "reflection tables");
    }
}

}  // namespace vesper::scene
