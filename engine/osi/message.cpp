#include "osi/message.h"

#include <algorithm>
#include <cmath>

#include <osi/osi.pb.h>

#include "base/error.h"

namespace vesper::osi {
namespace {

constexpr double kFarthest = 1e9, kLargest = 1000;  // m
constexpr double kMostTurned = 1e6;                 // rad
constexpr int64_t kNanoseconds = 1'000'000'000, kMostSeconds = kMostNanoseconds / kNanoseconds;

bool is_place(const wire::Vector3d& v) {
    return std::abs(v.x()) < kFarthest && std::abs(v.y()) < kFarthest && std::abs(v.z()) < kFarthest;
}
bool is_turn(const wire::Orientation3d& o) {
    return std::abs(o.yaw()) < kMostTurned && std::abs(o.pitch()) < kMostTurned && std::abs(o.roll()) < kMostTurned;
}
glm::dvec3 vector_of(const wire::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
glm::dvec3 size_of(const wire::Dimension3d& d) {
    glm::dvec3 size(d.length(), d.width(), d.height());
    for (int i = 0; i < 3; ++i)
        if (!(size[i] > 0 && size[i] < kLargest)) size[i] = 0;
    return size;
}
void set(wire::Vector3d& to, const glm::dvec3& v) { to.set_x(v.x), to.set_y(v.y), to.set_z(v.z); }

// Numbers of enumerations, as OSI 3 has them.
constexpr int kOff = 2, kOn = 3, kFlashing = 6, kLastFlashing = 6;  // GenericLightState; brake: 3 normal, 4 strong
constexpr int kLeft = 3, kRight = 4, kWarning = 5;                  // IndicatorState
constexpr int kOther = 1, kVehicle = 2, kPedestrian = 3, kAnimal = 4;
constexpr int kModeOff = 2, kModeOn = 3, kModeFlashing = 4, kModeCounting = 5;

LampState lamp_of(int state) {
    if (state == kOff) return LampState::Off;
    if (state == kOn) return LampState::On;
    return state > kOn && state <= kLastFlashing ? LampState::Flashing : LampState::Unknown;
}
int number_of(LampState state) {
    return state == LampState::Off ? kOff : state == LampState::On ? kOn : state == LampState::Flashing ? kFlashing : 0;
}

LampState brake_of(int state) {
    return state == kOff ? LampState::Off : state == 3 || state == 4 ? LampState::On : LampState::Unknown;
}

LampState indicator_of(int state, int side) {
    if (state < kOff || state > kWarning) return LampState::Unknown;
    return state == side || state == kWarning ? LampState::Flashing : LampState::Off;
}
int indicator_number(const LightStates& lights) {
    const bool left = lights.left >= LampState::On, right = lights.right >= LampState::On;
    if (lights.left == LampState::Unknown && lights.right == LampState::Unknown) return 0;
    return left && right ? kWarning : left ? kLeft : right ? kRight : kOff;
}

LightStates lights_of(const wire::LightState& s) {
    return {.low = lamp_of(s.head_light()),
            .high = lamp_of(s.high_beam()),
            .tail = lamp_of(s.tail_light()),
            .brake = brake_of(s.brake_light_state()),
            .left = indicator_of(s.indicator_state(), kLeft),
            .right = indicator_of(s.indicator_state(), kRight),
            .front_fog = lamp_of(s.front_fog_light()),
            .rear_fog = lamp_of(s.rear_fog_light()),
            .reversing = lamp_of(s.reversing_light())};
}

void set(wire::LightState& to, const LightStates& lights) {
    to.set_head_light(number_of(lights.low)), to.set_high_beam(number_of(lights.high));
    to.set_tail_light(number_of(lights.tail)), to.set_brake_light_state(std::min(number_of(lights.brake), kOn));
    to.set_indicator_state(indicator_number(lights));
    to.set_front_fog_light(number_of(lights.front_fog)), to.set_rear_fog_light(number_of(lights.rear_fog));
    to.set_reversing_light(number_of(lights.reversing));
}

MovingObject::Kind kind_of(const wire::MovingObject& object) {
    using Kind = MovingObject::Kind;
    if (object.type() == kPedestrian) return Kind::Pedestrian;
    if (object.type() == kAnimal) return Kind::Animal;
    if (object.type() != kVehicle) return Kind::Object;
    switch (object.vehicle_classification().type()) {
        case 7:   // heavy truck
        case 16:  // semitractor
        case 19:  // work machine
            return Kind::Truck;
        case 8:  // semitrailer
        case 9:
            return Kind::Trailer;
        case 10:
            return Kind::Motorcycle;
        case 11:
        case 17:  // scooter
        case 18:  // micromobility device
            return Kind::Bicycle;
        case 12:
        case 13:  // tram
        case 14:  // train
            return Kind::Bus;
        case 15:  // wheelchair
            return Kind::Pedestrian;
        case 20:  // watercraft
        case 21:  // aircraft
            return Kind::Object;
        default:
            return Kind::Car;
    }
}

void set_kind(wire::MovingObject& to, MovingObject::Kind kind) {
    using Kind = MovingObject::Kind;
    const int type = kind == Kind::Pedestrian ? kPedestrian
                     : kind == Kind::Animal   ? kAnimal
                     : kind == Kind::Object   ? kOther
                                              : kVehicle;
    to.set_type(type);
    if (type != kVehicle) return;
    to.mutable_vehicle_classification()->set_type(kind == Kind::Truck        ? 7
                                                  : kind == Kind::Bus        ? 12
                                                  : kind == Kind::Motorcycle ? 10
                                                  : kind == Kind::Bicycle    ? 11
                                                  : kind == Kind::Trailer    ? 9
                                                                             : 4);
}

std::optional<MovingObject> object_of(const wire::MovingObject& from) {
    const wire::BaseMoving& base = from.base();
    if (!base.has_position() || !is_place(base.position()) || !is_turn(base.orientation())) return std::nullopt;
    MovingObject object{.id = from.id().value(),
                        .kind = kind_of(from),
                        .model = from.model_reference(),
                        .centre = vector_of(base.position()),
                        .yaw = base.orientation().yaw(),
                        .pitch = base.orientation().pitch(),
                        .roll = base.orientation().roll(),
                        .velocity = {},
                        .lights = lights_of(from.vehicle_classification().light_state())};
    object.size = size_of(base.dimension());
    if (base.has_velocity() && is_place(base.velocity())) object.velocity = vector_of(base.velocity());
    return object;
}

void add(wire::GroundTruth& truth, const MovingObject& object) {
    wire::MovingObject& to = *truth.add_moving_object();
    to.mutable_id()->set_value(object.id);
    wire::BaseMoving& base = *to.mutable_base();
    wire::Dimension3d& size = *base.mutable_dimension();
    size.set_length(object.size.x), size.set_width(object.size.y), size.set_height(object.size.z);
    set(*base.mutable_position(), object.centre);
    wire::Orientation3d& turn = *base.mutable_orientation();
    turn.set_yaw(object.yaw), turn.set_pitch(object.pitch), turn.set_roll(object.roll);
    if (object.velocity) set(*base.mutable_velocity(), *object.velocity);
    set_kind(to, object.kind);
    if (to.type() == kVehicle) set(*to.mutable_vehicle_classification()->mutable_light_state(), object.lights);
    if (!object.model.empty()) to.set_model_reference(object.model);
}

constexpr char kSignalId[] = "traffic_light_id:", kOpenDrive[] = "net.asam.opendrive";

// "traffic_light_id:7" (as esmini writes it) or "7".
std::string signal_of(const wire::TrafficLight& from) {
    for (const wire::ExternalReference& source : from.source_reference()) {
        if (source.type() != kOpenDrive || source.identifier_size() == 0) continue;
        const std::string& id = source.identifier(0);
        return id.starts_with(kSignalId) ? id.substr(sizeof kSignalId - 1) : id;
    }
    return {};
}

std::optional<TrafficLight> light_of(const wire::TrafficLight& from) {
    if (!is_place(from.base().position())) return std::nullopt;
    using Colour = TrafficLight::Colour;
    const int colour = from.classification().color(), mode = from.classification().mode();
    TrafficLight light{.id = from.id().value(),
                       .signal = signal_of(from),
                       .position = vector_of(from.base().position()),
                       .colour = colour == 2   ? Colour::Red
                                 : colour == 3 ? Colour::Yellow
                                 : colour == 4 ? Colour::Green
                                               : Colour::Other};
    if (mode == kModeOff || from.classification().is_out_of_service())
        light.state = LampState::Off;
    else if (mode == kModeOn || mode == kModeCounting)
        light.state = LampState::On;
    else if (mode == kModeFlashing)
        light.state = LampState::Flashing;
    return light;
}

void add(wire::GroundTruth& truth, const TrafficLight& light) {
    wire::TrafficLight& to = *truth.add_traffic_light();
    to.mutable_id()->set_value(light.id);
    set(*to.mutable_base()->mutable_position(), light.position);
    using Colour = TrafficLight::Colour;
    to.mutable_classification()->set_color(light.colour == Colour::Red      ? 2
                                           : light.colour == Colour::Yellow ? 3
                                           : light.colour == Colour::Green  ? 4
                                                                            : kOther);
    to.mutable_classification()->set_mode(light.state == LampState::Off        ? kModeOff
                                          : light.state == LampState::On       ? kModeOn
                                          : light.state == LampState::Flashing ? kModeFlashing
                                                                               : 0);
    if (light.signal.empty()) return;
    wire::ExternalReference& source = *to.add_source_reference();
    source.set_type(kOpenDrive), source.add_identifier(kSignalId + light.signal);
}

void add_stationary(Message& to, uint64_t id, StationaryObject::Kind kind, const wire::BaseStationary& base,
                    uint32_t plate = 0) {
    const bool known = base.has_position() && is_place(base.position()) && is_turn(base.orientation());
    if (!known || to.stationary.size() >= size_t(kMostObjects)) {
        ++to.stationary_left_out;
        return;
    }
    to.stationary.push_back({.id = id,
                             .plate = plate,
                             .kind = kind,
                             .size = size_of(base.dimension()),
                             .centre = vector_of(base.position()),
                             .yaw = base.orientation().yaw(),
                             .pitch = base.orientation().pitch(),
                             .roll = base.orientation().roll()});
}

void add_stationary(Message& to, const wire::GroundTruth& truth) {
    using Kind = StationaryObject::Kind;
    for (const wire::StationaryObject& each : truth.stationary_object()) {
        const int type = each.classification().type();
        add_stationary(to, each.id().value(), type > 0 && type < int(Kind::Sign) ? Kind(type) : Kind::Unknown,
                       each.base());
    }
    for (const wire::TrafficSign& each : truth.traffic_sign()) {
        add_stationary(to, each.id().value(), Kind::Sign, each.main_sign().base());
        for (int i = 0; i < each.supplementary_sign_size(); ++i)
            add_stationary(to, each.id().value(), Kind::Sign, each.supplementary_sign(i).base(), uint32_t(i + 1));
    }
}

Environment environment_of(const wire::EnvironmentalConditions& from) {
    Environment e;
    if (from.sun().has_elevation() && std::abs(from.sun().elevation()) < 1.6) e.sun_elevation = from.sun().elevation();
    if (from.time_of_day().has_seconds_since_midnight() && from.time_of_day().seconds_since_midnight() < 86400)
        e.time_of_day = from.time_of_day().seconds_since_midnight();
    const int level = from.ambient_illumination() - 1;
    e.ambient_level = level >= 1 && level <= 9 ? level : 0;
    e.fog = from.fog() >= 7 && from.fog() <= 9,
    e.precipitation = from.precipitation() >= 3 && from.precipitation() <= 8;
    return e;
}

void set(wire::EnvironmentalConditions& to, const Environment& e) {
    if (e.sun_elevation) to.mutable_sun()->set_elevation(*e.sun_elevation);
    if (e.time_of_day) to.mutable_time_of_day()->set_seconds_since_midnight(uint32_t(*e.time_of_day));
    if (e.ambient_level > 0) to.set_ambient_illumination(e.ambient_level + 1);
    to.set_fog(e.fog ? 7 : 4), to.set_precipitation(e.precipitation ? 5 : 2);
}

bool has_object(const wire::GroundTruth& truth) {
    return std::any_of(truth.moving_object().begin(), truth.moving_object().end(),
                       [](const wire::MovingObject& o) { return o.base().has_position(); });
}

// Fields that a GroundTruth has of another type, or not at all, tell some other messages; null: none of them.
const char* other_message(std::span<const uint8_t> bytes) {
    const auto parses = [&](auto& message) { return message.ParseFromArray(bytes.data(), int(bytes.size())); };
    if (wire::SensorData data; parses(data)) {
        const bool views = std::any_of(data.sensor_view().begin(), data.sensor_view().end(),
                                       [](const wire::SensorView& v) { return v.has_global_ground_truth(); });
        if (views || data.sensor_id().has_value() || data.last_measurement_time().has_seconds() ||
            data.moving_object_size() > 0)
            return "SensorData, which is what a sensor found";
    }
    if (wire::SensorView view; parses(view)) {
        const int sensors = view.generic_sensor_view_size() + view.radar_sensor_view_size() +
                            view.lidar_sensor_view_size() + view.camera_sensor_view_size() +
                            view.ultrasonic_sensor_view_size();
        if (!view.has_global_ground_truth() && (sensors > 0 || view.host_vehicle_id().has_value()))
            return "SensorView without a global_ground_truth";
    }
    if (wire::TrafficUpdate update; parses(update)) {
        if (std::any_of(update.update().begin(), update.update().end(),
                        [](const wire::MovingObject& o) { return o.base().has_position(); }))
            return "TrafficUpdate";
    }
    return nullptr;
}

// A message does not say which it is. Field 7 is a traffic light of one, and the ground truth within the other.
struct Parsed {
    wire::GroundTruth truth;
    wire::SensorView view;
    bool is_view = false;
    explicit Parsed(std::span<const uint8_t> bytes) {
        const bool one = truth.ParseFromArray(bytes.data(), int(bytes.size()));
        if (one && has_object(truth)) return;
        is_view = view.ParseFromArray(bytes.data(), int(bytes.size())) && view.has_global_ground_truth() &&
                  (has_object(view.global_ground_truth()) || view.global_ground_truth().timestamp().has_seconds());
        if (is_view) return;
        if (const char* other = other_message(bytes))
            throw Error(std::string("is a ") + other + ": a GroundTruth, or a SensorView with one, is expected");
        if (!one) throw Error("is no GroundTruth or SensorView of OSI 3");
    }
};

}  // namespace

glm::dvec3 usual_size(MovingObject::Kind kind) {
    using Kind = MovingObject::Kind;
    switch (kind) {
        case Kind::Car:
            return {4.4, 1.8, 1.5};
        case Kind::Truck:
        case Kind::Bus:
        case Kind::Trailer:
            return {10, 2.5, 3};
        case Kind::Motorcycle:
            return {2.2, 0.8, 1.5};
        case Kind::Bicycle:
        case Kind::Pedestrian:
        case Kind::Animal:
            return {0.5, 0.6, 1.75};
        case Kind::Object:
            break;
    }
    return {0.5, 0.6, 1};
}

glm::dmat3 axes_of(double yaw, double pitch, double roll) {
    const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch),
                 cr = std::cos(roll), sr = std::sin(roll);
    return {{cy * cp, sy * cp, -sp},
            {cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr},
            {cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr}};
}

Message parse_message(std::span<const uint8_t> bytes) {
    if (bytes.size() > kMostMessageBytes)
        throw Error("has " + std::to_string(bytes.size()) + " bytes; a message has at most " +
                    std::to_string(kMostMessageBytes));
    const Parsed parsed(bytes);
    const wire::GroundTruth& truth = parsed.is_view ? parsed.view.global_ground_truth() : parsed.truth;
    const wire::Timestamp& time =
        truth.has_timestamp() || !parsed.is_view ? truth.timestamp() : parsed.view.timestamp();
    if (!time.has_seconds() && !time.has_nanos()) throw Error("has no timestamp");
    if (time.seconds() >= kMostSeconds || time.seconds() <= -kMostSeconds || time.nanos() >= kNanoseconds)
        throw Error("has a timestamp that cannot be");
    if (truth.moving_object_size() > kMostObjects || truth.traffic_light_size() > kMostObjects)
        throw Error("has more than " + std::to_string(kMostObjects) + " objects");
    Message message{.nanoseconds = time.seconds() * kNanoseconds + time.nanos()};
    if (truth.host_vehicle_id().has_value())
        message.host = truth.host_vehicle_id().value();
    else if (parsed.is_view && parsed.view.host_vehicle_id().has_value())
        message.host = parsed.view.host_vehicle_id().value();
    for (const wire::MovingObject& each : truth.moving_object())
        if (auto object = object_of(each)) message.objects.push_back(std::move(*object));
    for (const wire::TrafficLight& each : truth.traffic_light())
        if (auto light = light_of(each)) message.traffic_lights.push_back(std::move(*light));
    add_stationary(message, truth);
    if (truth.has_environmental_conditions()) message.environment = environment_of(truth.environmental_conditions());
    return message;
}

StationaryKey key_of(const StationaryObject& o) {
    const glm::dvec3 place = o.id == 0 ? o.centre : glm::dvec3(0);
    return {o.kind == StationaryObject::Kind::Sign, o.plate, o.id, place.x, place.y, place.z};
}

uint64_t memory_of(const Message& message) {
    uint64_t bytes = sizeof message + message.objects.size() * sizeof(MovingObject) +
                     message.traffic_lights.size() * sizeof(TrafficLight) +
                     message.stationary.size() * sizeof(StationaryObject);
    for (const MovingObject& object : message.objects) bytes += object.model.size();
    for (const TrafficLight& light : message.traffic_lights) bytes += light.signal.size();
    return bytes;
}

std::string bytes_of(const Message& message) {
    wire::GroundTruth truth;
    int64_t seconds = message.nanoseconds / kNanoseconds, rest = message.nanoseconds % kNanoseconds;
    if (rest < 0) --seconds, rest += kNanoseconds;
    truth.mutable_timestamp()->set_seconds(seconds), truth.mutable_timestamp()->set_nanos(uint32_t(rest));
    if (message.host) truth.mutable_host_vehicle_id()->set_value(*message.host);
    for (const MovingObject& object : message.objects) add(truth, object);
    for (const TrafficLight& light : message.traffic_lights) add(truth, light);
    if (message.environment) set(*truth.mutable_environmental_conditions(), *message.environment);
    return truth.SerializeAsString();
}

}  // namespace vesper::osi
