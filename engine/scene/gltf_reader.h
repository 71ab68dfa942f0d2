// The parts of the glTF reader, and what they share. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/gltf_document.h"

namespace vesper::scene {

/// What the user should know, each said once with how often it applies.
class Notes {
public:
    void add(const std::string& text) {
        if (++times_[text] == 1) order_.push_back(text);
    }
    std::vector<std::string> lines() const;

private:
    std::map<std::string, uint64_t> times_;
    std::vector<std::string> order_;
};

/// How the vertices of a material get their uv: a TEXCOORD set and KHR_texture_transform.
struct UvMapping {
    uint32_t set = 0;
    glm::vec2 offset{0}, scale{1};
    float rotation = 0;  ///< rad

    glm::vec2 apply(glm::vec2 uv) const;
    bool operator==(const UvMapping&) const = default;
};

/// The same of a material: of its emission, and of its other textures.
struct MaterialUv {
    UvMapping surface, emission;
};

/// In `image_of`: not looked at. kNone there: a picture that cannot be read.
constexpr uint32_t kUnread = kNone - 1;

/// Reflectance of a surface whose file does not say one: no material, or a missing picture times a white factor.
constexpr float kImpliedReflectance = 0.5f;

/// Joints at rest, with their inverse bind matrices: vertices as modelled to the frame of a node.
struct Skin {
    uint32_t frame = kNone;  ///< node of the file; kNone: the world
    std::vector<glm::dmat4> joints;
};

/// What a node does to its mesh. `weights` of morph targets; empty: the mesh's own.
struct Pose {
    std::vector<float> weights{};
    uint32_t skin_index = kNone;
    const Skin* skin = nullptr;
};

/// State of one reading. The index of a thing in the file is `*_of[...]` in the scene, or kNone.
struct GltfReader {
    GltfDocument& document;
    const SceneLimits& limits;
    Scene scene{};
    SceneSource source{};
    Notes notes{};
    std::vector<MaterialUv> uv_mappings{};  ///< one per scene material
    std::vector<uint32_t> node_of{}, image_of{};
    std::map<uint32_t, std::string> unread_images{};  ///< why, for those that are kNone in image_of
    /// Scene mesh for a mesh of the file, the skin that puts it in place or kNone, and the node's weights.
    std::map<std::tuple<uint32_t, uint32_t, std::vector<float>>, uint32_t> meshes{};
    std::map<uint32_t, bool> jointed{};               ///< see hangs_on_joints
    std::set<uint32_t> skinned{};                     ///< nodes of the file whose mesh a skin puts in place
    bool photometric = false;                         ///< there is an extras block
    std::map<uint32_t, glm::dvec4> specular_means{};  ///< of pictures that specularGlossinessTextures name
    std::set<uint32_t> unknown_lights{};              ///< of a type that glTF does not have: no node shows them
    uint32_t punctual_lights = 0;                     ///< those of KHR_lights_punctual, the first of the scene's
    /// Scene light of a distribution, with its multiplier and colour.
    std::map<std::tuple<uint32_t, float, float, float, float>, uint32_t> measured_lights{};
    std::vector<photometry::LuminousOpening>
        profile_openings{};  ///< of distributions, from the extras block; may be shorter
    uint64_t vertices = 0, indices = 0, texels = 0, keys = 0;  ///< kept so far
    uint64_t decoded = 0;                                      ///< vertices read so far, also those not kept
};

/// How the uv of a textureInfo object are mapped: texCoord and KHR_texture_transform.
UvMapping read_uv_mapping(const JsonValue& info);
/// Wrapping and magnification of a sampler of the file.
void read_sampler(GltfReader& reader, uint32_t index, TextureUse& use);
/// The scene's image for a texture of the file; kNone, with a note, if it has no picture that can be read.
uint32_t read_picture(GltfReader& reader, uint32_t texture);
void read_materials(GltfReader& reader);
/// The scene's mesh for a mesh of the file, read when first needed.
uint32_t read_mesh(GltfReader& reader, uint32_t index, const Pose& pose = {});
/// An attribute beside POSITION, of `count` elements as that has.
std::optional<Floats> read_attribute(GltfReader& reader, const GltfPart<tinygltf::Primitive>& primitive,
                                     const std::string& name, size_t count, std::initializer_list<int> types);
/// Counts elements read; throws where all of them are over eight times the limit of vertices.
void take_decoded(GltfReader& reader, const JsonValue& at, uint64_t count);

/// Whether every primitive of a mesh says on which joints its vertices hang.
bool hangs_on_joints(GltfReader& reader, uint32_t mesh);
/// Draws the meshes of `skinned`, each on a node of its own. Nodes have been read.
void read_skinned(GltfReader& reader, const std::vector<uint32_t>& parents);
/// Adds the morph targets of an attribute to it.
void add_targets(GltfReader& reader, const GltfPart<tinygltf::Primitive>& primitive, const char* attribute,
                 const std::vector<float>& weights, Floats& values);
/// Puts vertices where their joints are.
void bend(GltfReader& reader, const GltfPart<tinygltf::Primitive>& source, const Skin& skin, Primitive& primitive);

/// Reads a mesh that nothing refers to and forgets it.
void check_mesh(GltfReader& reader, uint32_t mesh);
void read_lights(GltfReader& reader);
/// Distributions of EXT_lights_ies.
void read_distributions(GltfReader& reader);
/// The scene's light for a use of one by a node.
uint32_t read_measured_light(GltfReader& reader, const JsonValue& use);
void read_nodes(GltfReader& reader);
/// The transform of a node of the file, on a node of nothing else.
Node read_placed(const GltfPart<tinygltf::Node>& source);
uint32_t add_node(GltfReader& reader, const JsonValue& source, Node node);
void read_animations(GltfReader& reader);
/// The extras block of a converted file (docs/gltf.md).
void read_photometry_block(GltfReader& reader);
/// "fixtures" of that block. Nodes have been read.
void read_fixtures(GltfReader& reader);
/// "reflection_tables" and "roads" of that block.
void read_reflection_tables(GltfReader& reader, const JsonValue& block);
/// "retroreflectors" and "retroreflective".
void read_retroreflectors(GltfReader& reader, const JsonValue& block);
/// "luminance_pictures" and "luminous". Before meshes are read: the pictures need their uv.
void read_luminance_pictures(GltfReader& reader, const JsonValue& block);
/// Throws for a primitive without texture coordinates whose material shows such a picture. Other textures are then read
/// at (0, 0); a luminance would be arbitrary.
void check_needs_no_uv(const GltfReader& reader, uint32_t material, const JsonValue& attributes,
                       const std::string& set);
/// "environment".
void read_environment(GltfReader& reader, const JsonValue& source);

/// All of the above in order, and the checks that need the whole scene.
void read_all(GltfReader& reader);

}  // namespace vesper::scene
