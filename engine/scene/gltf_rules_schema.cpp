// Rules of glTF 2.0 for its JSON: what each property is, from where to where, and which there must be. SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/decimal.h"
#include "scene/gltf_rules.h"

namespace vesper {
namespace {

using nlohmann::json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRightAngle = 1.5707963268 * (1 + 1e-6);  // of a float that was rounded up, too

enum class Is : uint8_t { Text, Flag, Whole, Number, Texts, Wholes, Numbers, Object, Objects };

enum : uint8_t { kNeeded = 1, kNotLow = 2, kOrZero = 4 };  // must be there; is more than `low`; may be zero as well

/// A property of a kind of object, with the kind of those inside of it. (What is referred to outside of extensions is checked where all of the file is walked through.)
struct Property {
    Is is;
    double low = -kInfinity, high = kInfinity;
    size_t length = 0;  // of lists, where that is fixed
    uint8_t flags = 0;
    const char* kind = "";
    const char* of = "";  // the list that a number names an element of
};

using Properties = std::map<std::string, Property, std::less<>>;

constexpr Property kText{Is::Text}, kFlag{Is::Flag}, kIndex{Is::Whole}, kNumber{Is::Number}, kTexts{Is::Texts}, kIndices{Is::Wholes}, kNumbers{Is::Numbers};
constexpr Property kNeededText{.is = Is::Text, .flags = kNeeded}, kNeededIndex{.is = Is::Whole, .flags = kNeeded};
constexpr Property kFromZero{.is = Is::Number, .low = 0}, kAboveZero{.is = Is::Number, .low = 0, .flags = kNotLow}, kUnit{.is = Is::Number, .low = 0, .high = 1};
constexpr Property kColour{.is = Is::Numbers, .low = 0, .high = 1, .length = 3}, kNeededCount{.is = Is::Whole, .low = 1, .flags = kNeeded};

constexpr Property object(const char* kind, uint8_t flags = 0) { return {.is = Is::Object, .flags = flags, .kind = kind}; }
constexpr Property objects(const char* kind, uint8_t flags = 0) { return {.is = Is::Objects, .flags = flags, .kind = kind}; }
constexpr Property index_of(const char* list, uint8_t flags = 0) { return {.is = Is::Whole, .flags = flags, .of = list}; }
constexpr Property numbers(size_t length, double low = -kInfinity, double high = kInfinity) { return {.is = Is::Numbers, .low = low, .high = high, .length = length}; }

constexpr Property kTexture = object("texture of an extension");

/// Kinds of objects, as the specification has them (chapter 5); extensions by their names.
const std::map<std::string, Properties, std::less<>> kKinds{
    {"glTF", {{"accessors", objects("accessor")}, {"animations", objects("animation")}, {"asset", object("asset", kNeeded)}, {"buffers", objects("buffer")},
              {"bufferViews", objects("bufferView")}, {"cameras", objects("camera")}, {"extensions", object("extensions")}, {"extensionsRequired", kTexts}, {"extensionsUsed", kTexts},
              {"images", objects("image")}, {"materials", objects("material")}, {"meshes", objects("mesh")}, {"nodes", objects("node")}, {"samplers", objects("sampler")},
              {"scene", kIndex}, {"scenes", objects("scene")}, {"skins", objects("skin")}, {"textures", objects("texture")}}},
    {"asset", {{"copyright", kText}, {"generator", kText}, {"minVersion", kText}, {"version", kNeededText}}},
    {"accessor", {{"bufferView", kIndex}, {"byteOffset", kIndex}, {"componentType", kNeededIndex}, {"count", kNeededCount}, {"max", kNumbers}, {"min", kNumbers}, {"name", kText},
                  {"normalized", kFlag}, {"sparse", object("sparse")}, {"type", kNeededText}}},
    {"sparse", {{"count", kNeededCount}, {"indices", object("sparse indices", kNeeded)}, {"values", object("sparse values", kNeeded)}}},
    {"sparse indices", {{"bufferView", kNeededIndex}, {"byteOffset", kIndex}, {"componentType", kNeededIndex}}},
    {"sparse values", {{"bufferView", kNeededIndex}, {"byteOffset", kIndex}}},
    {"animation", {{"channels", objects("channel", kNeeded)}, {"name", kText}, {"samplers", objects("animation sampler", kNeeded)}}},
    {"channel", {{"sampler", kNeededIndex}, {"target", object("target", kNeeded)}}},
    {"target", {{"extensions", object("extensions")}, {"node", kIndex}, {"path", kNeededText}}},
    {"animation sampler", {{"input", kNeededIndex}, {"interpolation", kText}, {"output", kNeededIndex}}},
    {"buffer", {{"byteLength", kNeededCount}, {"name", kText}, {"uri", kText}}},
    {"bufferView", {{"extensions", object("extensions")}, {"buffer", kNeededIndex}, {"byteLength", kNeededCount}, {"byteOffset", kIndex}, {"byteStride", {.is = Is::Whole, .low = 4, .high = 252}}, {"name", kText}, {"target", kIndex}}},
    {"camera", {{"name", kText}, {"orthographic", object("orthographic")}, {"perspective", object("perspective")}, {"type", kNeededText}}},
    {"orthographic", {{"xmag", {.is = Is::Number, .flags = kNeeded}}, {"ymag", {.is = Is::Number, .flags = kNeeded}}, {"zfar", {.is = Is::Number, .low = 0, .flags = kNeeded | kNotLow}},
                      {"znear", {.is = Is::Number, .low = 0, .flags = kNeeded}}}},
    {"perspective", {{"aspectRatio", kAboveZero}, {"yfov", {.is = Is::Number, .low = 0, .flags = kNeeded | kNotLow}}, {"zfar", kAboveZero},
                     {"znear", {.is = Is::Number, .low = 0, .flags = kNeeded | kNotLow}}}},
    {"image", {{"bufferView", kIndex}, {"mimeType", kText}, {"name", kText}, {"uri", kText}}},
    {"material", {{"alphaCutoff", kFromZero}, {"alphaMode", kText}, {"doubleSided", kFlag}, {"emissiveFactor", kColour}, {"emissiveTexture", object("textureInfo")}, {"name", kText},
                  {"extensions", object("extensions")}, {"normalTexture", object("normalTexture")}, {"occlusionTexture", object("occlusionTexture")}, {"pbrMetallicRoughness", object("pbrMetallicRoughness")}}},
    {"pbrMetallicRoughness", {{"baseColorFactor", numbers(4, 0, 1)}, {"baseColorTexture", object("textureInfo")}, {"metallicFactor", kUnit}, {"metallicRoughnessTexture", object("textureInfo")},
                              {"roughnessFactor", kUnit}}},
    {"textureInfo", {{"extensions", object("extensions")}, {"index", kNeededIndex}, {"texCoord", kIndex}}},
    {"normalTexture", {{"extensions", object("extensions")}, {"index", kNeededIndex}, {"scale", kNumber}, {"texCoord", kIndex}}},
    {"occlusionTexture", {{"extensions", object("extensions")}, {"index", kNeededIndex}, {"strength", kUnit}, {"texCoord", kIndex}}},
    {"mesh", {{"name", kText}, {"primitives", objects("primitive", kNeeded)}, {"weights", kNumbers}}},
    {"primitive", {{"extensions", object("extensions")}, {"attributes", object("attributes", kNeeded)}, {"indices", kIndex}, {"material", kIndex}, {"mode", {.is = Is::Whole, .low = 0, .high = 6}}, {"targets", objects("attributes")}}},
    {"node", {{"extensions", object("extensions")}, {"camera", kIndex}, {"children", kIndices}, {"matrix", numbers(16)}, {"mesh", kIndex}, {"name", kText}, {"rotation", numbers(4, -1, 1)}, {"scale", numbers(3)}, {"skin", kIndex},
              {"translation", numbers(3)}, {"weights", kNumbers}}},
    {"sampler", {{"magFilter", kIndex}, {"minFilter", kIndex}, {"name", kText}, {"wrapS", kIndex}, {"wrapT", kIndex}}},
    {"scene", {{"name", kText}, {"nodes", kIndices}}},
    {"skin", {{"inverseBindMatrices", kIndex}, {"joints", {.is = Is::Wholes, .flags = kNeeded}}, {"name", kText}, {"skeleton", kIndex}}},
    {"texture", {{"extensions", object("extensions")}, {"name", kText}, {"sampler", kIndex}, {"source", kIndex}}},
    {"extensions", {{"EXT_meshopt_compression", object("meshopt compression")}, {"EXT_texture_avif", object("texture source")}, {"EXT_texture_webp", object("texture source")},
                    {"KHR_animation_pointer", object("animation pointer")}, {"KHR_draco_mesh_compression", object("draco mesh compression")}, {"KHR_lights_punctual", object("lights")},
                    {"KHR_materials_anisotropy", object("anisotropy")}, {"KHR_materials_clearcoat", object("clearcoat")},
                    {"KHR_materials_diffuse_transmission", object("diffuse transmission")}, {"KHR_materials_dispersion", object("dispersion")},
                    {"KHR_materials_emissive_strength", object("emissive strength")}, {"KHR_materials_ior", object("ior")}, {"KHR_materials_iridescence", object("iridescence")},
                    {"KHR_materials_pbrSpecularGlossiness", object("specular glossiness")}, {"KHR_materials_sheen", object("sheen")}, {"KHR_materials_specular", object("specular")},
                    {"KHR_materials_transmission", object("transmission")}, {"KHR_materials_variants", object("variants")}, {"KHR_materials_volume", object("volume")},
                    {"KHR_node_visibility", object("visibility")}, {"KHR_texture_basisu", object("texture source")}, {"KHR_texture_transform", object("texture transform")}}},
    {"texture of an extension", {{"extensions", object("extensions")}, {"index", index_of("textures", kNeeded)}, {"scale", kNumber}, {"texCoord", kIndex}}},
    {"texture source", {{"source", index_of("images")}}},
    {"meshopt compression", {{"buffer", index_of("buffers")}, {"fallback", kFlag}}},
    {"animation pointer", {{"pointer", kNeededText}}},
    {"draco mesh compression", {{"attributes", object("attributes", kNeeded)}, {"bufferView", index_of("bufferViews", kNeeded)}}},
    {"variants", {{"mappings", objects("mapping")}, {"variants", objects("variant")}}},
    {"variant", {{"name", kNeededText}}},
    {"mapping", {{"material", index_of("materials", kNeeded)}, {"name", kText}, {"variants", {.is = Is::Wholes, .flags = kNeeded}}}},
    {"visibility", {{"visible", kFlag}}},
    {"lights", {{"lights", objects("light")}}},
    {"light", {{"color", kColour}, {"intensity", kFromZero}, {"name", kText}, {"range", kAboveZero}, {"spot", object("spot")}, {"type", kNeededText}}},
    {"spot", {{"innerConeAngle", {.is = Is::Number, .low = 0, .high = kRightAngle}}, {"outerConeAngle", {.is = Is::Number, .low = 0, .high = kRightAngle, .flags = kNotLow}}}},
    {"anisotropy", {{"anisotropyRotation", kNumber}, {"anisotropyStrength", kUnit}, {"anisotropyTexture", kTexture}}},
    {"clearcoat", {{"clearcoatFactor", kUnit}, {"clearcoatNormalTexture", kTexture}, {"clearcoatRoughnessFactor", kUnit}, {"clearcoatRoughnessTexture", kTexture}, {"clearcoatTexture", kTexture}}},
    {"diffuse transmission", {{"diffuseTransmissionColorFactor", numbers(3, 0)}, {"diffuseTransmissionColorTexture", kTexture}, {"diffuseTransmissionFactor", kUnit}, {"diffuseTransmissionTexture", kTexture}}},
    {"dispersion", {{"dispersion", kFromZero}}},
    {"emissive strength", {{"emissiveStrength", kFromZero}}},
    {"ior", {{"ior", {.is = Is::Number, .low = 1, .flags = kOrZero}}}},
    {"iridescence", {{"iridescenceFactor", kUnit}, {"iridescenceIor", {.is = Is::Number, .low = 1}}, {"iridescenceTexture", kTexture}, {"iridescenceThicknessMaximum", kFromZero},
                     {"iridescenceThicknessMinimum", kFromZero}, {"iridescenceThicknessTexture", kTexture}}},
    {"sheen", {{"sheenColorFactor", kColour}, {"sheenColorTexture", kTexture}, {"sheenRoughnessFactor", kUnit}, {"sheenRoughnessTexture", kTexture}}},
    {"specular", {{"specularColorFactor", numbers(3, 0)}, {"specularColorTexture", kTexture}, {"specularFactor", kUnit}, {"specularTexture", kTexture}}},
    {"specular glossiness", {{"diffuseFactor", numbers(4, 0, 1)}, {"diffuseTexture", kTexture}, {"glossinessFactor", kUnit}, {"specularFactor", kColour}, {"specularGlossinessTexture", kTexture}}},
    {"transmission", {{"transmissionFactor", kUnit}, {"transmissionTexture", kTexture}}},
    {"volume", {{"attenuationColor", kColour}, {"attenuationDistance", kAboveZero}, {"thicknessFactor", kFromZero}, {"thicknessTexture", kTexture}}},
    {"texture transform", {{"offset", numbers(2)}, {"rotation", kNumber}, {"scale", numbers(2)}, {"texCoord", kIndex}}},
};

const char* name_of(Is is) {
    constexpr const char* kNames[]{"text", "true or false", "a whole number", "a number", "a list of text", "a list of whole numbers", "a list of numbers", "an object", "a list of objects"};
    return kNames[static_cast<size_t>(is)];
}

bool matches(const json& value, Is is) {
    switch (is) {
        case Is::Text:
            return value.is_string();
        case Is::Flag:
            return value.is_boolean();
        case Is::Whole:
            return whole_number(value).has_value();
        case Is::Number:
            return value.is_number();
        case Is::Object:
            return value.is_object();
        default:
            return value.is_array();
    }
}

/// What the elements of a list are; those that are no objects are noted elsewhere.
std::optional<Is> element_of(Is list) {
    if (list == Is::Texts) return Is::Text;
    if (list == Is::Wholes) return Is::Whole;
    return list == Is::Numbers ? std::optional(Is::Number) : std::nullopt;
}

class Schema {
public:
    Schema(const GltfLists& lists, const RuleNote& note) : lists_(lists), note_(note) {}

