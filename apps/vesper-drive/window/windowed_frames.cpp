// Frames of a window: how they are made, and when they are waited for. SPDX-License-Identifier: MIT
#include "base/error.h"
#include "print.h"
#include "record/hatching.h"
#include "window/windowed.h"

namespace vesper::drive {
namespace {

using apps::format;

// Behind the instruments of a rank without a channel.
void show_nothing(render::ToneMapped& shown) {
    shown.extent = {960, 540};
    shown.display.assign(size_t{4} * shown.extent.width * shown.extent.height, 0);
}

}  // namespace

// Whether each frame is waited for: somebody reads its picture, or it depends on the results of the one before.
bool WindowedDrive::needs_lockstep() const {
    const render::RenderSettings& settings = session_->settings().render();
    const bool reads = channels_ || log_ || arguments_.hatches || instruments_.needs_scene() || rendered_.width == 0;
    return reads || settings.samples > 1 || render::FrameQueue::needs_finished_frame(settings);
}

// Waits for the frame.
void WindowedDrive::draw(const render::Outputs& outputs) {
    on_device_ = false;
    if (!channels_) {
        frame_ = session_->render(view_, outputs);
        return;
    }
    ChannelMosaic wall;
    if (ranks_) {
        DriveRows* rows = log_ ? &log_->rows() : nullptr;
        ChannelRanks::LedFrame led = ranks_->render(*session_, *channels_, outputs, {.display = false}, rows);
        wall = std::move(led.wall), row_ = std::move(led.row), meeting_ = columns_of(led.meeting);
        meeting_note_ =
            apps::Ranks::all().name(led.meeting.last) + format(" was the last, by %.1f ms", led.meeting.skew * 1e3);
        if (wall.shown.display.empty()) show_nothing(wall.shown);
    } else {
        wall = session_->render(*channels_, outputs);
    }
    frame_ = logged_frame(wall, channels_->gaze);
    wall_ = std::move(wall.shown), columns_ = wall.columns;
}

// The frame goes to the screen's image; its results come later.
void WindowedDrive::submit(VkExtent2D extent) {
    const uint32_t bits = session_->settings().render().display.bits;
    session_->submit(view_, {.display = false, .shown = screen_->image_for(extent, bits)});
    on_device_ = true;
}

// One frame may be under way while the next is made: the device has always work, and what somebody does is seen soon.
void WindowedDrive::take_finished() {
    while (std::optional<render::Frame> frame = session_->finish_oldest(session_->renderer().unfinished() > 1)) {
        frame_ = std::move(*frame);
        instruments_.remember(frame_);
    }
}

void WindowedDrive::render(bool moved) {
    take_light();
    const VkExtent2D extent = picture_extent(scale());
    const bool ldr = session_->settings().render().tone_operator == render::Operator::Ldr;
    const bool measures = instruments_.needs_scene() || log_, waits = needs_lockstep();
    const render::Outputs outputs{.display = true, .scene = measures && !ldr};
    const bool lacks = (outputs.scene && !ranks_ && frame_.scene.empty()) || (waits && on_device_) ||
                       extent.width != rendered_.width || extent.height != rendered_.height;
    if (!moved && !dirty_ && !lacks) return;
    view_ = session_->view(extent);
    const auto make = [&] { waits ? draw(outputs) : submit(extent); };
    try {
        make();
    } catch (const gpu::DeviceLost&) {
        throw;
    } catch (const Error& error) {
        // Too many lamps for shadows end these, not the drive. A recording that has ended is no matter of shadows.
        if (ranks_) throw;  // others wait for this frame
        const bool recorded = recording_.empty() || session_->recording();
        if (!session_->settings().render().shadows || !recorded) throw;
        change("shadows", "off");
        say(error.what(), true);
        make();
    }
    rendered_ = extent, dirty_ = false, ++frame_number_;
    if (!waits) return;
    instruments_.remember(frame_);
    hatch_unseen(frame_, session_->settings().render(), arguments_.visible_from);
    if (log_) log_frame();
    if (!channels_) return;
    const std::vector<graph::Timing> timings = std::move(frame_.timings);
    static_cast<render::ToneMapped&>(frame_) = std::move(wall_);
    frame_.timings = timings;
}

// The view that a pixel of the frame belongs to, and its place there.
std::pair<gpu_scene::View, std::optional<glm::uvec2>> WindowedDrive::view_at(std::optional<glm::uvec2> pixel) const {
    if (!channels_ || !pixel) return {view_, pixel};
    for (size_t i = 0; i < columns_.size(); ++i) {
        const ScreenChannel& screen = channels_->screens[i];
        if (pixel->x >= columns_[i] && pixel->x < columns_[i] + screen.extent.width && pixel->y < screen.extent.height)
            return {channel_view(screen, view_), *pixel - glm::uvec2(columns_[i], 0)};
    }
    return {view_, std::nullopt};
}

void WindowedDrive::present() {
    const vision::Display& display = session_->settings().render().display;
    screen_->begin_instruments(instruments_.has_keyboard());
    const bool talks = Clock::now() < message_until_;
    const std::optional<glm::uvec2> pixel = screen_->pixel_under_mouse(frame_.extent, screen_settings_.scaling);
    const auto [view, view_pixel] = view_at(pixel);
    const FrameState now{.session = *session_,
                         .screen = *screen_,
                         .frame = frame_,
                         .view = view,
                         .input_devices = input_devices_,
                         .pixel = pixel,
                         .view_pixel = view_pixel,
                         .shown_per_second = pictures_per_second_,
                         .visible_from = arguments_.visible_from,
                         .offer = offer(),
                         .paused = paused_,
                         .recording = recording_,
                         .message = talks ? message_ : standing_message(),
                         .alarm = talks && alarm_};
    const std::vector<Change> changes = instruments_.draw(now);
    const bool colours = instruments_.shows_false_colour() && display.bits == 8;
    const auto coloured = colours ? instruments_.coloured(frame_, frame_number_) : std::span<const uint8_t>();
    const window::Picture of_host{.codes = coloured.empty() ? std::span<const uint8_t>(frame_.display) : coloured,
                                  .extent = frame_.extent,
                                  .bits = display.bits};
    shown_ |= screen_->show(on_device_ ? screen_->picture() : of_host, display, screen_settings_);
    for (const auto& [name, value] : changes) change(name, value);
}

}  // namespace vesper::drive
