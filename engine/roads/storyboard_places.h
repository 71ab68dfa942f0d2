// Where things of a run are, and how far apart: what conditions and actions measure. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include "roads/storyboard_conditions.h"

namespace vesper::roads {

/// What something takes up seen from above: of entities their box, of positions a point.
struct StoryBox {
    glm::dvec2 reference{0}, centre{0}, half{0};  ///< m
    glm::dvec2 ahead{1, 0};                       ///< unit
    double speed = 0;                             ///< m/s

    glm::dvec2 left() const { return {-ahead.y, ahead.x}; }
    static StoryBox of(const RunEntity& entity, double time);
    static StoryBox of(glm::dvec3 point);
};

/// How a distance is measured, as esmini does: straight, or along the heading of the entity asked about, or across it.
struct Measure {
    enum class Along : uint8_t { Straight, Longitudinal, Lateral };
    Along along = Along::Straight;
    bool free_space = false;  ///< between the boxes, not between the reference points

    /// m; negative where what is measured to lies behind, or to the right.
    double distance(const StoryBox& from, const StoryBox& to) const;
};

/// Of relativeDistanceType (unless it is `fixed`), coordinateSystem and freespace. What cannot be measured in is noted.
Measure measure_of(const XmlElement& element, const Parameters& scope, StoryTime& story, std::optional<Measure::Along> fixed = std::nullopt);

/// A world, lane or road position in the file's frame, of the child Position or the element itself.
std::optional<glm::dvec3> position_of(const XmlElement& holder, const Parameters& scope, const StoryTime& story);

}  // namespace vesper::roads
