// Driving in a window. SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "record/drive_log.h"
#include "record/playback.h"
#include "run/channel_ranks.h"
#include "run/drive.h"
#include "session/drive_file.h"
#include "session/light_gatherer.h"
#include "session/message_feed.h"
#include "session/session.h"
#include "window/input_devices.h"
#include "window/instruments.h"
#include "window/pace.h"
#include "window/screen.h"
#include "window/window.h"

namespace vesper::drive {

/// A session that somebody drives and looks at.
class WindowedDrive {
public:
    static constexpr unsigned kCoarsest = 5;  ///< steps of resolution below the finest

    explicit WindowedDrive(const DriveArguments&);

    /// Until the window is closed. A device that is lost is opened anew, and the drive goes on; lost again before it
    /// has shown a picture, or on any other error, it throws Error: what was recorded up to the last step is then in
    /// the recording's part.
    void run();
    const std::string& recording() const { return recording_; }  ///< the file; empty: none

private:
    using Clock = std::chrono::steady_clock;

    gpu::DeviceOptions device_options() const;
    void recover(const gpu::DeviceLost&);
    void check_display(const DriveSettings&) const;
    void open_session(const Drive&);
    void reload(const std::string& scene);
    void press(Action);
    void press_view(Action);
    void change(const std::string& name, const std::string& value);
    void cycle(const std::string& name, const std::vector<std::string>& values, int step);
    void change_quality(int step);
    void next_display();
    void fill_monitor(bool next);
    void record();
    void save_picture();
    void restart();

    HeldInput held() const;
    void move_camera(double seconds);
    void advance(double seconds);
    void open_feed();
    void listen();
    void watch_contacts();
    bool watch_again(Session&) const;
    void hatch(bool on);
    void log_frame();
    void keep_maps();
    void take_light();
    std::string standing_message() const;
    std::string offer() const;
    bool replay_to_next_frame();
    void render(bool moved);
    bool needs_lockstep() const;
    void draw(const render::Outputs&);
    void submit(VkExtent2D);
    void take_finished();
    void present();
    std::pair<gpu_scene::View, std::optional<glm::uvec2>> view_at(std::optional<glm::uvec2> pixel) const;
    void say(const std::string& text, bool alarm = false);
    std::string title() const;
    VkExtent2D picture_extent(double scale) const;
    double scale() const;          // as given, or of the quality
    double picture_scale() const;  // of the side asked for
    std::optional<glm::uvec2> recorded_size() const;

    DriveArguments arguments_;
    Window window_;
    std::unique_ptr<gpu::Device> device_;
    std::shared_ptr<Cache> map_cache_;
    std::unique_ptr<Session> session_;
    std::unique_ptr<MessageFeed> feed_;     // of a simulator that sends
    bool raises_ = false;                   // objects, as the window said last
    std::unique_ptr<LightGatherer> light_;  // of its scene; none before it is wanted
    std::unique_ptr<Screen> screen_;
    bool shown_ = false;  // a picture, since the device is there
    ScreenSettings screen_settings_;
    Instruments instruments_;
    InputDevices input_devices_;

    std::optional<Playback> replay_;

    bool paused_ = false, one_step_ = false, dirty_ = true;
    double lag_s_ = 0;  // s of real time that the world is behind
    double pictures_per_second_ = 0;
    Pace pace_;
    unsigned coarser_ = 0;            // index of the picture's coarseness
    std::optional<VkExtent2D> size_;  // of pictures, as it was given or recorded; none: the window's
    VkExtent2D rendered_{};
    render::Frame frame_;     // the last one whose results are known
    bool on_device_ = false;  // the picture is the screen's image, and frame_ has no codes
    gpu_scene::View view_;
    std::optional<Channels> channels_;
    std::unique_ptr<ChannelRanks> ranks_;  // that show them; none: this process does
    render::ToneMapped wall_;              // the picture of all of them, until the frame's log is written
    std::vector<uint32_t> columns_;        // where each begins in it
    uint64_t frame_number_ = 0;
    glm::dvec2 mouse_{0};
    std::string recording_, message_;
    bool alarm_ = false;
    Clock::time_point message_until_{};
    size_t doubts_ = 0;      // of the feed, as they were said last
    uint64_t troubles_ = 0;  // of the feed, as they were said last
    Clock::time_point troubles_said_{};
    std::vector<scene::Obstacle> obstacles_;  // of the first scene, of which the log has columns
    std::optional<DriveLog> log_;
    std::string row_, meeting_, meeting_note_;  // of the last frame of several ranks
};

}  // namespace vesper::drive
