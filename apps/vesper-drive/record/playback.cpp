#include "record/playback.h"

namespace vesper::drive {

void perform(Session& session, const DriveEvent& event) {
    switch (event.kind) {
        case DriveEvent::Kind::Step:
            session.step(event.input, event.shown);
            break;
        case DriveEvent::Kind::Set:
            session.set(event.name, event.value);
            break;
        case DriveEvent::Kind::Restart:
            session.restart();
            break;
        case DriveEvent::Kind::Frame:
            break;
    }
}

std::optional<DriveEvent::Kind> Playback::next(Session& session) {
    if (next_ == events_.end()) return std::nullopt;
    DriveEvent event = *next_;
    const bool steps = event.kind == DriveEvent::Kind::Step;
    if (steps && !event.shown && live_moment) event.shown = live_moment();
    if (event.kind != DriveEvent::Kind::Set || !kept_.contains(event.name)) perform(session, event);
    const traffic::VehicleState& me = session.world().driver();
    strayed_ |= steps && event.pose && glm::dvec4(me.position, me.yaw, me.speed) != *event.pose;
    ++next_;
    return event.kind;
}

void Playback::rewind(Session& session) {
    session.rewind();
    next_ = events_.begin(), strayed_ = false;
}

}  // namespace vesper::drive
