#include "gpu_scene/occluders.h"

#include <map>
#include <vector>

#include "scene/scene.h"

namespace vesper::gpu_scene {
namespace {

Digest::Value opacity_digest(const Image& image) {
    std::vector<uint8_t> opacity;
    opacity.reserve(image.rgba.size() / 4);
    for (size_t i = 3; i < image.rgba.size(); i += 4) opacity.push_back(image.rgba[i]);
    Digest digest;
    digest.add_value(image.width), digest.add_value(image.height);
    digest.add_list(opacity);
    return digest.value();
}

using OpacityDigests = std::map<uint32_t, Digest::Value>;  // of images

void add_material(Digest& digest, const scene::Scene& scene, const scene::Material& m, OpacityDigests& known) {
    const bool mask = m.alpha == scene::Material::Alpha::Mask;
    digest.add_value(uint32_t(m.clear) << 1u | uint32_t(mask));
    if (m.clear || !mask) return;
    const scene::TextureUse& use = m.base_colour_texture;
    digest.add_value(m.alpha_cutoff), digest.add_value(m.base_colour.a);
    digest.add_value(use.wrap_u), digest.add_value(use.wrap_v), digest.add_value(use.nearest);
    if (use.image == scene::kNone) return;
    if (!known.contains(use.image)) known.emplace(use.image, opacity_digest(scene.images[use.image]));
    digest.add_value(known.at(use.image));
}

void add_mesh(Digest& digest, const scene::Mesh& mesh) {
    digest.add_value(uint64_t{mesh.primitives.size()});
    for (const scene::Primitive& primitive : mesh.primitives) {
        digest.add_value(primitive.material);
        digest.add_value(primitive.bounds.low), digest.add_value(primitive.bounds.high);
        digest.add_list(primitive.vertices);
        digest.add_list(primitive.indices);
    }
}

}  // namespace

Digest::Value occluder_digest(const scene::Scene& scene) {
    static_assert(sizeof(scene::Vertex) == 48, "without padding");
    Digest digest;
    OpacityDigests opacities;
    digest.add_value(uint64_t{scene.materials.size()});
    for (const scene::Material& material : scene.materials) add_material(digest, scene, material, opacities);
    digest.add_value(uint64_t{scene.meshes.size()});
    for (const scene::Mesh& mesh : scene.meshes) add_mesh(digest, mesh);
    for (const scene::Node& node : scene.nodes) digest.add_value(node.mesh);
    return digest.value();
}

}  // namespace vesper::gpu_scene
