#include "gpu_scene/irradiance_cells.h"

#include <glm/gtc/packing.hpp>

#include "photometry/sky_map.h"
#include "shared/indirect.h"

namespace vesper::gpu_scene {

static_assert(shared::kCellFacings == transport::kFacings && shared::kCellSides == transport::kSides);

IrradianceCells irradiance_cells(const transport::Radiosity& radiosity, std::span<const glm::vec3> illuminance) {
    IrradianceCells table;
    // At most half of the places are taken, so that few others are looked at.
    while ((uint64_t{1} << table.log2_places) < 2 * radiosity.cells()) ++table.log2_places;
    const uint32_t mask = (1u << table.log2_places) - 1;
    table.texels.assign(size_t{mask} + 1, {shared::kNoCell, 0, 0, 0});
    const float most = 65504 * shared::kCellUnit;  // of halves
    for (size_t i = 0; i < radiosity.cells(); ++i) {
        const uint32_t number = radiosity.numbers[i];
        uint32_t place = number * shared::kCellHash >> (32 - table.log2_places);
        while (table.texels[place].x != shared::kNoCell) place = (place + 1) & mask;
        const uint32_t walls = radiosity.walls.empty() ? 0 : radiosity.walls[i],
                       cut = radiosity.cuts.empty() ? 0 : radiosity.cuts[i].bits;
        const glm::vec3 light = glm::clamp(illuminance[i], glm::vec3(0), glm::vec3(most)) / shared::kCellUnit;
        table.texels[place] = {
            number, glm::packHalf2x16({light.r, light.g}), glm::packHalf2x16({light.b, 0}) | walls << 16u | cut << 24u,
            glm::packHalf2x16({radiosity.heights[i] / float(radiosity.grid.size), 0}) |
                glm::packSnorm2x8(glm::vec2(photometry::octahedral_place(radiosity.normals[i]))) << 16u};
    }
    return table;
}

}  // namespace vesper::gpu_scene
