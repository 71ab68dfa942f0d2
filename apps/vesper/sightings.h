// Where on its way a car's driver sees an obstacle. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::commands {

/// The visibility level at a distance, m: negative where the obstacle is darker than what is around it; none where it
/// could not be measured.
struct LevelAt {
    double distance = 0;
    std::optional<double> level;
};

/// A part of the way where |VL| is at least a level, m before the obstacle.
struct Sighting {
    double from = 0, to = 0;   ///< from >= to
    bool open_before = false;  ///< no level is known before: the obstacle may be seen from farther away
    bool open_after = false;   ///< no level is known after, though it is not the end of the way
    bool to_end = false;       ///< it is seen up to the last distance
};

/// The parts of a way, from far to near. Between two distances the signed VL is linear: an obstacle that turns from
/// dark to bright is not seen in between. A distance that is not measured ends a part.
std::vector<Sighting> sightings(std::span<const LevelAt>, double level);
/// From where an obstacle is seen on a way, such as "beyond 100 to 71 m, from 38.2 m": beyond, where no level is known
/// before; "to 71 m at least", where none is known after. Without any: "never", "never where it is measured", or
/// kNotMeasured.
std::string words_of(std::span<const LevelAt>, double level);
constexpr const char* kNotMeasured = "not measured";

/// |VL| over distance as a line: the same linear VL in small steps, at least `least`; NaN where it is not measured.
std::vector<glm::dvec2> level_line(std::span<const LevelAt>, double least);

}  // namespace vesper::commands
