// Instruments over the picture: what is measured, and switches. SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "session/session.h"
#include "window/input_devices.h"
#include "window/screen.h"

#include "plots/false_colour.h"

namespace vesper::drive {

/// What is shown at the moment.
struct FrameState {
    const Session& session;
    const Screen& screen;
    const render::Frame& frame;   ///< the last one that was rendered
    const gpu_scene::View& view;  ///< of the channel under the mouse, or of all of it
    const InputDevices& input_devices;
    std::optional<glm::uvec2> pixel, view_pixel;  ///< of the frame and of that view, under the mouse
    double shown_per_second = 0;                  ///< pictures
    double visible_from = 0;                      ///< of obstacles, a visibility level
    std::string offer;                            ///< of faster settings; empty: none
    bool paused = false;
    std::string recording;  ///< file; empty: none
    std::string message;    ///< to read now; empty: none
    bool alarm = false;     ///< it is to be read over a clean picture, too
};

/// A setting that somebody changed, as Session::set takes it.
using Change = std::pair<std::string, std::string>;

class Instruments {
public:
    /// Shows or hides; false: the action is none of theirs. Action::Leave first gives the keyboard back, then closes
    /// all that is visible, and is none of theirs where nothing is.
    bool press(Action);
    /// Keeps what is drawn over time.
    void remember(const render::Frame&);
    void forget() { past_.clear(); }

    /// Whether something needs the luminances of the next frame.
    bool needs_scene() const { return (shows(kProbe) && !clean_) || false_colour_; }
    /// Whether keys are for them.
    bool has_keyboard() const { return focus_ && !clean_; }
    bool shows_false_colour() const { return false_colour_; }
    /// The luminance of a frame as colours, codes of 8 bits; nothing if it has no luminances. `number` tells frames
    /// apart.
    std::span<const uint8_t> coloured(const render::Frame&, uint64_t number);

    /// Declares everything that is visible; gives what was changed.
    std::vector<Change> draw(const FrameState&);

private:
    enum Panel : unsigned {
        kKeys = 1,
        kPerformance = 2,
        kLight = 4,
        kEye = 8,
        kSwitches = 16,
        kLamps = 32,
        kProbe = 64,
        kControllers = 128,
        kObstacles = 256
    };
    bool shows(Panel panel) const { return panels_ & panel; }
    /// Place and size as of panel_place().
    bool begin(Panel, const char* title, glm::vec2 place, glm::vec2 size, int flags = 0);
    bool leave();

    void draw_status(const FrameState&) const;
    void draw_message(const std::string&) const;
    void draw_keys();
    void draw_performance(const FrameState&);
    void draw_light(const FrameState&);
    void draw_eye();
    void draw_switches(const FrameState&, std::vector<Change>&);
    void draw_lamps(const FrameState&, std::vector<Change>&);
    void draw_probe(const FrameState&);
    void draw_controllers(const FrameState&);
    void draw_obstacles(const FrameState&);
    void draw_scale();

    struct Past {
        double seconds, adaptation, average, cones, rods;  // cd/m^2
    };
    unsigned panels_ = 0;
    bool clean_ = false, focus_ = false, false_colour_ = false;
    glm::vec2 window_{0};   // px, when they were last drawn
    bool arrange_ = false;  // all panels go where they belong, in a window of another size
    apps::ColourScale scale_{0.01, 1000};
    bool fit_scale_ = true;
    std::vector<uint8_t> coloured_;
    uint64_t coloured_number_ = ~0ull;
    apps::ColourScale coloured_scale_;
    std::deque<Past> past_;
};

}  // namespace vesper::drive
