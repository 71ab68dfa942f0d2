#include "transport/placed_triangles.h"

namespace vesper::transport {

std::vector<PlacedPrimitive> primitives_of(const scene::Scene& scene, std::span<const glm::dmat4> world) {
    std::vector<PlacedPrimitive> all;
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == scene::kNone) continue;
        const std::vector<scene::Primitive>& primitives = scene.meshes[scene.nodes[node].mesh].primitives;
        const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(world[node])));
        for (uint32_t p = 0; p < primitives.size(); ++p) {
            const scene::Material& material = scene.materials[primitives[p].material];
            if (!material.clear) all.push_back({primitives[p], node, p, material.double_sided, world[node], turn});
        }
    }
    return all;
}

}  // namespace vesper::transport
