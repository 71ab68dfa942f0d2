#include "session/drive_events.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vesper::drive {

using Kind = DriveEvent::Kind;

void DriveEvents::push_back(const DriveEvent& event) {
    kinds_.push_back(event.kind);
    if (event.kind == Kind::Set) changes_.push_back({event.name, event.value, event.place});
    if (event.kind != Kind::Step) return;
    if (inputs_.empty() || inputs_.back().input != event.input) inputs_.push_back({steps_, event.input});
    if (event.pose) {
        poses_.resize(steps_, glm::dvec4(std::numeric_limits<double>::quiet_NaN()));
        poses_.push_back(*event.pose);
    }
    if (event.shown) {
        shown_.resize(steps_, std::numeric_limits<double>::quiet_NaN());
        shown_.push_back(*event.shown);
    }
    ++steps_;
}

size_t DriveEvents::frames() const { return size_t(std::count(kinds_.begin(), kinds_.end(), Kind::Frame)); }

DriveEvents::Iterator& DriveEvents::Iterator::operator++() {
    step_ += event_.kind == Kind::Step;
    set_ += event_.kind == Kind::Set;
    ++at_;
    read();
    return *this;
}

void DriveEvents::Iterator::read() {
    if (at_ == events_->size()) return;
    event_ = {.kind = events_->kinds_[at_], .input = {}, .pose = {}, .shown = {}, .name = {}, .value = {}};
    if (event_.kind == Kind::Step) {
        const std::vector<Held>& inputs = events_->inputs_;
        if (input_ + 1 < inputs.size() && inputs[input_ + 1].from == step_) ++input_;
        event_.input = inputs[input_].input;
        if (step_ < events_->poses_.size() && !std::isnan(events_->poses_[step_].x))
            event_.pose = events_->poses_[step_];
        if (step_ < events_->shown_.size() && !std::isnan(events_->shown_[step_]))
            event_.shown = events_->shown_[step_];
    }
    if (event_.kind == Kind::Set) {
        const Change& change = events_->changes_[set_];
        event_.name = change.name, event_.value = change.value, event_.place = change.place;
    }
}

}  // namespace vesper::drive
