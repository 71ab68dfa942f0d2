// glTF meshes: any accessors to triangles of one vertex format. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/budget.h"
#include "scene/gltf_reader.h"
#include "scene/mesh.h"

namespace vesper::scene {
namespace {

enum class Mode : uint8_t { Points, Lines, LineLoop, LineStrip, Triangles, Strip, Fan };

/// Material for primitives that name none: grey, Lambert.
uint32_t default_material(GltfReader& reader) {
    if (reader.source.implied_material == kNone) {
        Material grey;
        grey.name = "default";
        grey.base_colour =
            glm::vec4(glm::vec3(kImpliedReflectance), 1.0f);  // glTF's own, white metal, would be black at night
        reader.scene.materials.push_back(grey);
        reader.uv_mappings.emplace_back();
        reader.source.implied_material = static_cast<uint32_t>(reader.scene.materials.size() - 1);
    }
    return reader.source.implied_material;
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

std::string uv_set(const UvMapping& mapping) { return "TEXCOORD_" + std::to_string(mapping.set); }

/// Texture coordinates of vertices, (0, 0) where the file has none. Empty: it has none for any.
std::vector<glm::vec2> read_uv(GltfReader& reader, const GltfPart<tinygltf::Primitive>& primitive,
                               const UvMapping& mapping, size_t count) {
    const auto coordinates = read_attribute(reader, primitive, uv_set(mapping), count, {TINYGLTF_TYPE_VEC2});
    if (!coordinates) return {};
    std::vector<glm::vec2> places(count, glm::vec2(0));
    bool all_finite = true;
    for (size_t i = 0; i < count; ++i) {
        const glm::vec2 uv = mapping.apply({(*coordinates)[i][0], (*coordinates)[i][1]});
        const bool finite = std::isfinite(uv.x) && std::isfinite(uv.y);
        if (finite) places[i] = uv;
        all_finite = all_finite && finite;
    }
    if (!all_finite) reader.notes.add("a primitive with texture coordinates that are not finite: those are read as 0");
    return places;
}

void take_uv(GltfReader& reader, const GltfPart<tinygltf::Primitive>& source, Primitive& primitive) {
    const auto& [surface, emission] = reader.uv_mappings[primitive.material];
    const size_t count = primitive.vertices.size();
    const std::vector<glm::vec2> uv = read_uv(reader, source, surface, count);
    const std::vector<glm::vec2> emitted = emission == surface ? uv : read_uv(reader, source, emission, count);
    for (size_t i = 0; i < count; ++i) {
        Vertex& vertex = primitive.vertices[i];
        vertex.uv = uv.empty() ? glm::vec2(0) : uv[i];
        vertex.emission_shift = (emitted.empty() ? glm::vec2(0) : emitted[i]) - vertex.uv;
    }
    if (!emitted.empty()) return;
    check_needs_no_uv(reader, primitive.material, source.json.at("attributes"), uv_set(emission));
    reader.source.without_uv.emplace_back(static_cast<uint32_t>(reader.scene.meshes.size()), primitive.material);
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

std::vector<Vertex> read_positions(GltfReader& reader, const GltfPart<tinygltf::Primitive>& primitive, int accessor,
                                   const std::vector<float>& weights) {
    Floats positions = read_floats(reader.document, accessor, {TINYGLTF_TYPE_VEC3}, reader.limits.vertices);
    take_decoded(reader, primitive.json, positions.count);
    add_targets(reader, primitive, "POSITION", weights, positions);
    std::vector<Vertex> vertices(positions.count);
    for (size_t i = 0; i < vertices.size(); ++i) {
        const auto p = positions[i];
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
            reader.document.list("accessors")[static_cast<size_t>(accessor)].fail("position " + std::to_string(i) +
                                                                                  " is not finite");
        vertices[i].position = {p[0], p[1], p[2]};
    }
    return vertices;
}

std::vector<uint32_t> read_corners(GltfReader& reader, const GltfPart<tinygltf::Primitive>& primitive,
                                   size_t vertices) {
    const uint64_t left = reader.limits.indices - reader.indices;
    if (primitive->indices >= 0) return read_indices(reader.document, primitive->indices, left, vertices);
    if (vertices > left) primitive.json.fail("takes the meshes over the limit of indices");
    std::vector<uint32_t> corners(vertices);
    for (uint32_t i = 0; i < corners.size(); ++i) corners[i] = i;
    return corners;
}

void take(const JsonValue& primitive, uint64_t& used, uint64_t more, uint64_t limit, const char* what, size_t bytes) {
    if (more > limit - used) primitive.fail("takes the meshes over the limit of " + std::to_string(limit) + " " + what);
    used += more;
    spend(more * bytes);
}

/// Nothing for what is not made of triangles.
std::optional<Primitive> read_primitive(GltfReader& reader, const GltfPart<tinygltf::Primitive>& source,
                                        const Pose& pose) {
    const auto mode = static_cast<Mode>(source->mode);
    const auto position = source->attributes.find("POSITION");
    const bool has_position = position != source->attributes.end();
    if (mode < Mode::Triangles || !has_position) {
        reader.notes.add(has_position ? "a primitive of points or lines is left out"
                                      : "a primitive without positions is left out");
        return std::nullopt;
    }
    Primitive made;
    if (source->material >= 0)
        made.material = static_cast<uint32_t>(source->material);
    else
        made.material = default_material(reader),
        reader.notes.add("a primitive without material is shown matt grey, of reflectance 0.5");
    made.vertices = read_positions(reader, source, position->second, pose.weights);
    const size_t count = made.vertices.size();
    made.indices = triangles(reader, read_corners(reader, source, count), mode);
    take(source.json, reader.indices, made.indices.size(), reader.limits.indices, "indices", sizeof(uint32_t));

    take_uv(reader, source, made);
    if (const auto colours = read_attribute(reader, source, "COLOR_0", count, {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}))
        take_colours(reader, made, *colours);
    auto normals = read_attribute(reader, source, "NORMAL", count, {TINYGLTF_TYPE_VEC3});
    if (normals) {
        add_targets(reader, source, "NORMAL", pose.weights, *normals);
        take_normals(reader, made, *normals);
    }
    if (pose.skin) bend(reader, source, *pose.skin, made);
    if (normals) {
        drop_unused(made);
        take(source.json, reader.vertices, made.vertices.size(), reader.limits.vertices, "vertices", sizeof(Vertex));
    } else {
        take(source.json, reader.vertices, made.indices.size(), reader.limits.vertices, "vertices", sizeof(Vertex));
        make_flat(made);
    }

    if (!source->targets.empty()) reader.notes.add("a primitive with morph targets is shown at rest");
    for (const Vertex& vertex : made.vertices) made.bounds.add(vertex.position);
    if (made.indices.empty()) return std::nullopt;
    return made;
}

Mesh make_mesh(GltfReader& reader, uint32_t index, Pose pose) {
    const auto source = reader.document.mesh(index);
    Mesh mesh;
    mesh.name = source->name;
    if (pose.weights.empty()) pose.weights.assign(source->weights.begin(), source->weights.end());
    take_decoded(reader, source.json, pose.weights.size());
    const std::vector<JsonValue> primitives = source.json.at("primitives").elements();
    for (size_t i = 0; i < source->primitives.size(); ++i)
        if (auto made = read_primitive(reader, {&source->primitives[i], primitives[i]}, pose))
            mesh.primitives.push_back(std::move(*made));
    return mesh;
}

}  // namespace

void check_mesh(GltfReader& reader, uint32_t mesh) {
    const size_t known = reader.source.without_uv.size();
    make_mesh(reader, mesh, {});
    reader.source.without_uv.resize(known);
}

std::optional<Floats> read_attribute(GltfReader& reader, const GltfPart<tinygltf::Primitive>& primitive,
                                     const std::string& name, size_t count, std::initializer_list<int> types) {
    const auto found = primitive->attributes.find(name);
    if (found == primitive->attributes.end()) return std::nullopt;
    Floats floats = read_floats(reader.document, found->second, types, reader.limits.vertices);
    if (floats.count != count)
        primitive.json.at("attributes")
            .at(name.c_str())
            .fail(name + " has " + std::to_string(floats.count) + " elements, POSITION " + std::to_string(count));
    return floats;
}

void take_decoded(GltfReader& reader, const JsonValue& at, uint64_t count) {
    // The same accessor may be named by any number of primitives.
    reader.decoded += count;
    if (reader.decoded / 8 > reader.limits.vertices) at.fail("the primitives together read their vertices too often");
}

uint32_t read_mesh(GltfReader& reader, uint32_t index, const Pose& pose) {
    const auto [place, is_new] = reader.meshes.try_emplace({index, pose.skin_index, pose.weights}, kNone);
    if (!is_new) return place->second;
    reader.scene.meshes.push_back(make_mesh(reader, index, pose));
    return place->second = static_cast<uint32_t>(reader.scene.meshes.size() - 1);
}

}  // namespace vesper::scene
