#include "playback.h"

namespace vesper::drive {

std::optional<DriveEvent::Kind> Playback::next(Session& session) {
    if (next_ == events_.end()) return std::nullopt;
    const DriveEvent& event = *next_;
    const DriveEvent::Kind kind = event.kind;
    switch (event.kind) {
        case DriveEvent::Kind::Step: {
            session.step(event.input, event.shown || !live_moment ? event.shown : live_moment());
            const traffic::VehicleState& me = session.world().driver();
            strayed_ |= event.pose && glm::dvec4(me.position, me.yaw, me.speed) != *event.pose;
            break;
        }
        case DriveEvent::Kind::Set:
            if (!kept_.contains(event.name)) session.set(event.name, event.value);
            break;
        case DriveEvent::Kind::Restart:
            session.restart();
            break;
        case DriveEvent::Kind::Frame:
            break;
    }
    ++next_;
    return kind;
}

void Playback::rewind(Session& session) {
    session.rewind();
    next_ = events_.begin(), strayed_ = false;
}

}  // namespace vesper::drive
