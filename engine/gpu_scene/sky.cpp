#include "gpu_scene/sky.h"

#include "shared/sky.h"

namespace vesper::gpu_scene {
namespace {

static_assert(shared::kSpecularSide == photometry::kSpecularSide && shared::kSkyLobes == photometry::kSkyLobes);
static_assert(shared::kSkyLobeSide == photometry::kSkyLobeSide);

void append(std::vector<glm::vec4>& texels, const photometry::OctahedralMap& map) {
    texels.insert(texels.end(), map.texels.begin(), map.texels.end());
}

}  // namespace

std::vector<glm::vec4> sky_texels(const photometry::SkyMap& map) {
    std::vector<glm::vec4> texels;
    for (const glm::dvec3& factor : map.irradiance) texels.emplace_back(glm::vec3(factor), 0);
    for (const photometry::Reflected& fraction : photometry::specular_table())
        texels.emplace_back(float(fraction.scale), float(fraction.offset), 0, 0);
    for (const photometry::OctahedralMap& lobe : map.lobes) append(texels, lobe);
    append(texels, map.sharp);
    return texels;
}

}  // namespace vesper::gpu_scene
