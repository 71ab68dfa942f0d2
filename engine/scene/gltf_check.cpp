// Types, lengths and references in the parts of a glTF file that tinygltf reads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>
#include <string_view>

#include "scene/gltf_model.h"

namespace vesper::scene {
namespace {

class PartsCheck {
public:
    explicit PartsCheck(GltfDocument& document) : document_(document) {}

    void check() {
        each("bufferViews", [&](const JsonValue& one) {
            one.at("buffer").index(size("buffers"), "buffers");
            one.integer_or("byteOffset", 0);
            one.at("byteLength").integer();
        });
        each("accessors", [&](const JsonValue& one) { accessor(one); });
        each("meshes", [&](const JsonValue& one) { mesh(one); });
        each("nodes", [&](const JsonValue& one) { node(one); });
        each("scenes", [&](const JsonValue& one) { references(one, "nodes", "nodes"); });
        each("materials", [&](const JsonValue& one) { material(one); });
        each("textures",
             [&](const JsonValue& one) { reference(one, "sampler", "samplers"), reference(one, "source", "images"); });
        each("samplers", [&](const JsonValue& one) {
            for (const char* key : {"wrapS", "wrapT", "magFilter"}) whole(one, key);
        });
        each("skins", [&](const JsonValue& one) {
            reference(one, "inverseBindMatrices", "accessors");
            references(one, "joints", "nodes");
        });
        each("animations", [&](const JsonValue& one) { animation(one); });
    }

private:
    void accessor(const JsonValue& one) {
        static constexpr std::string_view kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
        const JsonValue type = one.at("type");
        if (std::find(std::begin(kTypes), std::end(kTypes), type.text()) == std::end(kTypes))
            type.fail("is no accessor type of glTF");
        const JsonValue component = one.at("componentType");
        if (const uint64_t number = component.integer(); number < 5120 || number > 5126)
            component.fail("is no component type of glTF");
        one.at("count").integer();
        reference(one, "bufferView", "bufferViews");
        one.integer_or("byteOffset", 0);
        one.boolean_or("normalized", false);
        const auto sparse = one.find("sparse");
        if (!sparse) return;
        sparse->at("count").integer(INT32_MAX);
        for (const char* part : {"indices", "values"}) {
            const JsonValue elements = sparse->at(part);
            elements.at("bufferView").index(size("bufferViews"), "bufferViews");
            whole(elements, "byteOffset");
        }
        sparse->at("indices").at("componentType").integer(INT32_MAX);
    }

    void mesh(const JsonValue& one) {
        numbers(one, "weights");
        for (const JsonValue& primitive : one.at("primitives").elements()) {
            attributes(primitive.at("attributes"));
            for (const JsonValue& target : primitive.elements_of("targets")) attributes(target);
            reference(primitive, "material", "materials");
            primitive.integer_or("mode", 4, 6);
            reference(primitive, "indices", "accessors");
            stored(primitive);
        }
    }
    /// Where the data is compressed, accessors may be empty shells: to be told from those that mean zeros.
    void stored(const JsonValue& primitive) {
        const auto extensions = primitive.find("extensions");
        const bool compressed = extensions && extensions->find("KHR_draco_mesh_compression");
        const auto position = primitive.at("attributes").find("POSITION"), indices = primitive.find("indices");
        const auto is_empty = [&](const std::optional<JsonValue>& accessor) {
            return accessor && !document_.element("accessors", *accessor).find("bufferView");
        };
        if (compressed && (is_empty(position) || is_empty(indices)))
            primitive.fail("is compressed with KHR_draco_mesh_compression, which Vesper was built without (libdraco)");
        if (is_empty(indices)) indices->fail("names an accessor without a buffer view");
    }
    void attributes(const JsonValue& holder) {
        for (const JsonValue& accessor : holder.members()) accessor.index(size("accessors"), "accessors");
    }

    void node(const JsonValue& one) {
        for (const auto& [key, list] : {std::pair("mesh", "meshes"), {"skin", "skins"}, {"camera", "cameras"}})
            reference(one, key, list);
        references(one, "children", "nodes");
        numbers(one, "weights");
        for (const auto& [key, count] : {std::pair("matrix", 16), {"translation", 3}, {"rotation", 4}, {"scale", 3}})
            numbers(one, key, count);
    }

    void material(const JsonValue& one) {
        one.text_or("alphaMode", "");
        one.boolean_or("doubleSided", false);
        one.number_or("alphaCutoff", 0);
        numbers(one, "emissiveFactor", 3);
        texture(one, "emissiveTexture");
        const auto factors = one.find("pbrMetallicRoughness");
        if (!factors) return;
        numbers(*factors, "baseColorFactor", 4);
        for (const char* key : {"metallicFactor", "roughnessFactor"}) factors->number_or(key, 1);
        for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"}) texture(*factors, key);
    }
    void texture(const JsonValue& holder, const char* key) {
        const auto info = holder.find(key);
        if (!info) return;
        info->at("index").index(size("textures"), "textures");
        info->integer_or("texCoord", 0, 1000);
    }

    void animation(const JsonValue& one) {
        const auto samplers = one.at("samplers").elements();
        for (const JsonValue& sampler : samplers) {
            for (const char* key : {"input", "output"}) sampler.at(key).index(size("accessors"), "accessors");
            sampler.text_or("interpolation", "");
        }
        for (const JsonValue& channel : one.at("channels").elements()) {
            channel.at("sampler").index(samplers.size(), "samplers");
            reference(channel.at("target"), "node", "nodes");
            channel.at("target").at("path").text();
        }
    }

    template <class Check>
    void each(const char* list, const Check& check) {
        for (const JsonValue& element : document_.list(list)) {
            if (!element.json().is_object()) element.fail("must be an object");
            element.text_or("name", "");
            check(element);
        }
    }
    size_t size(const char* list) { return document_.list(list).size(); }
    void reference(const JsonValue& holder, const char* key, const char* list) {
        if (const auto found = holder.find(key)) found->index(size(list), list);
    }
    void references(const JsonValue& holder, const char* key, const char* list) {
        for (const JsonValue& one : holder.elements_of(key)) one.index(size(list), list);
    }
    void whole(const JsonValue& holder, const char* key) { holder.integer_or(key, 0, INT32_MAX); }
    void numbers(const JsonValue& holder, const char* key, size_t count = 0) {
        if (const auto found = holder.find(key))
            for (const JsonValue& number : found->elements(count)) number.number();
    }

    GltfDocument& document_;
};

}  // namespace

void check_parts(GltfDocument& document) { PartsCheck(document).check(); }

}  // namespace vesper::scene