    void check(const json& object, const char* kind, const std::string& at) const {
        const auto properties = kKinds.find(kind);
        if (properties == kKinds.end()) return;  // attributes, which have names of their own
        const bool extensions = kind == std::string_view("extensions");  // those that are no objects are noted elsewhere
        for (const auto& [key, property] : properties->second)
            if (property.flags & kNeeded && !object.contains(key)) note_(at, "has no " + key);
        for (const auto& [key, value] : object.items())
            if (const auto property = properties->second.find(key); property != properties->second.end() && (!extensions || value.is_object())) check(value, property->second, at + "/" + key);
    }

private:
    void check(const json& value, const Property& property, const std::string& at) const {
        if (!matches(value, property.is)) return note_(at, std::string("is not ") + name_of(property.is));
        if (property.is == Is::Object) return check(value, property.kind, at);
        if (property.is == Is::Objects) return GltfLists::each_of(value, at, [&](const json& element, const std::string& place, uint32_t) { check(element, property.kind, place); });
        if (*property.of && *whole_number(value) >= lists_.count(property.of)) return note_(at, "names none of the " + std::to_string(lists_.count(property.of)) + " " + property.of);
        if (value.is_number()) return range(value.get<double>(), property, at);
        if (!value.is_array()) return;
        if (property.length && value.size() != property.length) return note_(at, "has not " + std::to_string(property.length) + " elements");
        elements(value, property, at);
    }
    void elements(const json& list, const Property& property, const std::string& at) const {
        const Is is = *element_of(property.is);
        std::set<json> seen;
        for (size_t i = 0; i < list.size(); ++i) {
            if (!matches(list[i], is)) return note_(at + "/" + std::to_string(i), std::string("is not ") + name_of(is));
            if (is == Is::Number)
                range(list[i].get<double>(), property, at + "/" + std::to_string(i));
            else if (!seen.insert(list[i]).second)
                return note_(at, "names something twice");
        }
    }
    void range(double number, const Property& property, const std::string& at) const {
        if (!std::isfinite(number)) return note_(at, "is not finite");
        if (number == 0 && property.flags & kOrZero) return;
        if (number < property.low || (number == property.low && property.flags & kNotLow)) {
            note_(at, (property.flags & kNotLow ? "is not more than " : "is less than ") + decimal(property.low, 6));
        } else if (number > property.high) {
            note_(at, "is more than " + decimal(property.high, 6));
        }
    }

    const GltfLists& lists_;
    const RuleNote& note_;
};

}  // namespace

void check_schema(const GltfLists& lists, const RuleNote& note) { Schema(lists, note).check(lists.root(), "glTF", ""); }

}  // namespace vesper
