// Making small glTF files for tests of the reader and the converter. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/read_scene.h"
#include "scene/uri.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {

/// A value somewhere in a JSON file that makes it wrong, and what the complaint must name.
struct Fault {
    const char* pointer;
    nlohmann::json value;
    const char* place;
};

/// Puts each fault alone into a good file. `complaint(file)` is what reading it throws.
template <class Complaint>
void expect_places(const nlohmann::json& good, const std::vector<Fault>& faults, const Complaint& complaint,
                   const std::string& name = "") {
    EXPECT_EQ(complaint(good), "");
    for (const Fault& fault : faults) {
        nlohmann::json file = good;
        file[nlohmann::json::json_pointer(fault.pointer)] = fault.value;
        EXPECT_TRUE(contains(complaint(file), name + fault.place)) << fault.pointer << " = " << fault.value;
    }
}

/// A glTF file in the making: JSON, and one buffer that accessors are appended to.
class GltfFile {
public:
    nlohmann::json root = {{"asset", {{"version", "2.0"}}}};
    std::vector<uint8_t> bytes;

    /// Appends values as an accessor, tightly packed, and returns its number.
    template <class T>
    size_t accessor(const std::vector<T>& values, int component_type, const char* type, size_t components,
                    bool normalized = false) {
        const size_t view = buffer_view(values);
        root["accessors"].push_back({{"bufferView", view},
                                     {"componentType", component_type},
                                     {"count", values.size() / components},
                                     {"type", type},
                                     {"normalized", normalized}});
        return root["accessors"].size() - 1;
    }
    /// With the bounds that positions must have.
    size_t vec3(const std::vector<float>& values) {
        const size_t made = accessor(values, 5126, "VEC3", 3);
        for (size_t i = 0; i < values.size(); ++i) {
            const float value = values[i];
            if (!std::isfinite(value)) continue;
            nlohmann::json &low = root["accessors"][made]["min"][i % 3], &high = root["accessors"][made]["max"][i % 3];
            if (!low.is_number() || value < low.get<float>()) low = value;
            if (!high.is_number() || value > high.get<float>()) high = value;
        }
        return made;
    }
    size_t vec2(const std::vector<float>& values) { return accessor(values, 5126, "VEC2", 2); }
    size_t indices(const std::vector<uint16_t>& values) { return accessor(values, 5123, "SCALAR", 1); }

    template <class T>
    size_t buffer_view(const std::vector<T>& values) {
        while (bytes.size() % 4 != 0) bytes.push_back(0);
        const size_t offset = bytes.size(), size = values.size() * sizeof(T);
        bytes.resize(offset + size);
        if (size) std::memcpy(bytes.data() + offset, values.data(), size);
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
        return root["bufferViews"].size() - 1;
    }

    /// A mesh of one primitive, on a node of its own.
    void show(const nlohmann::json& primitive, const nlohmann::json& node = nlohmann::json::object()) {
        root["meshes"].push_back({{"primitives", {primitive}}});
        nlohmann::json placed = node;
        placed["mesh"] = root["meshes"].size() - 1;
        root["nodes"].push_back(placed);
    }

    std::string text() {
        if (!bytes.empty())
            root["buffers"] = {
                {{"byteLength", bytes.size()}, {"uri", scene::encode_data_uri("application/octet-stream", bytes)}}};
        return root.dump();
    }

    scene::LoadedScene read(const scene::SceneLimits& limits = {}) {
        const TempFolder folder;
        return scene::read_scene(folder.write("scene.gltf", text()), limits);
    }

    /// The message of the Error that reading throws; empty when it throws none.
    std::string complaint(const scene::SceneLimits& limits = {}) {
        return complaint_of([&] { read(limits); });
    }
};

/// A right triangle in the plane z = 0, facing +Z.
inline const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

}  // namespace vesper::test
