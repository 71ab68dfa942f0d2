// The sky and the retroreflective materials of a converted file. SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "scene/gltf_reader.h"
#include "scene/half_sky.h"
#include "scene/photometry_parts.h"

namespace vesper::scene {

void read_environment(GltfReader& reader, const JsonValue& source) {
    source.allow_only({"bufferView", "width", "height", "scale", "rotation_deg", "name"});
    const uint64_t width = source.at("width").integer(photometry::kMaxEnvironmentWidth),
                   height = source.at("height").integer();
    if (width < 2 || width != 2 * height) source.at("width").fail("must be twice the height, and at least 2");
    const JsonValue number = source.at("bufferView");
    const auto bytes = reader.document.view(number.index(reader.document.list("bufferViews").size(), "bufferViews"));
    if (bytes.size() != width * height * 6) number.fail("must hold three half floats per pixel and nothing else");
    const double scale = source.number_or("scale", 1, 0);
    photometry::Environment made{
        uint32_t(width), uint32_t(height), {}, source.number_or("rotation_deg", 0, -360, 360) * std::numbers::pi / 180};
    made.rgb.reserve(bytes.size() / 2);
    for (size_t i = 0; i < bytes.size(); i += 2) {
        const float value = half_luminance(&bytes[i], scale);
        if (!(value >= 0) || !std::isfinite(value)) number.fail("holds luminances that are negative or not finite");
        made.rgb.push_back(value);
    }
    reader.scene.environment = std::move(made);
}

void read_retroreflectors(GltfReader& reader, const JsonValue& block) {
    const auto classes = block.elements_of("retroreflectors");
    if (classes.size() > kMaxRetroreflectors)
        block.at("retroreflectors")
            .fail("must not have more than " + std::to_string(kMaxRetroreflectors) + " elements");
    for (const JsonValue& one : classes) reader.scene.retroreflectors.push_back(read_whole_retroreflector(one));
    const size_t materials = reader.document.list("materials").size();
    for (const JsonValue& use : block.elements_of("retroreflective")) {
        use.allow_only({"material", "retroreflector"});
        Material& material = reader.scene.materials[use.at("material").index(materials, "materials")];
        if (material.reflection_table != kNone) use.fail("the material has a reflection table already");
        material.retroreflector = use.at("retroreflector").index(classes.size(), "retroreflectors");
    }
}

}  // namespace vesper::scene
