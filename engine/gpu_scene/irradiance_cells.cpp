#include "gpu_scene/irradiance_cells.h"

#include <bit>
#include <cmath>
#include <optional>

#include <glm/gtc/packing.hpp>

#include "shared/indirect.h"

namespace vesper::gpu_scene {

static_assert(shared::kCellSides == transport::kSides && shared::kAirCubes == transport::CellGrid::kAir);

namespace {

// The number of the cell beyond the border that the surface of a cell is near, if it is and there is no such cell.
std::optional<uint32_t> stands_for(const transport::Radiosity& radiosity, size_t i) {
    const transport::CellGrid& grid = radiosity.grid;
    const uint32_t number = radiosity.numbers[i], side = grid.side(number);
    const double height = double(radiosity.heights[i]) / grid.size;
    if (grid.is_air(number) || std::abs(height) < 0.5 - double(shared::kNearBorder)) return std::nullopt;
    const glm::dvec3 cube = glm::floor(grid.place(grid.middle(number)));
    const std::optional<uint32_t> other =
        grid.cell(cube + (height > 0 ? 1.0 : -1.0) * transport::direction_of(side), side);
    return other && !radiosity.find(*other) ? other : std::nullopt;
}

}  // namespace

IrradianceCells irradiance_cells(const transport::Radiosity& radiosity, std::span<const glm::vec3> illuminance) {
    std::vector<std::pair<uint32_t, uint32_t>> numbers;  // and what stands there
    for (uint32_t i = 0; i < radiosity.cells(); ++i) numbers.emplace_back(radiosity.numbers[i], i);
    for (uint32_t i = 0; i < radiosity.cells(); ++i)
        if (const std::optional<uint32_t> other = stands_for(radiosity, i)) numbers.emplace_back(*other, i);
    IrradianceCells table;
    // At most half of the places are taken, so that few others are looked at.
    while ((uint64_t{1} << table.log2_places) < 2 * numbers.size()) ++table.log2_places;
    const uint32_t mask = (1u << table.log2_places) - 1;
    table.texels.assign(size_t{mask} + 1, {shared::kNoCell, 0, 0, 0});
    const float most = 65504 * shared::kCellUnit;  // of halves
    for (const auto& [number, i] : numbers) {
        uint32_t place = number * shared::kCellHash >> (32 - table.log2_places);
        while (table.texels[place].x != shared::kNoCell && table.texels[place].x != number) place = (place + 1) & mask;
        if (table.texels[place].x == number) continue;  // two stand for it: the first
        const auto over = float(radiosity.grid.height(number, radiosity.grid.middle(radiosity.numbers[i])));
        const uint32_t walls = radiosity.walls.empty() ? 0 : radiosity.walls[i];
        const glm::vec3 light = glm::min(illuminance[i], glm::vec3(most)) / shared::kCellUnit;
        table.texels[place] = {number, glm::packHalf2x16({light.r, light.g}),
                               glm::packHalf2x16({light.b, 0}) | walls << 16u,
                               std::bit_cast<uint32_t>((radiosity.heights[i] + over) / float(radiosity.grid.size))};
    }
    return table;
}

}  // namespace vesper::gpu_scene
