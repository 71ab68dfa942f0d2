// A generated street and a generated town, to measure how time grows with lamps and triangles. SPDX-License-Identifier:
// MIT
#pragma once

#include "scene/scene.h"

namespace vesper::bench {

/// A straight road, 14 m wide, between walls of 15 m, of at least so many triangles. Lamps stand in pairs, one pair
/// every 12 m, 6.5 m high: more lamps make a longer street (of at least 400 m). They shine with 1,500 cd within 80
/// degrees of straight down; or as `luminaire` says: "point", 1,500 cd all around; "none", not at all; or as a
/// distribution's file, aimed down, scaled to the flux that the point sends downwards, 9,425 lm. The eye, 1.2 m above
/// the road, drives along it at 50 km/h for 10 s. Throws Error, of files.
scene::Scene lamp_street(uint32_t lamps, uint64_t triangles, const std::string& luminaire = "");

/// A square kilometre of 10 x 10 houses, 86 m wide and 15 m high, between streets 14 m wide, of at least so many
/// triangles. Lamps as of lamp_street() stand evenly around the houses, 1 m from their walls and 6.5 m high: more lamps
/// stand closer. The eye drives as there along the street in the middle, across two others. Throws Error, of files.
scene::Scene lamp_town(uint32_t lamps, uint64_t triangles, const std::string& luminaire = "");

}  // namespace vesper::bench
