#include "gpu_scene/sky.h"

#include "shared/sky.h"

namespace vesper {
namespace {

static_assert(shared::kSpecularSide == kSpecularSide && shared::kSkyLobes == kSkyLobes);
static_assert(shared::kSkyLobeSide == kSkyLobeSide);

void append(std::vector<glm::vec4>& texels, const OctahedralMap& map) {
    texels.insert(texels.end(), map.texels.begin(), map.texels.end());
}

}  // namespace

std::vector<glm::vec4> sky_texels(const SkyMap& map) {
    std::vector<glm::vec4> texels;
    for (const glm::dvec3& factor : map.irradiance) texels.emplace_back(glm::vec3(factor), 0);
    for (const Reflected& fraction : specular_table())
        texels.emplace_back(float(fraction.scale), float(fraction.offset), 0, 0);
    for (const OctahedralMap& lobe : map.lobes) append(texels, lobe);
    append(texels, map.sharp);
    return texels;
}

}  // namespace vesper
