// Places and sizes of objects. SPDX-License-Identifier: MIT
#include "roads/object_places.h"

namespace vesper::roads {

Placed whole_object(const RoadObject& o) { return {o.s, o.t, o.z_offset, o.length, o.width, o.height, o.radius}; }

Placed copy_of(const RoadObject& object, const ObjectRepeat& repeat, double f) {
    Placed at = whole_object(object);
    const auto over = [&](const std::optional<double>& a, const std::optional<double>& b, double fallback) {
        return a ? glm::mix(*a, b.value_or(*a), f) : fallback;
    };
    at.s = repeat.s + repeat.length * f;
    at.t = glm::mix(repeat.t_start, repeat.t_end, f), at.z = glm::mix(repeat.z_start, repeat.z_end, f);
    at.height = over(repeat.height_start, repeat.height_end, at.height),
    at.width = over(repeat.width_start, repeat.width_end, at.width);
    at.length = over(repeat.length_start, repeat.length_end, at.length),
    at.radius = over(repeat.radius_start, repeat.radius_end, at.radius);
    return at;
}

BodyFrame object_frame(const Road& road, const RoadObject& object, const Placed& at) {
    return frame_at(road, at.s, at.t, at.z).turned(object.heading, object.pitch, object.roll);
}

}  // namespace vesper::roads
