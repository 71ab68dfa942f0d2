// Pictures of light sources in a converted file, and the materials that shine with them. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/one_line.h"
#include "io/hdr_image.h"
#include "scene/gltf_reader.h"

namespace vesper::scene {
namespace {

constexpr size_t kMaxPictures = 1024;
constexpr uint64_t kTexelsEach = 4;  ///< 16 bytes on the device, where a texel of an image has 4 in memory

photometry::LuminancePicture read_picture(GltfReader& reader, const JsonValue& source) {
    source.allow_only({"name", "bufferView"});
    const JsonValue number = source.at("bufferView");
    const auto bytes = reader.document.view(number.index(reader.document.list("bufferViews").size(), "bufferViews"));
    const std::string name = one_line(source.text_or("name", "luminance picture"));
    photometry::LuminancePicture made;
    try {
        made = photometry::make_luminance_picture(io::decode_hdr_image(
            bytes, name, {reader.limits.image_side, (reader.limits.texels - reader.texels) / kTexelsEach}));
    } catch (const Error& error) {
        number.fail(error.what());
    }
    reader.texels += kTexelsEach * made.width * made.height;
    made.name = name;
    return made;
}

void read_luminous(GltfReader& reader, const JsonValue& use) {
    use.allow_only({"material", "picture", "scale", "sampler", "texCoord", "extensions"});
    const uint32_t index = use.at("material").index(reader.document.list("materials").size(), "materials");
    Material& material = reader.scene.materials[index];
    if (material.emission_picture.image != kNone) use.at("material").fail("has a luminance picture already");
    TextureUse picture;
    picture.image = use.at("picture").index(reader.scene.luminance_pictures.size(), "luminance_pictures");
    if (const auto sampler = use.find("sampler"))
        read_sampler(reader, sampler->index(reader.document.list("samplers").size(), "samplers"), picture);
    const JsonValue scale = use.at("scale");
    const std::vector<float>& rgb = reader.scene.luminance_pictures[picture.image].rgb;
    const auto factor = static_cast<float>(scale.number(0));
    if (!std::isfinite(factor * *std::max_element(rgb.begin(), rgb.end())))
        scale.fail("makes luminances that are not finite");
    material.emission_picture = picture;
    material.emission_texture = {};
    material.emission = glm::vec3(factor);

    reader.uv_mappings[index].emission = read_uv_mapping(use);
}

}  // namespace

void check_needs_no_uv(const GltfReader& reader, uint32_t index, const JsonValue& attributes, const std::string& set) {
    const Material& material = reader.scene.materials[index];
    if (material.emission_picture.image == kNone) return;
    attributes.fail("has no " + set + ", by which the luminance picture '" +
                    reader.scene.luminance_pictures[material.emission_picture.image].name + "' of material '" +
                    material.name + "' would lie");
}

void read_luminance_pictures(GltfReader& reader, const JsonValue& block) {
    const auto pictures = block.elements_of("luminance_pictures");
    if (pictures.size() > kMaxPictures)
        block.at("luminance_pictures").fail("must not have more than " + std::to_string(kMaxPictures) + " elements");
    for (const JsonValue& picture : pictures) reader.scene.luminance_pictures.push_back(read_picture(reader, picture));
    for (const JsonValue& use : block.elements_of("luminous")) read_luminous(reader, use);
}

}  // namespace vesper::scene
