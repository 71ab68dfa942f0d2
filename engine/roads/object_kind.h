// What an object of a road is, by the words that describe it. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include "roads/road_network.h"

namespace vesper::roads {

enum class ObjectKind : uint8_t {
    Other,
    StreetLamp,
    GuidePost,
    Pole,
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

/// Its type says, else its subtype, else its name: whole words, that end at what is no letter and at capitals. A pole may
/// be found to be a street lamp or a guide post, vegetation to be a bush.
ObjectKind kind_of(const RoadObject& object);

/// Whether it lies on the road, whatever height above it the file reserves.
bool is_flat(ObjectKind kind);

}  // namespace vesper::roads
