// glTF meshes: any accessors to triangles of one vertex format. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scene/gltf_reader.h"
#include "scene/mesh.h"

namespace vesper {
namespace {

enum class Mode : uint8_t { Points, Lines, LineLoop, LineStrip, Triangles, Strip, Fan };

/// Material for primitives that name none: grey, reflectance 0.5, Lambert.
uint32_t default_material(GltfReader& reader) {
    if (reader.default_material == kNone) {
        Material grey;
        grey.name = "default";
        grey.base_colour = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);  // glTF's own, white metal, would be black at night
        reader.scene.materials.push_back(grey);
        reader.uv_mappings.emplace_back();
        reader.default_material = static_cast<uint32_t>(reader.scene.materials.size() - 1);
    }
    return reader.default_material;
}

/// Corner numbers of a list, strip or fan to a list of triangles.
std::vector<uint32_t> triangles(GltfReader& reader, const std::vector<uint32_t>& corners, Mode mode) {
    std::vector<uint32_t> list;
    const size_t count = corners.size();
    const auto add = [&](size_t a, size_t b, size_t c) {
        const uint32_t i = corners[a], j = corners[b], k = corners[c];
        if (i != j && j != k && k != i) list.insert(list.end(), {i, j, k});  // strips are joined by empty triangles
    };
    if (mode == Mode::Triangles) {
        list.reserve(count);
        for (size_t i = 0; i + 2 < count; i += 3) add(i, i + 1, i + 2);
        if (count % 3 != 0)
            reader.notes.add("a primitive whose corners are no multiple of three: the rest is left out");
    } else if (mode == Mode::Strip) {
        list.reserve(3 * count);
        for (size_t i = 0; i + 2 < count; ++i) i % 2 == 0 ? add(i, i + 1, i + 2) : add(i + 1, i, i + 2);
    } else {
        list.reserve(3 * count);
        for (size_t i = 1; i + 1 < count; ++i) add(i, i + 1, 0);
    }
    return list;
}

/// Normals from the file; those of no direction are made from the triangles around.
void take_normals(GltfReader& reader, Primitive& primitive, const Floats& normals) {
    std::vector<char> missing(primitive.vertices.size(), 0);
    bool any = false;
    for (size_t i = 0; i < primitive.vertices.size(); ++i) {
        const auto n = normals[i];
        const glm::dvec3 normal(n[0], n[1], n[2]);
        const double length = glm::length(normal);
        const bool usable = length > 1e-6 && std::isfinite(length);
        primitive.vertices[i].normal = usable ? glm::vec3(normal / length) : glm::vec3(0);
        missing[i] = !usable;
        any = any || !usable;
    }
    if (!any) return;
    reader.notes.add("a primitive with normals of no direction: those are made from its triangles");
    fill_normals(primitive, missing);
}

void take_uv(GltfReader& reader, Primitive& primitive, const Floats& coordinates) {
    const UvMapping& mapping = reader.uv_mappings[primitive.material];
    bool all_finite = true;
    for (size_t i = 0; i < primitive.vertices.size(); ++i) {
        const glm::vec2 uv = mapping.apply({coordinates[i][0], coordinates[i][1]});
        const bool finite = std::isfinite(uv.x) && std::isfinite(uv.y);
        if (finite) primitive.vertices[i].uv = uv;
        all_finite = all_finite && finite;
    }
    if (!all_finite) reader.notes.add("a primitive with texture coordinates that are not finite: those are read as 0");
}

void take_colours(GltfReader& reader, Primitive& primitive, const Floats& colours) {
    bool all_inside = true;
    for (size_t i = 0; i < primitive.vertices.size(); ++i) {
        for (uint32_t c = 0; c < colours.components; ++c) {
            const float value = colours[i][c];
            all_inside = all_inside && value >= 0 && value <= 1;
            const float limited = std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f);
            primitive.vertices[i].colour[c] = static_cast<uint16_t>(std::lround(limited * 65535));
        }
    }
    if (!all_inside) reader.notes.add("a primitive with vertex colours outside [0, 1]: those are limited to it");
}

/// Exporters let many primitives share one large set of vertices: each keeps those it uses.
void drop_unused(Primitive& primitive) {
    std::vector<uint32_t> place(primitive.vertices.size(), kNone);
    std::vector<Vertex> used;
    for (uint32_t& index : primitive.indices) {
        if (place[index] == kNone) {
            place[index] = static_cast<uint32_t>(used.size());
            used.push_back(primitive.vertices[index]);
        }
        index = place[index];
    }
    primitive.vertices = std::move(used);
}

/// Where the data is compressed, accessors may be empty shells: to be told from those that mean zeros.
void refuse_compressed(GltfReader& reader, const JsonValue& primitive, const JsonValue& position) {
    const auto extensions = primitive.find("extensions");
    if (extensions && extensions->find("KHR_draco_mesh_compression") &&
        !reader.document.element("accessors", position).find("bufferView"))
        primitive.fail("is compressed with KHR_draco_mesh_compression, which is not supported");
}

std::vector<Vertex> read_positions(GltfReader& reader, const JsonValue& primitive, const JsonValue& reference, const std::vector<float>& weights) {
    Floats positions = read_floats(reader.document, reference, {"VEC3"}, reader.limits.vertices);
    take_decoded(reader, reference, positions.count);
    add_targets(reader, primitive, "POSITION", weights, positions);
    std::vector<Vertex> vertices(positions.count);
    for (size_t i = 0; i < vertices.size(); ++i) {
        const auto p = positions[i];
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
            reader.document.element("accessors", reference).fail("position " + std::to_string(i) + " is not finite");
        vertices[i].position = {p[0], p[1], p[2]};
    }
    return vertices;
}

