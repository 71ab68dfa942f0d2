// Paint of objects on roads. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "roads/object_kind.h"
#include "roads/object_places.h"

namespace vesper::roads {

/// Paints objects of one road. Places are (s, t) of that road, m.
struct ObjectPaint {
    RoadBuild& build;
    const Road& road;
    RoadMesh& mesh;
    size_t pieces = 0;                    ///< of everything, for the bound
    ObjectKind kind = ObjectKind::Other;  ///< of the object under way

    /// Paint, or a patch: on the surface, whatever it does.
    glm::dvec3 on_surface(double s, double t, double over) const;
    /// (s, t) of a point of an object's frame, by its plan about the object's own place.
    glm::dvec2 road_place(const RoadObject& object, const Placed& at, double u, double v) const;
    /// The paint of an arrow between two corners in the object's plan, and none of a stencil whose shape is not known;
    /// false: the object is neither.
    bool stencil(const RoadObject& object, const Placed& at, glm::dvec2 low, glm::dvec2 high);
    /// A stencil whose outline is the rectangle around it.
    bool framed_stencil(const RoadObject& object, const Placed& at, const ObjectOutline& outline);
    void flat_rectangle(const RoadObject& object, const Placed& at);
    glm::dvec2 corner_place(const RoadObject& object, const Placed& at, const ObjectCorner& corner) const;
    /// Paint of a width along a line on the road, in dashes.
    void painted(glm::dvec2 from, glm::dvec2 to, const ObjectMarking& marking);
    void markings(const RoadObject& object, const Placed& at, const ObjectOutline& outline);
    /// A crossing whose paint the file does not state: bars of 0.5 m along the road.
    void zebra(const std::vector<glm::dvec2>& places);
    void boundary(const std::vector<glm::dvec2>& places);
};

}  // namespace vesper::roads
