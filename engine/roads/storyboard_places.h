// Places and distances of a run, for conditions and actions. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include "roads/storyboard_conditions.h"

namespace vesper::roads {

/// Extent in plan: the box of an entity, or a point of a position.
struct StoryBox {
    glm::dvec2 reference{0}, centre{0}, half{0};  ///< m
    glm::dvec2 ahead{1, 0};                       ///< unit
    double speed = 0;                             ///< m/s

    glm::dvec2 left() const { return {-ahead.y, ahead.x}; }
    static StoryBox of(const RunEntity& entity, double time);
    static StoryBox of(glm::dvec3 point);
};

/// Measure of a distance, as in esmini: straight, or along the heading of the entity asked about, or across it.
struct Measure {
    enum class Along : uint8_t { Straight, Longitudinal, Lateral };
    Along along = Along::Straight;
    bool free_space = false;  ///< between the boxes, not between the reference points

    /// Distance, m; negative behind, or to the right.
    double distance(const StoryBox& from, const StoryBox& to) const;
};

/// The measure of relativeDistanceType (unless `fixed`), coordinateSystem and freespace. Unsupported ones give a note.
Measure measure_of(const XmlElement& element, const Parameters& scope, StoryTime& story,
                   std::optional<Measure::Along> fixed = std::nullopt);

/// A world, lane or road position in the file's frame, of the child Position or the element itself.
std::optional<glm::dvec3> position_of(const XmlElement& holder, const Parameters& scope, const StoryTime& story);

}  // namespace vesper::roads
