// Places and sizes of objects and their copies. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "roads/lit_road_parts.h"

namespace vesper::roads {

constexpr size_t kMaxCopies = 200'000;  ///< objects and copies of a network

/// An object, or one copy of it, with its sizes, m.
struct Placed {
    double s = 0, t = 0, z = 0;
    double length = 0, width = 0, height = 0, radius = 0;
};

Placed whole_object(const RoadObject&);
/// The copy at a fraction of a repeat.
Placed copy_of(const RoadObject&, const ObjectRepeat&, double fraction);
/// Its frame: x along its length. Orientation says for whom an object is, not how it stands.
BodyFrame object_frame(const Road&, const RoadObject&, const Placed&);

/// Calls visit(placed) for each copy of a repeat with a distance, on the road, until it returns false.
template <class Visit>
bool visit_copies(const Road& road, const RoadObject& object, const ObjectRepeat& repeat, const Visit& visit) {
    const double last = std::min(repeat.length, std::max(road.length - repeat.s, 0.0));
    for (double along = 0; along <= last + 1e-9; along += std::max(repeat.distance, 0.01))
        if (!visit(copy_of(object, repeat, repeat.length > 0 ? along / repeat.length : 0))) return false;
    return true;
}

}  // namespace vesper::roads
