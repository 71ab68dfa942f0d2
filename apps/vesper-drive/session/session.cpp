#include "session/session.h"

#include <cmath>
#include <map>
#include <utility>

#include "base/angle.h"
#include "base/error.h"
#include "external/world_message.h"
#include "gathered_light.h"
#include "osi/trace.h"

namespace vesper::drive {
namespace {

// Whether messages come while one drives; those of a replay are in its file.
bool is_live(const MessageSource& source) { return source.live && source.file.empty(); }

}  // namespace

Session::Session(gpu::Device& device, DriveStart options)
    : Session(device, options, Scenery(options.scene, options.messages)) {}

Session::Session(gpu::Device& device, DriveStart options, Scenery scenery)
    : options_(std::move(options)),
      scenery_(std::move(scenery)),
      settings_(scenery_.check(DriveSettings(options_.settings, options_.quality))),
      world_(std::make_unique<traffic::World>(scenery_.world(), options_.seed)),
      timeline_(!is_live(options_.messages)),
      places_(scenery_.external_places()),
      device_(&device),
      renderer_(std::make_unique<render::Renderer>(device, scenery_.scene())),
      recorder_(std::make_unique<DriveRecorder>(start())) {
    for (osi::Message& message : scenery_.take_messages()) timeline_.add(std::move(message));
    if (is_live(options_.messages)) {
        heard_ = std::make_unique<MessageStore>();
        timeline_.on_use = [this](const osi::Message& message) { keep(message); };
    }
    update_external(options_.messages.live ? std::nullopt : std::optional(0.0));
}

Session::~Session() = default;

DriveStart Session::start() const {
    DriveStart now = options_;
    now.settings = settings_.values();
    return now;
}

osi::Timeline::Added Session::hear(osi::Message message) {
    if (on_message) on_message(message);
    return timeline_.add(std::move(message));
}

void Session::note(const DriveEvent& event) {
    if (on_event) on_event(&event);  // others do it whether it can be recorded or not
    recorder_->add(event);
}

// What cannot be kept ends a recording, and nothing else.
void Session::keep(const osi::Message& message) {
    if (heard_->add(message) || !recording()) return;
    recorder_->close();
    problem_ = "the recording ends: " + heard_->problem();
}

// The moment of the messages, and everything where it is then.
void Session::update_external(std::optional<double> shown) {
    if (shown) shown_ = shown;
    if (options_.messages.any()) {
        external_ = shown_ ? places_.place(timeline_.at(*shown_)) : ExternalState{};
        world_->place(external_.actors, external_.driver);
    }
    external_.seconds = world_->seconds();
    actors_ = world_->actors();
}

void Session::step(const traffic::DriverInput& input, std::optional<double> shown) {
    input_ = input;
    const size_t met = world_->contacts().size();
    world_->step(input, options_.time_step);
    update_external(options_.messages.live ? shown : world_->seconds());
    for (size_t i = met; on_contact && i < world_->contacts().size(); ++i) on_contact(world_->contacts()[i]);
    const traffic::VehicleState& me = world_->driver();
    note({.kind = DriveEvent::Kind::Step,
          .input = input,
          .pose = glm::dvec4(me.position, me.yaw, me.speed),
          .shown = options_.messages.live ? shown : std::nullopt,
          .name = {},
          .value = {}});
    if (!problem_.empty()) throw Error(std::exchange(problem_, {}));
    if (trace_) ++traced_, trace_->append(osi::trace_bytes_of(message_now()));
}

void Session::restart() {
    world_ = std::make_unique<traffic::World>(scenery_.world(), options_.seed);
    input_ = {};
    places_ = scenery_.external_places(), shown_.reset(), external_ = {};
    update_external(options_.messages.live ? std::nullopt : std::optional(0.0));
    rendered_.reset();
    renderer_->reset_adaptation();
    if (wall_) wall_->reset_adaptation();
    const DriveEvent event{.kind = DriveEvent::Kind::Restart, .name = {}, .value = {}};
    if (recording())
        recorder_->add(event);
    else
        recorder_ = std::make_unique<DriveRecorder>(start());
    if (on_event) on_event(&event);
}

void Session::rewind() {
    settings_ = DriveSettings(options_.settings, options_.quality);
    restart();
    if (on_event) on_event(nullptr);
}

void Session::set(const std::string& name, const std::string& value) {
    DriveSettings wanted = settings_;
    wanted.set(name, value);
    scenery_.check(wanted);
    settings_ = std::move(wanted);
    note({.kind = DriveEvent::Kind::Set, .shown = {}, .name = name, .value = value});
}

gpu_scene::SceneFrame Session::moment() const { return scenery_.frame(actors_, settings_, external_); }

gpu_scene::View Session::view(VkExtent2D extent) const { return scenery_.view(moment(), actors_, settings_, extent); }

render::Frame Session::render(VkExtent2D extent, render::Outputs outputs) { return render(view(extent), outputs); }

render::RenderSettings Session::frame_settings() const {
    render::RenderSettings settings = settings_.render();
    settings.obstacles = obstacles_, settings.obstacle_pixels = obstacle_pixels_;
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

void Session::gather_light(Cache* cache) {
    const render::RenderSettings& shown = settings_.render();
    if (!shown.indirect || shown.tone_operator == render::Operator::Ldr) return;
    const gpu_scene::SceneFrame rest = moment();
    set_radiosity(apps::gathered(scenery_.scene(), rest.world, rest.moving, cache));
}

void Session::begin_frame(const gpu_scene::SceneFrame& moment) {
    eye_step_ = rendered_ ? double(world_->steps() - *rendered_) * options_.time_step : 0;
    if (lamp_reflections_ || !settings_.render().moving_reflections) return;
    lamp_reflections_ =
        std::make_shared<const transport::LampReflections>(scenery_.scene(), moment.world, moment.moving);
    renderer_->set_lamp_reflections(lamp_reflections_);
}

void Session::end_frame() {
    rendered_ = world_->steps();
    try {
        note({.kind = DriveEvent::Kind::Frame, .name = {}, .value = {}});
    } catch (const Error& error) {
        if (!link_) throw;
        problem_ = error.what();  // after what the others wait for
    }
}

void Session::skip_frame() { end_frame(); }

render::Frame Session::render(const gpu_scene::View& view, render::Outputs outputs) {
    const gpu_scene::SceneFrame now = moment();
    begin_frame(now);
    render::Frame frame = frame_maker ? frame_maker(*renderer_, frame_settings(), view, now, float(eye_step_), outputs,
                                                    !rendered_.has_value())
                                      : renderer_->render(frame_settings(), view, now, float(eye_step_), outputs);
    eye_ = frame.eye;
    end_frame();
    if (on_maps) on_maps(frame.maps);
    return frame;
}

void Session::submit(const gpu_scene::View& view, const render::Outputs& outputs) {
    const gpu_scene::SceneFrame now = moment();
    begin_frame(now);
    renderer_->submit(frame_settings(), view, now, float(eye_step_), outputs, {});
    end_frame();
}

std::optional<render::Frame> Session::finish_oldest(bool waits) {
    std::optional<render::Frame> frame = renderer_->finish_oldest(waits);
    if (!frame) return frame;
    eye_ = frame->eye;
    if (on_maps) on_maps(frame->maps);
    return frame;
}

void Session::make_wall() {
    wall_ = std::make_unique<ChannelRenderer>(*device_, link_);
    wall_->set_latency(latency_);
}

ChannelMosaic Session::render(const Channels& channels, render::Outputs outputs) {
    if (!wall_) make_wall();
    const gpu_scene::SceneFrame now = moment();
    begin_frame(now);
    ChannelMosaic wall =
        wall_->render(*renderer_, channels, frame_settings(), view({1, 1}), now, float(eye_step_), outputs);
    eye_ = wall.shown.eye;
    end_frame();
    for (const render::Frame& channel : wall.channels)
        if (on_maps) on_maps(channel.maps);
    return wall;
}

void Session::use(gpu::Device& device) {
    const bool had_wall = wall_ != nullptr;
    wall_.reset();
    renderer_.reset();
    device_ = &device;
    renderer_ = std::make_unique<render::Renderer>(device, scenery_.scene(), map_cache_);
    renderer_->set_radiosity(radiosity_);
    renderer_->set_lamp_reflections(lamp_reflections_);
    if (rendered_) renderer_->set_eye(eye_);
    if (!had_wall) return;
    make_wall();
    if (rendered_) wall_->set_eye(eye_);
}

void Session::record(const std::filesystem::path& file, std::optional<glm::uvec2> size) {
    if (heard_) heard_->open(messages_of(file));
    recorder_->open(file, size);
}

void Session::stop_recording() {
    if (!problem_.empty()) throw Error(std::exchange(problem_, {}));
    if (heard_) heard_->close();
    recorder_->close();
}

bool Session::recording() const { return recorder_->is_open(); }

osi::Message Session::message_now() const {
    osi::Message message = message_of(*world_, external_, scenery_.message_frame());
    // A restart does not turn time back.
    message.nanoseconds = std::llround(double(traced_) * options_.time_step * 1e9);
    const std::vector<SignalLens>& lenses = scenery_.lenses();
    // A signal that changes by itself is one light, which changes its colour: what no message says again, holds.
    const bool by_plan = external_.lenses.empty();
    std::map<std::string, size_t> firsts;
    for (size_t i = 0; i < lenses.size(); ++i) {
        const size_t first = by_plan && lenses[i].phase ? firsts.try_emplace(lenses[i].signal, i).first->second : i;
        const bool lit = by_plan ? lenses[i].shines(external_.seconds) : external_.lenses[i];
        if (by_plan && lenses[i].phase && !lit) continue;
        message.traffic_lights.push_back({.id = first + 1,
                                          .signal = lenses[i].signal,
                                          .position = scenery_.message_frame().back(lenses[i].position),
                                          .colour = lenses[i].colour,
                                          .state = lit ? osi::LampState::On : osi::LampState::Off});
    }
    if (const auto sun = settings_.sun() ? settings_.sun() : external_.sun_elevation)
        message.environment = osi::Environment{.sun_elevation = *sun * kRadiansPerDegree, .time_of_day = {}};
    return message;
}

void Session::write_trace(const std::filesystem::path& file) {
    trace_ = std::make_unique<io::GrowingFile>(file);
    trace_->append(osi::trace_bytes_of(message_now()));
}

void Session::finish_trace() {
    if (trace_) std::exchange(trace_, nullptr)->complete();
}

}  // namespace vesper::drive
