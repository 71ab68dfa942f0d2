#include "session.h"

namespace vesper::drive {

Session::Session(gpu::Device& device, DriveStart options)
    : Session(device, options, Scenery(options.scene, options.run, options.scenario)) {}

Session::Session(gpu::Device& device, DriveStart options, Scenery scenery)
    : options_(std::move(options)),
      scenery_(std::move(scenery)),
      settings_(scenery_.check(DriveSettings(options_.settings))),
      world_(std::make_unique<traffic::World>(scenery_.world(), options_.seed)),
      actors_(world_->actors()),
      device_(&device),
      renderer_(std::make_unique<render::Renderer>(device, scenery_.scene())),
      recorder_(std::make_unique<DriveRecorder>(start())) {}

Session::~Session() = default;

DriveStart Session::start() const {
    DriveStart now = options_;
    now.settings = settings_.values();
    return now;
}

void Session::step(const traffic::DriverInput& input) {
    input_ = input;
    const size_t met = world_->contacts().size();
    world_->step(input, options_.time_step);
    actors_ = world_->actors();
    for (size_t i = met; on_contact && i < world_->contacts().size(); ++i) on_contact(world_->contacts()[i]);
    const traffic::VehicleState& me = world_->driver();
    recorder_->add({.kind = DriveEvent::Kind::Step,
                    .input = input,
                    .pose = glm::dvec4(me.position, me.yaw, me.speed),
                    .name = {},
                    .value = {}});
}

void Session::restart() {
    world_ = std::make_unique<traffic::World>(scenery_.world(), options_.seed);
    actors_ = world_->actors();
    input_ = {};
    rendered_.reset();
    renderer_->reset_adaptation();
    if (wall_) wall_->reset_adaptation();
    if (recording())
        recorder_->add({.kind = DriveEvent::Kind::Restart, .name = {}, .value = {}});
    else
        recorder_ = std::make_unique<DriveRecorder>(start());
}

void Session::rewind() {
    settings_ = DriveSettings(options_.settings);
    restart();
}

void Session::set(const std::string& name, const std::string& value) {
    DriveSettings wanted = settings_;
    wanted.set(name, value);
    scenery_.check(wanted);
    settings_ = std::move(wanted);
    recorder_->add({.kind = DriveEvent::Kind::Set, .name = name, .value = value});
}

gpu_scene::SceneFrame Session::moment() const { return scenery_.frame(actors_, world_->seconds(), settings_); }

gpu_scene::View Session::view(VkExtent2D extent) const { return scenery_.view(moment(), actors_, settings_, extent); }

render::Frame Session::render(VkExtent2D extent, render::Outputs outputs) { return render(view(extent), outputs); }

render::RenderSettings Session::frame_settings() const {
    render::RenderSettings settings = settings_.render();
    if (!settings_.values().contains("shadow-budget")) settings.shadow_budget = shadow_budget_;
    return settings;
}

void Session::keep_maps(std::shared_ptr<Cache> cache) {
    map_cache_ = std::move(cache);
    renderer_->keep_maps(map_cache_);
}

void Session::set_radiosity(std::shared_ptr<const transport::Radiosity> radiosity) {
    radiosity_ = std::move(radiosity);
    renderer_->set_radiosity(radiosity_);
}

void Session::begin_frame(const gpu_scene::SceneFrame& moment) {
    eye_step_ = rendered_ ? double(world_->steps() - *rendered_) * options_.time_step : 0;
    if (lamp_reflections_ || !settings_.render().moving_reflections) return;
    lamp_reflections_ =
        std::make_shared<const transport::LampReflections>(scenery_.scene(), moment.world, moment.moving);
    renderer_->set_lamp_reflections(lamp_reflections_);
}

void Session::end_frame(const shared::EyeState& eye) {
    rendered_ = world_->steps();
    eye_ = eye;
    recorder_->add({.kind = DriveEvent::Kind::Frame, .name = {}, .value = {}});
}

render::Frame Session::render(const gpu_scene::View& view, render::Outputs outputs) {
    const gpu_scene::SceneFrame now = moment();
    begin_frame(now);
    render::Frame frame = renderer_->render(frame_settings(), view, now, float(eye_step_), outputs);
    end_frame(frame.eye);
    if (on_maps) on_maps(frame.maps);
    return frame;
}

ChannelMosaic Session::render(const Channels& channels, render::Outputs outputs) {
    if (!wall_) wall_ = std::make_unique<ChannelRenderer>(*device_);
    const gpu_scene::SceneFrame now = moment();
    begin_frame(now);
    ChannelMosaic wall =
        wall_->render(*renderer_, channels, frame_settings(), view({1, 1}), now, float(eye_step_), outputs);
    end_frame(wall.shown.eye);
    for (const render::Frame& channel : wall.channels)
        if (on_maps) on_maps(channel.maps);
    return wall;
}

void Session::use(gpu::Device& device) {
    const bool had_wall = wall_ != nullptr;
    wall_.reset();
    renderer_.reset();
    device_ = &device;
    renderer_ = std::make_unique<render::Renderer>(device, scenery_.scene());
    renderer_->keep_maps(map_cache_);
    renderer_->set_radiosity(radiosity_);
    renderer_->set_lamp_reflections(lamp_reflections_);
    if (rendered_) renderer_->set_eye(eye_);
    if (!had_wall) return;
    wall_ = std::make_unique<ChannelRenderer>(device);
    if (rendered_) wall_->set_eye(eye_);
}

void Session::record(const std::filesystem::path& file, std::optional<glm::uvec2> size) { recorder_->open(file, size); }

void Session::stop_recording() { recorder_->close(); }

bool Session::recording() const { return recorder_->is_open(); }

}  // namespace vesper::drive