std::vector<uint32_t> read_corners(GltfReader& reader, const JsonValue& primitive, size_t vertices) {
    const uint64_t left = reader.limits.indices - reader.indices;
    if (const auto reference = primitive.find("indices"))
        return read_indices(reader.document, *reference, left, vertices);
    if (vertices > left) primitive.fail("takes the meshes over the limit of indices");
    std::vector<uint32_t> corners(vertices);
    for (uint32_t i = 0; i < corners.size(); ++i) corners[i] = i;
    return corners;
}

void spend(const JsonValue& primitive, uint64_t& used, uint64_t more, uint64_t limit, const char* what) {
    if (more > limit - used) primitive.fail("takes the meshes over the limit of " + std::to_string(limit) + " " + what);
    used += more;
}

/// Nothing for what is not made of triangles.
std::optional<Primitive> read_primitive(GltfReader& reader, const JsonValue& source, const Pose& pose) {
    const auto mode = static_cast<Mode>(source.integer_or("mode", 4, 6));
    const JsonValue attributes = source.at("attributes");
    const auto position = attributes.find("POSITION");
    if (mode < Mode::Triangles || !position) {
        reader.notes.add(position ? "a primitive of points or lines is left out"
                                  : "a primitive without positions is left out");
        return std::nullopt;
    }
    refuse_compressed(reader, source, *position);
    Primitive made;
    if (const auto material = source.find("material"))
        made.material = material->index(reader.document.list("materials").size(), "materials");
    else
        made.material = default_material(reader), reader.notes.add("a primitive without material is shown matt grey, of reflectance 0.5");
    made.vertices = read_positions(reader, source, *position, pose.weights);
    const size_t count = made.vertices.size();
    made.indices = triangles(reader, read_corners(reader, source, count), mode);
    spend(source, reader.indices, made.indices.size(), reader.limits.indices, "indices");

    const std::string uv_set = "TEXCOORD_" + std::to_string(reader.uv_mappings[made.material].set);
    if (const auto uv = read_attribute(reader, attributes, uv_set, count, {"VEC2"}))
        take_uv(reader, made, *uv);
    else
        check_needs_no_uv(reader, made.material, attributes, uv_set);
    if (const auto colours = read_attribute(reader, attributes, "COLOR_0", count, {"VEC3", "VEC4"}))
        take_colours(reader, made, *colours);
    auto normals = read_attribute(reader, attributes, "NORMAL", count, {"VEC3"});
    if (normals) {
        add_targets(reader, source, "NORMAL", pose.weights, *normals);
        take_normals(reader, made, *normals);
    }
    if (pose.skin) bend(reader, attributes, *pose.skin, made);
    if (normals) {
        drop_unused(made);
        spend(source, reader.vertices, made.vertices.size(), reader.limits.vertices, "vertices");
    } else {
        spend(source, reader.vertices, made.indices.size(), reader.limits.vertices, "vertices");
        make_flat(made);
    }

    if (source.find("targets")) reader.notes.add("a primitive with morph targets is shown at rest");
    for (const Vertex& vertex : made.vertices) made.bounds.add(vertex.position);
    if (made.indices.empty()) return std::nullopt;
    return made;
}

Mesh make_mesh(GltfReader& reader, const JsonValue& source, Pose pose) {
    Mesh mesh;
    mesh.name = source.text_or("name", "");
    if (pose.weights.empty()) pose.weights = morph_weights(source);
    take_decoded(reader, source, pose.weights.size());
    for (const JsonValue& primitive : source.at("primitives").elements())
        if (auto made = read_primitive(reader, primitive, pose)) mesh.primitives.push_back(std::move(*made));
    return mesh;
}

}  // namespace

void check_mesh(GltfReader& reader, const JsonValue& mesh) { make_mesh(reader, mesh, {}); }

std::optional<Floats> read_attribute(GltfReader& reader, const JsonValue& attributes, const std::string& name, size_t count,
                                     std::initializer_list<std::string_view> types) {
    const auto reference = attributes.find(name.c_str());
    if (!reference) return std::nullopt;
    Floats floats = read_floats(reader.document, *reference, types, reader.limits.vertices);
    if (floats.count != count)
        reference->fail(name + " has " + std::to_string(floats.count) + " elements, POSITION " + std::to_string(count));
    return floats;
}

void take_decoded(GltfReader& reader, const JsonValue& at, uint64_t count) {
    // The same accessor may be named by any number of primitives.
    reader.decoded += count;
    if (reader.decoded / 8 > reader.limits.vertices) at.fail("the primitives together read their vertices too often");
}

uint32_t read_mesh(GltfReader& reader, const JsonValue& reference, const Pose& pose) {
    const JsonValue source = reader.document.element("meshes", reference);
    const auto [place, is_new] = reader.meshes.try_emplace({reference.index(UINT32_MAX, "meshes"), pose.skin_index, pose.weights}, kNone);
    if (!is_new) return place->second;
    reader.scene.meshes.push_back(make_mesh(reader, source, pose));
    return place->second = static_cast<uint32_t>(reader.scene.meshes.size() - 1);
}

}  // namespace vesper
