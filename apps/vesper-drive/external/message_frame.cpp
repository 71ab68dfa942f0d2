#include "external/message_frame.h"

#include <cmath>

namespace vesper::drive {
namespace {

glm::dvec3 turned(const glm::dvec3& p, double yaw) {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

}  // namespace

glm::dvec3 MessageFrame::point(const glm::dvec3& p) const {
    const glm::dvec3 t = turned(p, yaw);
    return at + glm::dvec3(t.x, t.z, -t.y);
}

glm::dvec3 MessageFrame::back(const glm::dvec3& world) const {
    const glm::dvec3 p = world - at;
    return turned({p.x, -p.z, p.y}, -yaw);
}

MessageFrame frame_of(const MessageSource& source, const glm::dvec3& roads) {
    const glm::dvec3 at = glm::dvec3(source.origin) - roads;
    return {.yaw = source.origin.w, .at = {at.x, at.z, -at.y}};
}

}  // namespace vesper::drive
