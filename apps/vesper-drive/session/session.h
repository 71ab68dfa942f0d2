// A drive: a world, the eye that looks at it and the device that renders it, behind one door. Windows and the headless
// program both use it, so they show the same bytes. SPDX-License-Identifier: MIT
//
//   Device device({.select = ""});
//   Session session(device, {.scene = "data/rivoli/rivoli.world.json"});
//   session.record("drive.json");
//   for (;;) {
//       session.set("operator", "ward");
//       session.step(input);
//       const Frame frame = session.render({1680, 1050}, {.display = true});
//   }
//
// record() may be called at any time; the drive is on disk up to the last step from then on. set() takes any setting of
// DriveSettings at any time. A step is 1/60 s of simulated time; without one there is a pause.
// Time stands still between steps. The eye adapts by the steps since the last rendered frame, so frames may be rendered
// at any rate; which steps were rendered is recorded, and a replay that renders the same ones gives the same bytes on
// the same device. Not thread-safe. Throws Error.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "channels/channels.h"
#include "external/message_store.h"
#include "gpu/device.h"
#include "session/drive_file.h"
#include "session/scenery.h"
#include "session/settings.h"
#include "traffic/world.h"

namespace vesper::drive {

class Session {
public:
    Session(gpu::Device&, DriveStart);
    /// With the scenery of that start, which somebody has read already.
    Session(gpu::Device&, DriveStart, Scenery);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const DriveStart& options() const { return options_; }
    const Scenery& scenery() const { return scenery_; }

    // The world.
    /// `shown`: the moment of the messages that it shows, s after the first of them; without one that of a live source
    /// stays, and a source with a file goes along with the world's time.
    void step(const traffic::DriverInput&, std::optional<double> shown = {});
    /// A message of a live source, from now on known.
    osi::Timeline::Added hear(osi::Message);
    /// Whether the places of messages that are heard lie at the ground, and are raised (--osi-z).
    bool raises_objects() const { return places_.at_ground(); }
    /// Time of the latest message, s after the first.
    double latest_message() const { return timeline_.latest(); }
    /// What another program says of the present moment.
    const ExternalState& external() const { return external_; }
    /// Called in step() for everything that the car meets.
    std::function<void(const traffic::Contact&)> on_contact;
    /// Called after each event, for whoever drives along; after a rewind() with nothing.
    std::function<void(const DriveEvent*)> on_event;
    /// Called in hear() before the message is known.
    std::function<void(const osi::Message&)> on_message;
    /// Back to the start, with the eye adapted anew. A recording goes on; what was not recorded is forgotten.
    void restart();
    /// The same, with the settings of the start.
    void rewind();
    const traffic::World& world() const { return *world_; }
    /// What moves, as it stands now; the driver's car first.
    const std::vector<traffic::Actor>& actors() const { return actors_; }
    const traffic::DriverInput& input() const { return input_; }  ///< of the last step

    // Settings.
    const DriveSettings& settings() const { return settings_; }
    /// Those of frames, with the obstacles that are measured.
    render::RenderSettings frame_settings() const;
    /// Throws Error, also for lamps that the scene has not got; then nothing has changed.
    void set(const std::string& name, const std::string& value);

