// Cells that a wall or a slab goes through. SPDX-License-Identifier: MIT
#pragma once

#include "rays/ray_caster.h"
#include "transport/cell_places.h"

namespace vesper::transport {

/// A quarter of a cube before a surface of a cell, so that what is carved or laid on it hides nothing.
glm::dvec3 before(const CellGrid& grid, uint32_t number, glm::dvec3 point);

/// Where a wall or a slab goes through its cube, so that most places see it along an axis or a diagonal, a cell is cut
/// there: what is on the side of the cube's middle is left, or on the other if no place is on that. Surfaces beyond
/// have the light of the cube there. A cell of one or two places is not cut.
void cut(CellPlaces& cell, uint32_t number, const CellGrid& grid, const rays::RayCaster& rays);

/// Whether something that cuts it nowhere stands between its places: it is between half of the pairs at least, as two
/// walls are, and a post is not where there are many places.
bool is_split(const CellPlaces& cell, uint32_t number, const CellGrid& grid, const rays::RayCaster& rays);

}  // namespace vesper::transport
