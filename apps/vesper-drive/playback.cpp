#include "playback.h"

#include <algorithm>

namespace vesper {

size_t frames_in(const std::vector<DriveEvent>& events) {
    return size_t(std::count_if(events.begin(), events.end(), [](const DriveEvent& e) { return e.kind == DriveEvent::Kind::Frame; }));
}

const DriveEvent* Playback::next(Session& session) {
    if (next_ == events_.size()) return nullptr;
    const DriveEvent& event = events_[next_++];
    switch (event.kind) {
        case DriveEvent::Kind::Step: {
            session.step(event.input);
            const VehicleState& me = session.world().driver();
            strayed_ |= event.pose && glm::dvec4(me.position, me.yaw, me.speed) != *event.pose;
            break;
        }
        case DriveEvent::Kind::Set:
            if (!kept_.contains(event.name)) session.set(event.name, event.value);
            break;
        case DriveEvent::Kind::Restart: session.restart(); break;
        case DriveEvent::Kind::Frame: break;
    }
    return &event;
}

void Playback::rewind(Session& session) {
    session.rewind();
    next_ = 0, strayed_ = false;
}

}  // namespace vesper
