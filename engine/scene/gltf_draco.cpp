// KHR_draco_mesh_compression. SPDX-License-Identifier: MIT
#include "scene/gltf_compressed.h"
#include "scene/gltf_document.h"

#ifdef VESPER_DRACO
#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <optional>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>

#include "base/budget.h"
#include "scene/tinygltf.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

constexpr const char* kExtension = "KHR_draco_mesh_compression";
constexpr uint16_t kBitstream = DRACO_BITSTREAM_VERSION(2, 2);  // the extension allows no other
// Of tables of the mesh and of each attribute, and of values beside themselves.
constexpr uint64_t kBytesOfFace = 200, kBytesOfSeams = 30, kBytesOfCopies = 4;

/// A decoder of Draco that announces its memory before it takes it, for as long as it lives.
template <class Decoder>
class Bounded : public Decoder {
public:
    /// Elements beyond `most` throw Error at `place`.
    Bounded(uint64_t most, const JsonValue& place) : most_(most), place_(place) {}

private:
    bool DecodeConnectivity() override {
        if (this->bitstream_version() != kBitstream) return false;
        draco::DecoderBuffer ahead = *this->buffer();
        // Edgebreaker states vertices, then faces; the other faces, then points. Points are at most the corners.
        uint32_t first = 0, second = 0;
        uint8_t attributes = 0;  // of edgebreaker: those with tables of their own
        if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead) || !ahead.Decode(&attributes))
            return false;
        if (std::max(first, second) > most_)
            place_.fail("takes the meshes over the limit of " + std::to_string(most_) + " vertices");
        tables_.emplace(std::max<uint64_t>(first, second) * (kBytesOfFace + kBytesOfSeams * attributes));
        return Decoder::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override {
        const draco::PointCloud& points = *this->point_cloud();
        uint64_t bytes = 0;
        for (int i = 0; i < points.num_attributes(); ++i)
            bytes += uint64_t{points.num_points()} * static_cast<uint64_t>(points.attribute(i)->num_components()) * 8;
        values_.emplace(bytes * kBytesOfCopies);
        return Decoder::DecodeAllAttributes();
    }

    uint64_t most_;
    JsonValue place_;
    std::optional<TemporaryMemory> tables_, values_;
};

std::unique_ptr<draco::Mesh> decode(std::span<const uint8_t> bytes, uint64_t most, const JsonValue& place) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) place.fail("is no Draco geometry");
    if (header.encoder_type != draco::TRIANGULAR_MESH) place.fail("is a point cloud, and no mesh");
    Bounded<draco::MeshEdgebreakerDecoder> edgebreaker(most, place);
    Bounded<draco::MeshSequentialDecoder> sequential(most, place);
    auto& decoder = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                        ? static_cast<draco::MeshDecoder&>(edgebreaker)
                        : static_cast<draco::MeshDecoder&>(sequential);
    auto mesh = std::make_unique<draco::Mesh>();
    if (const draco::Status status = decoder.Decode(draco::DecoderOptions(), &buffer, mesh.get()); !status.ok())
        place.fail("is damaged Draco geometry, or not of bitstream 2.2: " + status.error_msg_string());
    return mesh;
}

/// Bytes of an accessor, element by element without gaps.
template <class Number>
std::vector<uint8_t> values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute, uint32_t components,
                               const JsonValue& place) {
    const size_t element = components * sizeof(Number);
    spend(mesh.num_points() * element);
    std::vector<uint8_t> bytes(mesh.num_points() * element);
    std::vector<Number> value(components);
    for (uint32_t i = 0; i < mesh.num_points(); ++i) {
        check_time();
        const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
        if (at.value() >= attribute.size() ||
            !attribute.ConvertValue<Number>(at, static_cast<int8_t>(components), value.data()))
            place.fail("has values that do not fit the accessor");
        std::memcpy(bytes.data() + i * element, value.data(), element);
    }
    return bytes;
}

std::vector<uint8_t> values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                               const JsonValue& accessor) {
    static const std::map<std::string, uint32_t> kComponents{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    const auto components = kComponents.find(accessor.at("type").text());
    if (components == kComponents.end() || static_cast<int>(components->second) != attribute.num_components())
        accessor.fail("has another number of components than the compressed attribute");
    const uint32_t count = components->second;
    switch (accessor.at("componentType").integer(INT32_MAX)) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return values_of<int8_t>(mesh, attribute, count, accessor);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return values_of<uint8_t>(mesh, attribute, count, accessor);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return values_of<int16_t>(mesh, attribute, count, accessor);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return values_of<uint16_t>(mesh, attribute, count, accessor);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return values_of<uint32_t>(mesh, attribute, count, accessor);
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return values_of<float>(mesh, attribute, count, accessor);
        default:
            accessor.at("componentType").fail("is no component type of glTF");
    }
}

