// Writing scenes with tinygltf (glTF 2.0, KHR_lights_punctual, EXT_lights_ies, KHR_materials_emissive_strength).
// SPDX-License-Identifier: MIT
#include "scene/gltf_save.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/one_line.h"
#include "io/new_file.h"
#include "scene/gltf_parts.h"
#include "scene/tinygltf.h"

namespace vesper::scene {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

/// Far plane of cameras, in m. tinygltf 2.7 writes one always, and 0 is not allowed; readers of ours ignore it.
constexpr double kFar = 1e6;

/// Names come from files in any encoding; JSON is UTF-8.
std::string utf8(const std::string& text) {
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

/// JSON as tinygltf holds extensions and extras. Whole numbers must fit into an int.
tinygltf::Value value_of(const json& value) {
    switch (value.type()) {
        case json::value_t::object: {
            tinygltf::Value::Object members;
            for (const auto& [key, member] : value.items()) members.emplace(key, value_of(member));
            return tinygltf::Value(std::move(members));
        }
        case json::value_t::array: {
            tinygltf::Value::Array elements;
            for (const json& element : value) elements.push_back(value_of(element));
            return tinygltf::Value(std::move(elements));
        }
        case json::value_t::string:
            return tinygltf::Value(utf8(value.get_ref<const std::string&>()));
        case json::value_t::boolean:
            return tinygltf::Value(value.get<bool>());
        case json::value_t::number_float:
            return tinygltf::Value(value.get<double>());
        default:
            return tinygltf::Value(value.get<int>());
    }
}

std::vector<double> doubles_of(glm::dvec3 v) { return {v.x, v.y, v.z}; }

/// The model under way. Its bytes lie in one buffer.
struct Writer {
    const Scene& scene;
    tinygltf::Model model{};

    explicit Writer(const Scene& of) : scene(of) {
        model.asset.generator = "vesper " VESPER_VERSION;
        model.buffers.emplace_back();
    }

    int view(const void* bytes, size_t size) {
        std::vector<unsigned char>& buffer = model.buffers.front().data;
        while (buffer.size() % 4 != 0) buffer.push_back(0);
        tinygltf::BufferView& made = model.bufferViews.emplace_back();
        made.buffer = 0;
        made.byteOffset = buffer.size();
        made.byteLength = size;
        const auto* first = static_cast<const unsigned char*>(bytes);
        buffer.insert(buffer.end(), first, first + size);
        return static_cast<int>(model.bufferViews.size() - 1);
    }

    template <class Element>
    int accessor(const std::vector<Element>& elements, int component, int type) {
        const int index = view(elements.data(), elements.size() * sizeof(Element));
        tinygltf::Accessor& made = model.accessors.emplace_back();
        made.bufferView = index;
        made.componentType = component;
        made.count = elements.size();
        made.type = type;
        return static_cast<int>(model.accessors.size() - 1);
    }

    void use(const char* extension) {
        std::vector<std::string>& used = model.extensionsUsed;
        if (std::find(used.begin(), used.end(), extension) == used.end()) used.emplace_back(extension);
    }
};

void write_materials(Writer& writer) {
    for (const Material& material : writer.scene.materials) {
        tinygltf::Material& made = writer.model.materials.emplace_back();
        made.name = utf8(material.name);
        const glm::dvec4 c = material.base_colour;
        made.pbrMetallicRoughness.baseColorFactor = {c.r, c.g, c.b, c.a};
        made.pbrMetallicRoughness.metallicFactor = material.metallic;
        made.pbrMetallicRoughness.roughnessFactor = material.roughness;
        made.emissiveFactor = {0, 0, 0};
        if (const EmissionParts emission = emission_parts(material.emission); emission.strength > 0) {
            made.emissiveFactor = doubles_of(emission.factor);
            made.extensions["KHR_materials_emissive_strength"] = value_of({{"emissiveStrength", emission.strength}});
            writer.use("KHR_materials_emissive_strength");
        }
        if (material.alpha == Material::Alpha::Mask) {
            made.alphaMode = "MASK";
            made.alphaCutoff = material.alpha_cutoff;
        }
        if (material.clear) {
            made.extensions["KHR_materials_transmission"] = value_of({{"transmissionFactor", 1}});
            writer.use("KHR_materials_transmission");
        }
        made.doubleSided = material.double_sided;
    }
}

tinygltf::Primitive primitive_of(Writer& writer, const Primitive& primitive) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uv;
    std::vector<std::array<uint16_t, 4>> colours;
    Bounds bounds;
    bool coloured = false, mapped = false;
    for (const Vertex& vertex : primitive.vertices) {
        positions.push_back(vertex.position), normals.push_back(vertex.normal), uv.push_back(vertex.uv),
            colours.push_back(vertex.colour);
        bounds.add(vertex.position);
        coloured = coloured || vertex.colour != Vertex{}.colour;
        mapped = mapped || vertex.uv != glm::vec2(0);
    }
    tinygltf::Primitive made;
    made.mode = TINYGLTF_MODE_TRIANGLES;
    made.material = static_cast<int>(primitive.material);
    made.attributes["POSITION"] = writer.accessor(positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    writer.model.accessors.back().minValues = doubles_of(bounds.low);
    writer.model.accessors.back().maxValues = doubles_of(bounds.high);
    made.attributes["NORMAL"] = writer.accessor(normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    if (mapped) made.attributes["TEXCOORD_0"] = writer.accessor(uv, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
    if (coloured) {
        made.attributes["COLOR_0"] =
            writer.accessor(colours, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
        writer.model.accessors.back().normalized = true;
    }
    made.indices = writer.accessor(primitive.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
    return made;
}

void write_meshes(Writer& writer) {
    for (const Mesh& mesh : writer.scene.meshes) {
        tinygltf::Mesh made;
        made.name = utf8(mesh.name);
        for (const Primitive& primitive : mesh.primitives)
            if (!primitive.indices.empty()) made.primitives.push_back(primitive_of(writer, primitive));
        if (made.primitives.empty()) throw Error("mesh '" + mesh.name + "' has no triangles: glTF cannot hold it");
        writer.model.meshes.push_back(std::move(made));
    }
}

/// The list of lights of an extension of the file.
void add_lights(Writer& writer, const char* extension, json lights) {
    if (lights.empty()) return;
    writer.model.extensions[extension] = value_of({{"lights", std::move(lights)}});
    writer.use(extension);
}

void write_transform(const Node& node, tinygltf::Node& made) {
    if (node.matrix) {
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) made.matrix.push_back((*node.matrix)[c][r]);
        return;
    }
    if (node.translation != glm::dvec3(0)) made.translation = doubles_of(node.translation);
    if (node.rotation != glm::quat(1, 0, 0, 0))
        made.rotation = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
    // tinygltf writes a node that has nothing as null.
    if (node.scale != glm::vec3(1) || node.name.empty()) made.scale = doubles_of(node.scale);
}

void write_nodes(Writer& writer, const std::vector<LampUse>& lamps) {
    tinygltf::Model& model = writer.model;
    tinygltf::Scene scene;
    scene.name = utf8(writer.scene.name);
    model.nodes.resize(writer.scene.nodes.size());
    for (size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = writer.scene.nodes[i];
        tinygltf::Node& made = model.nodes[i];
        made.name = utf8(node.name);
        write_transform(node, made);
        if (node.mesh != kNone) made.mesh = static_cast<int>(node.mesh);
        if (node.camera != kNone) made.camera = static_cast<int>(node.camera);
        if (node.lamp != kNone) made.extensions[lamps.at(node.lamp).extension] = value_of(lamps[node.lamp].value);
        (node.parent == kNone ? scene.nodes : model.nodes[node.parent].children).push_back(static_cast<int>(i));
    }
    if (!scene.nodes.empty() || !scene.name.empty()) {
        model.scenes.push_back(std::move(scene));
        model.defaultScene = 0;
    }
    for (const Camera& camera : writer.scene.cameras) {
        tinygltf::Camera& made = model.cameras.emplace_back();
        made.name = utf8(camera.name);
        made.type = "perspective";
        made.perspective.yfov = camera.vertical_fov;
        made.perspective.znear = camera.near;
        made.perspective.zfar = kFar;
    }
}

void write_animation(Writer& writer) {
    tinygltf::Animation animation;
    animation.name = "drive";
    for (const Channel& channel : writer.scene.channels) {
        const bool turns = channel.path == Channel::Path::Rotation;
        tinygltf::AnimationSampler sampler;
        sampler.input = writer.accessor(channel.times, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR);
        writer.model.accessors.back().minValues = {channel.times.front()};
        writer.model.accessors.back().maxValues = {channel.times.back()};
        const std::vector<glm::vec3> threes(channel.values.begin(), channel.values.end());
        sampler.output = turns ? writer.accessor(channel.values, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4)
                               : writer.accessor(threes, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
        sampler.interpolation = channel.interpolation == Channel::Interpolation::Step    ? "STEP"
                                : channel.interpolation == Channel::Interpolation::Cubic ? "CUBICSPLINE"
                                                                                         : "LINEAR";
        tinygltf::AnimationChannel made;
        made.sampler = static_cast<int>(animation.samplers.size());
        made.target_node = static_cast<int>(channel.node);
        made.target_path = turns ? "rotation" : channel.path == Channel::Path::Scale ? "scale" : "translation";
        animation.channels.push_back(std::move(made));
        animation.samplers.push_back(std::move(sampler));
    }
    if (!animation.channels.empty()) writer.model.animations.push_back(std::move(animation));
}

std::vector<uint8_t> encode(Writer& writer, bool binary) {
    const auto too_large = [&] { return Error("scene '" + writer.scene.name + "': takes more than 4 GiB as glTF"); };
    std::vector<tinygltf::Buffer>& buffers = writer.model.buffers;
    if (buffers.front().data.size() > UINT32_MAX) throw too_large();
    if (buffers.front().data.empty()) buffers.clear();
    std::stringbuf bytes;
    std::ostream stream(&bytes);
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&writer.model, stream, false, binary);
    const std::string file = std::move(bytes).str();
    if (binary && file.size() > UINT32_MAX) throw too_large();
    return {file.begin(), file.end()};
}

}  // namespace

bool is_gltf_name(const std::filesystem::path& file) {
    return file.extension() == ".gltf" || file.extension() == ".glb";
}

void save_gltf(const Scene& scene, const std::string& source, const std::filesystem::path& file) {
    if (!is_gltf_name(file)) throw Error(one_line(file.string()) + ": the output must be named .gltf or .glb");
    if (!scene.images.empty() || !scene.luminance_pictures.empty() || scene.environment)
        throw Error("scene '" + scene.name + "': has pictures, which only its file can give");
    Writer writer(scene);
    write_materials(writer);
    write_meshes(writer);
    const LampParts lamps = lamp_parts(scene, 0, 0, [&](std::span<const uint8_t> bytes) {
        return static_cast<size_t>(writer.view(bytes.data(), bytes.size()));
    });
    add_lights(writer, "KHR_lights_punctual", lamps.lights);
    add_lights(writer, "EXT_lights_ies", lamps.profiles);
    write_nodes(writer, lamps.uses);
    write_animation(writer);
    std::vector<uint32_t> nodes(scene.nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0u);
    json block = photometry_block(scene, lamps, nodes);
    block["provenance"] = {{"input", source}, {"vesper", VESPER_VERSION}};
    writer.model.extras = value_of({{"vesper", std::move(block)}});
    io::replace_file(file, encode(writer, file.extension() == ".glb"));
}

}  // namespace vesper::scene