    // Pictures.
    /// Where shadow maps are kept from run to run (Renderer::keep_maps); at first nowhere. It is not recorded.
    void keep_maps(std::shared_ptr<Cache> cache);
    /// What surfaces at rest send each other (Renderer::set_radiosity); at first nothing. It is not recorded: frames
    /// before it is known are replayed with it.
    void set_radiosity(std::shared_ptr<const transport::Radiosity> radiosity);
    /// The same, from the cache (null: none) or gathered, where the settings show any; shows its progress.
    void gather_light(Cache* cache);
    /// Called after a frame for each view of it.
    std::function<void(const render::ShadowReport&)> on_maps;
    /// Obstacles of the scene that are measured in frames of one view (Frame::obstacles); at first none. They are not
    /// recorded.
    void watch(std::vector<scene::Obstacle> obstacles) { obstacles_ = std::move(obstacles); }
    const std::vector<scene::Obstacle>& obstacles() const { return obstacles_; }
    /// Whether frames have Frame::obstacle_pixels; at first not.
    void find_obstacle_pixels(bool wanted) { obstacle_pixels_ = wanted; }
    /// What the camera of the settings sees in a picture of that size.
    gpu_scene::View view(VkExtent2D) const;
    /// Where everything stands now and how it is lit.
    gpu_scene::SceneFrame moment() const;
    /// Renders frames of one view, as FrameRelay does; at first the renderer. `fresh`: the eye has seen nothing yet.
    using FrameMaker =
        std::function<render::Frame(render::Renderer&, const render::RenderSettings&, const gpu_scene::View&,
                                    const gpu_scene::SceneFrame&, float seconds, const render::Outputs&, bool fresh)>;
    FrameMaker frame_maker;
    /// The frame of this moment is rendered elsewhere; the time of the eye goes on.
    void skip_frame();
    /// The picture of this moment. The first one, and one after a restart, is seen by an eye that is adapted.
    render::Frame render(VkExtent2D, render::Outputs);
    /// The same of another view.
    render::Frame render(const gpu_scene::View&, render::Outputs);
    /// The same, submitted without waiting; best with Outputs::shown. Its results come from finish_oldest().
    void submit(const gpu_scene::View&, const render::Outputs&);
    /// Results of the oldest submitted frame (Renderer::finish_oldest).
    std::optional<render::Frame> finish_oldest(bool waits);
    /// All channels of this moment, seen by one eye. Not to be mixed with frames of one view: each way has an eye of
    /// its own.
    ChannelMosaic render(const Channels&, render::Outputs);
    /// The processes that render other channels, and how many moments, 0 or 1, what their eye sees is late
    /// (ChannelRenderer); before the first frame. At first none and 0.
    void share_channels(ChannelLink* link, unsigned latency) { link_ = link, latency_ = latency; }
    /// After the last frame of all of them: hears what others have said of it.
    void leave_channels() {
        if (wall_) wall_->leave();
    }
    /// Seconds that passed for the eye before the last frame.
    double eye_step() const { return eye_step_; }
    render::Renderer& renderer() { return *renderer_; }
    /// Goes on with another device, as after one was lost; the eye remembers.
    void use(gpu::Device&);

    // Recording (docs/drives.md).
    /// Records the drive from its start, whenever that was, and goes on with it: FILE.part has every event as soon as
    /// it happened. `size`: of the pictures, px, which a replay then has, too.
    void record(const std::filesystem::path& file, std::optional<glm::uvec2> size = {});
    /// Completes the recording, which takes its name. Without, what there is of it stays in FILE.part.
    void stop_recording();
    bool recording() const;
    /// Writes what moves, how it is lit, traffic lights and sun as an OSI trace, a message after each step from now on;
    /// finish_trace() gives it its name.
    void write_trace(const std::filesystem::path& file);
    void finish_trace();

private:
    DriveStart start() const;
    void note(const DriveEvent&);
    void make_wall();
    void keep(const osi::Message&);
    void update_external(std::optional<double> shown);
    osi::Message message_now() const;
    void begin_frame(const gpu_scene::SceneFrame& moment);
    void end_frame();

    DriveStart options_;
    Scenery scenery_;
    DriveSettings settings_;
    std::unique_ptr<traffic::World> world_;
    std::vector<traffic::Actor> actors_;
    traffic::DriverInput input_;
    osi::Timeline timeline_;
    ExternalPlaces places_;
    ExternalState external_;
    std::optional<double> shown_;             // the moment of the messages
    std::string problem_;                     // of a recording, to be thrown when nobody waits
    std::unique_ptr<MessageStore> heard_;     // what is needed of a live source to show it again
    std::unique_ptr<io::GrowingFile> trace_;  // of write_trace()
    uint64_t traced_ = 0;                     // steps in it
    gpu::Device* device_;
    std::unique_ptr<render::Renderer> renderer_;
    std::unique_ptr<ChannelRenderer> wall_;  // made when first asked for
    ChannelLink* link_ = nullptr;
    unsigned latency_ = 0;
    std::optional<uint64_t> rendered_;  // steps at the last frame
    shared::EyeState eye_{};
    double eye_step_ = 0;
    std::vector<scene::Obstacle> obstacles_;
    bool obstacle_pixels_ = false;
    std::shared_ptr<Cache> map_cache_;
    std::shared_ptr<const transport::Radiosity> radiosity_;
    std::shared_ptr<const transport::LampReflections> lamp_reflections_;  // made when first asked for
    std::unique_ptr<DriveRecorder> recorder_;
};

}  // namespace vesper::drive
