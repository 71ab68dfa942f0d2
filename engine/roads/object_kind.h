// Kinds of road objects, from the words that describe them. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/road_network.h"

namespace vesper::roads {

enum class ObjectKind : uint8_t {
    Other,
    StreetLamp,
    GuidePost,
    Pole,    ///< masts and posts too
    Gantry,  ///< over the road: mast arms, sign bridges, catenaries
    Railing,
    Barrier,  ///< fences too
    Tree,     ///< vegetation too
    Bush,
    Building,
    Crosswalk,
    ParkingSpace,
    RoadMark,  ///< stop lines too
    Patch,
    Island
};

/// The kind by words (base/words.h) of the type, else the subtype, else the name. A pole may become a street lamp, a
/// guide post or a gantry, vegetation a bush. Lights of signals and warning lamps are no street lamps.
ObjectKind kind_of(const RoadObject& object);

/// True if a pole has no name but its kind or a number.
bool is_unnamed(const RoadObject& pole);

/// True if objects of the kind lie flat on the road, independent of the stated height.
bool is_flat(ObjectKind kind);

}  // namespace vesper::roads
