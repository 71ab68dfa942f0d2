// Elements of a storyboard by name, and their states. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <deque>

#include "roads/esmini_parts.h"

namespace vesper::roads {

enum class ElementKind : uint8_t { Story, Act, ManeuverGroup, Maneuver, Event, Action, Count };

/// State of an element. Steps of the run; -1: not yet.
struct ElementState {
    enum class Is : uint8_t { Waiting, Standby, Running, Complete };
    Is is = Is::Waiting;  ///< Waiting: the element around it does not run yet
    int started = -1, ended = -1, skipped = -1;
};

class StoryElements {
public:
    /// Enters an element below another (kNone: a story). Throws Error where there are too many, or its path is too
    /// long.
    size_t add(ElementKind kind, const XmlElement& element, const std::string& name, size_t above);
    ElementState& operator[](size_t index) { return entries_[index].state; }
    size_t size() const { return entries_.size(); }

    void start(size_t index, int step) {
        entries_[index].state = {ElementState::Is::Running, step, entries_[index].state.ended,
                                 entries_[index].state.skipped};
    }
    void end(size_t index, int step, bool once_more = false) {
        entries_[index].state.is = once_more ? ElementState::Is::Standby : ElementState::Is::Complete;
        entries_[index].state.ended = step;
    }

    /// The first element, in the order of the file, whose path ends in a reference ("NAME", "MANEUVER::EVENT"), and how
    /// many there are. After all have been added.
    std::pair<size_t, size_t> find(ElementKind kind, std::string_view reference);

    static constexpr size_t kNone = ~size_t{0};
    static constexpr size_t kMaxPath = 2'000;  ///< bytes of the names of an element and those around it

private:
    struct Entry {
        ElementKind kind;
        std::string path;  ///< names from the story on, with "::" between them
        ElementState state{};
    };
    std::deque<Entry> entries_;
    struct Found {
        size_t first = 0, count = 0;
    };
    std::map<std::pair<ElementKind, std::string_view>, Found> by_end_;  ///< ends of paths
    size_t entered_ = 0;                                                ///< of the entries, into by_end_
};

}  // namespace vesper::roads