std::vector<uint8_t> corners_of(const draco::Mesh& mesh) {
    spend(uint64_t{mesh.num_faces()} * 3 * sizeof(uint32_t));
    std::vector<uint8_t> bytes(size_t{mesh.num_faces()} * 3 * sizeof(uint32_t));
    for (uint32_t i = 0; i < mesh.num_faces(); ++i) {
        const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(i));
        const uint32_t corners[]{face[0].value(), face[1].value(), face[2].value()};
        std::memcpy(bytes.data() + i * sizeof corners, corners, sizeof corners);
    }
    return bytes;
}

/// The place of an accessor's elements in the buffer that is added.
struct Filled {
    uint64_t offset = 0, length = 0, count = 0;
    bool indices = false;
};

/// A primitive that has been expanded; `listed`: its corners are a list of triangles now.
struct Done {
    size_t mesh, primitive;
    bool listed;
};

class Expansion {
public:
    explicit Expansion(GltfDocument& document) : document_(document) {}

    void run() {
        const auto meshes = document_.list("meshes");
        for (size_t m = 0; m < meshes.size(); ++m) {
            const std::vector<JsonValue> primitives = meshes[m].at("primitives").elements();
            for (size_t p = 0; p < primitives.size(); ++p) {
                const auto extensions = primitives[p].find("extensions");
                const auto compression = extensions ? extensions->find(kExtension) : std::nullopt;
                if (!compression) continue;
                done_.push_back({m, p, expand(primitives[p], *compression)});
            }
        }
        write();
    }

private:
    bool is_empty(uint32_t accessor) {
        return !document_.list("accessors")[accessor].find("bufferView") && !filled_.contains(accessor);
    }

    void fill(uint32_t accessor, std::vector<uint8_t> bytes, uint64_t count, bool indices) {
        filled_[accessor] = {bytes_.size(), bytes.size(), count, indices};
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
    }

    /// Whether the triangles of the primitive come from its geometry.
    bool expand(const JsonValue& primitive, const JsonValue& compression) {
        const size_t accessors = document_.list("accessors").size();
        // Attributes by their names: the accessor in the primitive, the number in the compressed geometry.
        std::map<uint32_t, uint32_t> wanted;
        const JsonValue stated = primitive.at("attributes"), numbers = compression.at("attributes");
        for (const auto& [name, number] : numbers.json().items())
            if (const auto accessor = stated.find(name.c_str()))
                if (const uint32_t index = accessor->index(accessors, "accessors"); is_empty(index))
                    wanted.emplace(index, static_cast<uint32_t>(numbers.at(name.c_str()).integer(UINT32_MAX)));
        const auto indices = primitive.find("indices");
        const bool wants_indices = indices && is_empty(indices->index(accessors, "accessors"));
        if (wanted.empty() && !wants_indices) return false;
        const auto mesh = decode(
            document_.view(compression.at("bufferView").index(document_.list("bufferViews").size(), "bufferViews")),
            document_.limits().vertices, compression);
        for (const auto& [accessor, number] : wanted) {
            const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(number);
            if (!attribute) numbers.fail("the compressed geometry has no attribute " + std::to_string(number));
            fill(accessor, values_of(*mesh, *attribute, document_.list("accessors")[accessor]), mesh->num_points(),
                 false);
        }
        if (wants_indices)
            fill(indices->index(accessors, "accessors"), corners_of(*mesh), uint64_t{mesh->num_faces()} * 3, true);
        return wants_indices;
    }

    void write() {
        if (done_.empty()) return;
        const size_t first = document_.list("bufferViews").size(), buffer = document_.list("buffers").size();
        json& root = document_.edit();
        size_t view = first;
        for (const auto& [index, filled] : filled_) {
            json& accessor = root["accessors"][index];
            accessor["bufferView"] = view++, accessor["count"] = filled.count;
            accessor.erase("byteOffset");
            if (filled.indices) accessor["componentType"] = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
            root["bufferViews"].push_back(
                {{"buffer", buffer}, {"byteOffset", filled.offset}, {"byteLength", filled.length}});
        }
        for (const Done& done : done_) {
            json& primitive = root["meshes"][done.mesh]["primitives"][done.primitive];
            if (done.listed) primitive["mode"] = TINYGLTF_MODE_TRIANGLES;
            erase_extension(primitive, kExtension);
        }
        if (!bytes_.empty()) document_.add_buffer(std::move(bytes_));
    }

    GltfDocument& document_;
    std::vector<uint8_t> bytes_;
    std::map<uint32_t, Filled> filled_;  // by accessor
    std::vector<Done> done_;
};

}  // namespace

bool reads_draco() { return true; }

void expand_draco(GltfDocument& document) { Expansion(document).run(); }

}  // namespace vesper::scene

#else

namespace vesper::scene {

bool reads_draco() { return false; }
void expand_draco(GltfDocument&) {}

}  // namespace vesper::scene

#endif
