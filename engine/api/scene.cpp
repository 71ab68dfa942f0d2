// Scenes from files and from arrays. SPDX-License-Identifier: MIT
#include <set>
#include <tuple>

#include "api/handles.h"
#include "base/luminance.h"
#include "io/named_file.h"
#include "io/read_file.h"
#include "photometry/table.h"
#include "scene/mesh.h"
#include "scene/read_scene.h"

namespace vesper::api {
namespace {

constexpr uint32_t kMostTexels = 16384;  // of a texture, in width or height

uint32_t added(size_t count) { return uint32_t(count - 1); }

bool fractions(const float (&values)[3]) {
    return std::all_of(values, values + 3, [](float v) { return v >= 0 && v <= 1; });
}

/// A colour that may be none, as a luminance and a colour of luminance 1.
std::pair<float, glm::vec3> split(const float rgb[3], const char* otherwise) {
    const glm::vec3 colour = vector(rgb);
    for (int c = 0; c < 3; ++c) require(colour[c] >= 0 && colour[c] <= 1e9f, otherwise);
    const float y = float(luminance(colour));
    return {y, y > 0 ? colour / y : glm::vec3(1)};
}

scene::Primitive primitive_of(const scene::Scene& scene, const VesperMesh& m) {
    require(m.material < scene.materials.size(), "the scene has no such material");
    require(m.vertex_count >= 3 && m.positions && m.index_count >= 3 && m.index_count % 3 == 0 && m.indices,
            "a mesh has positions, and three indices per triangle");
    const auto all_finite = [&](const float* values, size_t each) {
        return !values || std::all_of(values, values + each * m.vertex_count, [](float v) { return std::isfinite(v); });
    };
    require(all_finite(m.positions, 3) && all_finite(m.normals, 3) && all_finite(m.uvs, 2),
            "positions, normals and uvs are finite");
    require(std::all_of(m.indices, m.indices + m.index_count, [&](uint32_t i) { return i < m.vertex_count; }),
            "an index is less than the number of vertices");
    scene::Primitive made;
    made.material = m.material;
    made.vertices.resize(m.vertex_count);
    std::vector<char> missing(m.vertex_count);  // normals
    for (size_t i = 0; i < m.vertex_count; ++i) {
        scene::Vertex& vertex = made.vertices[i];
        vertex.position = vector(m.positions + 3 * i);
        if (m.normals) {
            vertex.normal = scene::unit_or_up(vector(m.normals + 3 * i));
            missing[i] = vector(m.normals + 3 * i) == glm::vec3(0);
        }
        if (m.uvs) vertex.uv = {m.uvs[2 * i], m.uvs[2 * i + 1]};
        made.bounds.add(vertex.position);
    }
    made.indices.assign(m.indices, m.indices + m.index_count);
    if (!m.normals)
        scene::make_flat(made);
    else if (std::find(missing.begin(), missing.end(), 1) != missing.end())
        scene::fill_normals(made, missing);
    return made;
}

/// The lamp's frame: -z along its axis, +y as near to `up` as can be.
glm::quat turned(const VesperLamp& lamp) {
    const glm::dvec3 axis = direction(lamp.axis, "a lamp's axis has a direction");
    if (vector(lamp.up) == glm::vec3(0)) return glm::quat(glm::vec3(0, 0, -1), glm::vec3(axis));
    constexpr const char* kTwo = "a lamp's axis and up are two directions";
    const glm::dvec3 x = glm::cross(direction(lamp.up, kTwo), -axis);
    require(glm::length(x) > 1e-6, kTwo);
    const glm::dvec3 right = glm::normalize(x);
    return glm::quat_cast(glm::mat3(right, glm::cross(-axis, right), -axis));
}

/// The number of the distribution of a file, one for all lamps while the file is as it was.
uint32_t distribution_of(VesperScene& scene, const std::string& file) {
    std::pair key(file, io::read_file(file, photometry::kMaxTableBytes));
    if (const auto known = scene.distributions.find(key); known != scene.distributions.end()) return known->second;
    scene.scene.distributions.push_back(photometry::read_distribution(file));
    return scene.distributions[std::move(key)] = added(scene.scene.distributions.size());
}

/// A lamp, but for what was measured.
scene::Lamp lamp_of(const VesperLamp& l) {
    require(finite(l.position) && finite(l.axis) && finite(l.up) && finite(l.colour) && l.intensity >= 0 &&
                std::isfinite(l.intensity),
            "a lamp has a place, an axis, at least 0 cd and a colour");
    const auto [y, colour] = split(l.colour, "a lamp's colour has no negative part");
    require(y > 0, "a lamp's colour has luminance");
    require(l.inner_cone >= 0 && l.outer_cone >= l.inner_cone && l.outer_cone <= 1.5707964f,
            "a lamp's cones are 0 <= inner <= outer <= pi / 2");
    require(l.opening_width >= 0 && l.opening_width <= 1000 && l.opening_height >= 0 && l.opening_height <= 1000,
            "a lamp's opening is 0 to 1000 m wide and high");
    require((l.opening_width > 0) == (l.opening_height > 0), "a lamp's opening has a width and a height, or neither");
    require(!l.distribution || (l.inner_cone == 0 && l.outer_cone == 0), "a lamp has cones or a distribution");
    scene::Lamp lamp;
    lamp.intensity = l.intensity, lamp.colour = colour;
    lamp.inner_cone = l.inner_cone, lamp.outer_cone = l.outer_cone;
    lamp.kind = l.distribution     ? scene::Lamp::Kind::Measured
                : l.outer_cone > 0 ? scene::Lamp::Kind::Spot
                                   : scene::Lamp::Kind::Point;
    if (l.opening_width > 0 && l.opening_height > 0) lamp.opening = {l.opening_width, l.opening_height, 0, false};
    return lamp;
}

void add(scene::Scene& scene, scene::Node node, uint32_t* number) {
    scene.nodes.push_back(std::move(node));
    if (number) *number = added(scene.nodes.size());
}

}  // namespace

extern "C" {

VesperResult vesper_scene_create(VesperScene** scene, VesperError* error) {
    return guarded(error, [&] {
        require(scene, "the pointer to the scene is null");
        *scene = new VesperScene;
    });
}

VesperResult vesper_scene_read(const char* file, VesperScene** scene, VesperError* error) {
    return guarded(error, [&] {
        require(file && scene, "the file, or the pointer to the scene, is null");
        *scene = new VesperScene{scene::read_scene(file).scene, 0, {}};
    });
}
VesperResult vesper_scene_read_allowing(const char* file, const char* folder, VesperScene** scene, VesperError* error) {
    return guarded(error, [&] {
        require(file && folder && scene, "the file, the folder, or the pointer to the scene is null");
        const io::AllowedFolder allowed(folder);
        *scene = new VesperScene{scene::read_scene(file).scene, 0, {}};
    });
}
void vesper_scene_destroy(VesperScene* scene) { delete scene; }
uint32_t vesper_scene_node_count(const VesperScene* scene) { return scene ? uint32_t(scene->scene.nodes.size()) : 0; }
const char* vesper_scene_node_name(const VesperScene* scene, uint32_t node) {
    return scene && node < scene->scene.nodes.size() ? scene->scene.nodes[node].name.c_str() : nullptr;
}

VesperResult vesper_scene_add_material(VesperScene* scene, const VesperMaterial* material, uint32_t* index,
                                       VesperError* error) {
    return guarded(error, [&] {
        require(scene && index, "the scene, or the pointer to the index of the material, is null");
        const VesperMaterial m = known(material, "a material without its size");
        require(fractions(m.base_colour) && m.metallic >= 0 && m.metallic <= 1 && m.roughness >= 0 && m.roughness <= 1,
                "reflectance, metallic and roughness are 0 to 1");
        const auto [emitted, emission] = split(m.emission, "a material emits 0 to 1e9 cd/m^2");
        scene::Material made;
        made.base_colour = glm::vec4(vector(m.base_colour), 1);
        made.metallic = m.metallic, made.roughness = m.roughness;
        made.emission = emitted * emission;
        made.double_sided = m.double_sided;
        if (m.texture) {
            require(m.texture_width > 0 && m.texture_height > 0 && m.texture_width <= kMostTexels &&
                        m.texture_height <= kMostTexels,
                    "a texture is 1 to 16384 pixels wide and high");
            Image image{"", m.texture_width, m.texture_height, {}};
            image.rgba.assign(m.texture, m.texture + size_t{4} * m.texture_width * m.texture_height);
            scene->scene.images.push_back(std::move(image));
            made.base_colour_texture.image = added(scene->scene.images.size());
        }
        scene->scene.materials.push_back(made);
        *index = added(scene->scene.materials.size());
    });
}

VesperResult vesper_scene_add_mesh(VesperScene* scene, const VesperMesh* mesh, uint32_t* index, VesperError* error) {
    return guarded(error, [&] {
        require(scene && index, "the scene, or the pointer to the index of the mesh, is null");
        scene->scene.meshes.push_back({"", {primitive_of(scene->scene, known(mesh, "a mesh without its size"))}});
        *index = added(scene->scene.meshes.size());
    });
}

VesperResult vesper_scene_add_node(VesperScene* scene, const char* name, uint32_t mesh, const float* node_to_world,
                                   uint32_t* node, VesperError* error) {
    return guarded(error, [&] {
        require(scene && node, "the scene, or the pointer to the index of the node, is null");
        require(
            mesh == VESPER_NONE || (mesh < scene->scene.meshes.size() && !scene->scene.meshes[mesh].primitives.empty()),
            "the scene has no such mesh");
        scene::Node made;
        made.name = name ? name : "";
        made.mesh = mesh;
        if (node_to_world) made.matrix = place_of(node_to_world);
        add(scene->scene, std::move(made), node);
        if (mesh != VESPER_NONE) ++scene->version;
    });
}

VesperResult vesper_scene_add_lamp(VesperScene* scene, const VesperLamp* lamp, uint32_t* node, VesperError* error) {
    return guarded(error, [&] {
        require(scene, "no scene");
        const VesperLamp l = known(lamp, "a lamp without its size");
        scene::Lamp made = lamp_of(l);
        scene::Node placed;
        placed.name = "lamp", placed.lamp = uint32_t(scene->scene.lamps.size());
        placed.translation = vector(l.position);
        if (made.kind != scene::Lamp::Kind::Point) placed.rotation = turned(l);
        if (l.distribution) {
            made.distribution = distribution_of(*scene, l.distribution);
            if (made.opening.length == 0) made.opening = scene->scene.distributions[made.distribution].opening;
        }
        add(scene->scene, std::move(placed), nullptr);
        try {
            scene->scene.lamps.push_back(std::move(made));
        } catch (...) {
            scene->scene.nodes.pop_back();
            throw;
        }
        if (node) *node = added(scene->scene.nodes.size());
        ++scene->version;
    });
}

VesperResult vesper_scene_attach(VesperScene* scene, uint32_t node, uint32_t to, VesperError* error) {
    return guarded(error, [&] {
        require(scene, "no scene");
        require(node < scene->scene.nodes.size() && to < node, "the parent of a node must be an earlier node");
        scene->scene.nodes[node].parent = to;
    });
}

VesperResult vesper_scene_remove(VesperScene* scene, uint32_t node, VesperError* error) {
    return guarded(error, [&] {
        require(scene, "no scene");
        std::vector<scene::Node>& nodes = scene->scene.nodes;
        require(node < nodes.size(), "the scene has no such node");
        std::vector<bool> below(nodes.size());  // and the node itself
        scene->gone.resize(nodes.size());
        std::set<uint32_t> unused;  // meshes
        for (size_t i = node; i < nodes.size(); ++i) {
            below[i] = i == node || (nodes[i].parent != scene::kNone && below[nodes[i].parent]);
            if (!below[i]) continue;
            scene->gone[i] = true;
            unused.insert(nodes[i].mesh);
            nodes[i].mesh = nodes[i].lamp = nodes[i].camera = scene::kNone;
        }
        for (const scene::Node& left : nodes) unused.erase(left.mesh);  // kNone, too: that of the node itself
        for (const uint32_t mesh : unused) scene->scene.meshes[mesh].primitives = {};
        ++scene->version;
    });
}

VesperResult vesper_scene_set_sky(VesperScene* scene, const float illuminance[3], const float luminance[3],
                                  VesperError* error) {
    return guarded(error, [&] {
        require(scene && illuminance && luminance, "no scene, or no light");
        const auto ambient = split(illuminance, "ambient light is 0 to 1e9 lx"),
                   sky = split(luminance, "a sky has 0 to 1e9 cd/m^2");
        scene::Scene& lit = scene->scene;
        std::tie(lit.ambient_illuminance, lit.ambient_colour) = ambient;
        std::tie(lit.sky_luminance, lit.sky_colour) = sky;
        lit.environment.reset();
        ++scene->version;
    });
}

}  // extern "C"

}  // namespace vesper::api
