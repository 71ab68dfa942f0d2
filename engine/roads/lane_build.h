// Building lanes and kerbs from a road network. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/lanes.h"

namespace vesper::roads {

/// All lanes with their poses and neighbours, and their links as the file states them.
std::vector<Lane> build_lanes(const RoadNetwork& network);
/// Links lanes that meet without a link in the file.
void link_where_they_meet(std::vector<Lane>& lanes);
std::vector<Kerb> build_kerbs(const RoadNetwork& network);

}  // namespace vesper::roads
