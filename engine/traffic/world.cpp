#include "traffic/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace vesper::traffic {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kChangeSeconds = 3;  // of a change of lane
constexpr double kPatience = 1;       // between thoughts of changing lane, s
constexpr double kBraking =
    0.7;  // deceleration beyond which the pedal is pressed, m/s^2: engines alone give about this
constexpr double kWalkerRoom = 0.5;     // that a walker keeps before him, m
constexpr double kWalkerReach = 1.2;    // beyond the edge of a lane a walker counts as on it, m
constexpr double kExternalReach = 0.5;  // the same of external actors
constexpr double kGapSeconds =
    6;  // before walkers go, nobody may be nearer in time (HCM: critical gaps of 5 to 7 s for two lanes)
constexpr double kHidden = 50, kLook = 50;  // m below the ground, and along a lane from look to look
constexpr double kLying = 0.15;             // height of the middle of somebody who lies, m
constexpr double kQueue = 12;               // between cars that come in anew, m
// MOBIL (Kesting, Treiber and Helbing 2007): what others lose counts for so much, the gain must be so much, and nobody
// behind may have to brake harder, m/s^2.
constexpr double kPoliteness = 0.2, kGain = 0.2, kSafe = 3;

}  // namespace

World::World(std::shared_ptr<const WorldDescription> description, uint64_t seed)
    : description_(std::move(description)), random_(seed) {
    const WorldDescription& d = *description_;
    if (d.driver_lane >= d.lanes.size())
        throw Error("the driver's lane is none of the " + std::to_string(d.lanes.size()) + " there are");
    for (const TrafficCar& car : d.cars) {
        if (car.lane >= d.lanes.size()) throw Error("car " + car.node + ": there is no such lane");
        const double drawn = draw(0.9, 1.05);
        cars_.push_back({.s = car.s,
                         .speed = car.speed,
                         .speed_factor = car.speed_factor > 0 ? car.speed_factor : drawn,
                         .lane = car.lane,
                         .from = car.lane,
                         .patience = draw(0, kPatience)});
    }
    for (const Walker& walker : d.walkers) {
        if (walker.path >= d.paths.size()) throw Error("walker " + walker.node + ": there is no such path");
        walks_.push_back({.s = walker.s, .wait = walker.wait, .under_way = walker.s > 0});
    }
    for (const Course& path : d.paths) {
        constexpr double kStep = 0.1;  // m
        std::vector<glm::dvec3> points;
        for (double s = 0; s <= path.length(); s += kStep) points.push_back(path.at(path.length() - s).position);
        back_.emplace_back(path.name(), points, path.width(), path.speed());
        crossings_.emplace_back();
        for (size_t lane = 0; lane < d.lanes.size(); ++lane) find_crossings(path, lane);
    }
    for (const Course& lane : d.lanes)
        for (double s = 0; s <= lane.length(); s += kLook) below_ = std::min(below_, lane.at(s).position.y);
    below_ -= kHidden;
    driver_lane_ = d.driver_lane;
    const Course::Place start = d.lanes[driver_lane_].at(d.driver_s);
    driver_.position = {start.position.x, start.position.z};
    driver_.yaw = start.yaw;
    driver_.speed = d.driver_speed;
    touched_at_.assign(d.cars.size() + d.walkers.size() + d.external_nodes.size(), -kInfinite);
    occupy();
}

// Where a path is nearer to a lane than before and after; a loop may be crossed twice.
void World::find_crossings(const Course& path, size_t index) {
    const Course& lane = description_->lanes[index];
    Course::Beside last, before;
    last.distance = before.distance = kInfinite;
    for (double s = 0; s <= path.length() + 0.5; s += 0.5) {
        const glm::dvec3 at = path.at(s).position;
        const Course::Beside here = lane.beside({at.x, at.z});
        if (last.distance < 1 && last.distance <= before.distance && last.distance <= here.distance)
            crossings_.back().push_back({index, last.s});
        before = last, last = here;
    }
}

double World::draw(double low, double high) { return low + (high - low) * double(random_() >> 11) * 0x1p-53; }

void World::occupy() {
    occupants_.clear();
    const WorldDescription& d = *description_;
    for (size_t i = 0; i < cars_.size(); ++i) {
        const Car& car = cars_[i];
        occupants_.push_back({car.lane, car.s, car.speed, d.cars[i].length / 2, int(i)});
        if (car.change >= 1) continue;
        const glm::dvec3 at = place_of(i).position;
        occupants_.push_back(
            {car.from, d.lanes[car.from].beside({at.x, at.z}).s, car.speed, d.cars[i].length / 2, int(i)});
    }
    const Course::Place road = ground();
    for (size_t lane = 0; lane < d.lanes.size(); ++lane) {
        const Course& l = d.lanes[lane];
        const Course::Beside me = l.beside(driver_.position);
        const Course::Place here = l.at(me.s);
        if (me.distance < (l.width() + d.vehicle.width) / 2 - 0.4 &&
            std::abs(here.position.y - road.position.y) < kLevels) {
            const double along = driver_.speed * std::cos(driver_.yaw - here.yaw);
            occupants_.push_back({lane, me.s, along, d.vehicle.length / 2, kDriver});
        }
        for (const ExternalActor& external : external_actors_) {
            const Actor& a = external.actor;
            const Course::Beside beside = l.beside({a.position.x, a.position.z});
            if (beside.distance < l.width() / 2 + kExternalReach &&
                std::abs(l.at(beside.s).position.y - a.position.y) < kLevels)
                occupants_.push_back(
                    {lane, beside.s, a.speed * std::cos(a.yaw - l.at(beside.s).yaw), external.length / 2, kExternal});
        }
        for (size_t w = 0; w < walks_.size(); ++w) {
            if (!walks_[w].under_way) continue;
            const size_t path = d.walkers[w].path;
            const glm::dvec3 at = (walks_[w].back ? back_ : d.paths)[path].at(walks_[w].s).position;
            const Course::Beside there = l.beside({at.x, at.z});
            if (there.distance < l.width() / 2 + kWalkerReach && there.s > 0 && there.s < l.length())
                occupants_.push_back({lane, there.s, 0, 1, kWalker});
        }
    }
}

void World::place(std::vector<ExternalActor> actors, const std::optional<Actor>& driver) {
    external_actors_ = std::move(actors), host_ = driver;
    if (host_) {
        const VehicleParameters& p = description_->vehicle;
        driver_ = {.yaw = host_->yaw, .speed = host_->speed, .pitch = host_->pitch, .roll = host_->roll};
        driver_.position =
            glm::dvec2(host_->position.x, host_->position.z) - (p.front_axle - p.rear_axle) / 2 * driver_.forward();
        touched_ = braking_ = false;
    }
    occupy();
}

World::Neighbour World::ahead(size_t lane, double s, double half_length, int self) const {
    Neighbour best{kInfinite, 0};
    for (const Occupant& o : occupants_) {
        if (o.lane != lane || o.who == self) continue;
        const double away = description_->lanes[lane].ahead(s, o.s);
        if (away >= 0 && away - o.half_length - half_length < best.gap)
            best = {away - o.half_length - half_length, o.speed};
    }
    return best;
}

World::Neighbour World::behind(size_t lane, double s, double half_length, int self) const {
    Neighbour best{kInfinite, 0};
    for (const Occupant& o : occupants_) {
        if (o.lane != lane || o.who == self) continue;
        const double away = description_->lanes[lane].ahead(o.s, s);
        if (away >= 0 && away - o.half_length - half_length < best.gap)
            best = {away - o.half_length - half_length, o.speed};
    }
    return best;
}

double World::follow(const Car& car, size_t lane, double half_length, int self) const {
    double s = car.s;
    if (lane != car.lane) {
        const glm::dvec3 at = place_of(size_t(self)).position;
        s = description_->lanes[lane].beside({at.x, at.z}).s;
    }
    const Neighbour next = ahead(lane, s, half_length, self);
    return follow_lane(description_->lanes[lane], description_->autopilot.following, s, car.speed_factor, car.speed,
                       next.gap, car.speed - next.speed);
}

void World::consider_change(size_t index) {
    Car& car = cars_[index];
    const WorldDescription& d = *description_;
    const double half = d.cars[index].length / 2;
    const Course::Place place = d.lanes[car.lane].at(car.s);
    const double here = follow(car, car.lane, half, int(index));
    for (const int other : {d.lanes[car.lane].left, d.lanes[car.lane].right}) {
        if (other < 0) continue;
        const size_t number = size_t(other);
        const Course& lane = d.lanes[number];
        const Course::Beside there = lane.beside({place.position.x, place.position.z});
        // Only where the lanes run beside one another, now and after the change.
        const double later = car.speed * kChangeSeconds;
        const auto parallel = [&](double s, double t) {
            return std::abs(std::remainder(lane.at(there.s + s).yaw - d.lanes[car.lane].at(car.s + t).yaw,
                                           2 * std::numbers::pi)) < 0.02;
        };
        if (there.distance > 1.5 * lane.width() || !parallel(0, 0) || !parallel(later, later)) continue;
        const Neighbour next = ahead(number, there.s, half, int(index)),
                        last = behind(number, there.s, half, int(index));
        if (next.gap < 4 || last.gap < 4) continue;
        CarFollowing p = d.autopilot.following;
        p.speed = lane.speed_at(there.s);
        const double yields =
            std::isinf(last.gap) ? 0 : idm_acceleration(p, last.speed, last.gap, last.speed - car.speed);
        const double undisturbed =
            std::isinf(last.gap)
                ? 0
                : idm_acceleration(p, last.speed, last.gap + next.gap + 2 * half, last.speed - next.speed);
        if (yields < -kSafe ||
            follow(car, number, half, int(index)) - here < kGain + kPoliteness * (undisturbed - yields))
            continue;
        car.from = car.lane, car.lane = number, car.s = there.s, car.change = 0, car.offset = there.offset;
        return;
    }
}

void World::move_cars(double seconds) {
    const WorldDescription& d = *description_;
    for (size_t i = 0; i < cars_.size(); ++i) {
        Car& car = cars_[i];
        const double half = d.cars[i].length / 2;
        car.acceleration = follow(car, car.lane, half, int(i));
        if (car.change < 1) car.acceleration = std::min(car.acceleration, follow(car, car.from, half, int(i)));
    }
    for (size_t i = 0; i < cars_.size(); ++i) {
        Car& car = cars_[i];
        const double was = car.speed;
        car.speed = std::max(0.0, was + car.acceleration * seconds);
        car.s += (was + car.speed) / 2 * seconds;
        car.change = std::min(1.0, car.change + seconds / kChangeSeconds);
        car.patience -= seconds;
        if (car.patience <= 0 && car.change >= 1 && car.speed > 3) consider_change(i), car.patience = kPatience;
        const double length = d.lanes[car.lane].length();
        if (car.s <= length) continue;
        if (d.lanes[car.lane].closed()) {
            car.s -= length;
            continue;
        }
        // Comes in anew, behind whoever waits there.
        double s = 0;
        for (size_t k = 0; k < cars_.size(); ++k)
            if (k != i && cars_[k].lane == car.lane && cars_[k].s < kQueue) s = std::min(s, cars_[k].s - kQueue);
        // Behind the driver, too, and all who are no cars of the traffic; no faster than it can brake.
        for (const Occupant& o : occupants_)
            if (o.who < 0 && o.lane == car.lane && o.s < kQueue) s = std::min(s, o.s - kQueue);
        car.s = s, car.change = 1;
        const Neighbour next = ahead(car.lane, s, d.cars[i].length / 2, int(i));
        if (std::isfinite(next.gap))
            car.speed = std::min(car.speed, std::sqrt(next.speed * next.speed +
                                                      2 * d.autopilot.following.deceleration *
                                                          std::max(0.0, next.gap - d.autopilot.following.distance)));
    }
}

bool World::way_is_free(size_t path) const {
    for (const Crossing& crossing : crossings_[path])
        for (const Occupant& o : occupants_) {
            if (o.lane != crossing.lane || o.who == kWalker) continue;
            const Course& lane = description_->lanes[o.lane];
            const bool passing = lane.ahead(crossing.s, o.s) < 4 && lane.ahead(crossing.s, o.s) >= 0;
            const double gap = lane.ahead(o.s, crossing.s);
            if (passing || (gap >= 0 && gap < 6) || (gap >= 0 && o.speed > 0.5 && gap < o.speed * kGapSeconds))
                return false;
        }
    return true;
}

void World::move_walkers(double seconds) {
    const WorldDescription& d = *description_;
    for (size_t i = 0; i < walks_.size(); ++i) {
        Walk& walk = walks_[i];
        const Course& path = (walk.back ? back_ : d.paths)[d.walkers[i].path];
        walk.speed = 0;
        if (walk.fallen) continue;
        if (!walk.under_way) {
            walk.wait -= seconds;
            if (walk.wait <= 0 && way_is_free(d.walkers[i].path)) walk.under_way = true;
            continue;
        }
        // Nobody walks into a car that stands.
        const Course::Place next = path.at(walk.s + kWalkerRoom);
        if (std::abs(driver_.speed) < path.speed() &&
            ground_box(driver_, d.vehicle).contains({next.position.x, next.position.z}))
            continue;
        walk.speed = path.speed();
        walk.s += walk.speed * seconds;
        if (walk.s < path.length()) continue;
        walk = {.s = 0, .wait = draw(3, 12), .back = !walk.back};
    }
}

void World::move_driver(const DriverInput& input, double seconds) {
    const WorldDescription& d = *description_;
    const VehicleParameters& p = d.vehicle;
    VehicleControls controls;
    if (input.autopilot) {
        const Course& lane = d.lanes[driver_lane_];
        const Neighbour next = ahead(driver_lane_, lane.beside(driver_.position).s, p.length / 2, kDriver);
        controls = steer_along(lane, driver_, p, d.autopilot, next.gap, driver_.speed - next.speed);
    } else {
        controls = {input.steering * p.largest_angle, input.reverse ? -input.throttle : input.throttle, input.brake};
        // The lane that one is in is the one that the autopilot would take over.
        double nearest = kInfinite;
        const double road = ground().position.y;
        for (size_t lane = 0; lane < d.lanes.size(); ++lane) {
            const Course::Beside there = d.lanes[lane].beside(driver_.position);
            const Course::Place at = d.lanes[lane].at(there.s);
            const bool along = std::cos(driver_.yaw - at.yaw) > 0, level = std::abs(at.position.y - road) < kLevels;
            if (along && level && there.distance < nearest) nearest = there.distance, driver_lane_ = lane;
        }
    }
    braking_ = controls.brake > 0.05;
    const VehicleState before = driver_;
    advance(driver_, p, controls, seconds);
    touched_ = collide(driver_, before, p, d.barriers, ground().position.y);
}

void World::step(const DriverInput& input, double seconds) {
    input_ = input;
    const VehicleState before = driver_;
    if (!host_) move_driver(input, seconds);
    move_cars(seconds);
    move_walkers(seconds);
    if (!host_) meet_others(before);
    ++steps_;
    seconds_ += seconds;
    occupy();
}

Course::Place World::place_of(size_t index) const {
    const Car& car = cars_[index];
    Course::Place place = description_->lanes[car.lane].at(car.s);
    if (car.change >= 1) return place;
    // A quintic: no jerk at either end.
    const double t = car.change, left = 1 - t * t * t * (10 + t * (6 * t - 15)),
                 rate = 30 * t * t * (1 - t) * (1 - t) / kChangeSeconds;
    place.position += car.offset * left * glm::dvec3(-std::cos(place.yaw), 0, std::sin(place.yaw));
    place.yaw += std::atan2(-rate * car.offset, std::max(car.speed, 3.0));
    return place;
}

Course::Place World::ground() const {
    const Course& lane = description_->lanes[driver_lane_];
    return lane.at(lane.beside(driver_.position).s);
}

std::vector<Actor> World::actors() const {
    const WorldDescription& d = *description_;
    std::vector<Actor> actors;
    const Course::Place ground = World::ground();
    const double middle = (d.vehicle.front_axle - d.vehicle.rear_axle) / 2;
    const glm::dvec2 origin = driver_.position + middle * driver_.forward();
    actors.push_back({d.driver_node,
                      {origin.x, ground.position.y, origin.y},
                      driver_.yaw,
                      driver_.pitch + ground.slope * std::cos(driver_.yaw - ground.yaw),
                      driver_.roll,
                      driver_.speed,
                      lamps_of(input_.beam, input_.indicator, braking_, seconds_)});
    actors.front().lamps.reversing = input_.reverse;
    if (host_) {
        actors.front() = *host_;
        actors.front().node = d.driver_node, actors.front().scale = glm::dvec3(1);
    }
    for (size_t i = 0; i < cars_.size(); ++i) {
        const Car& car = cars_[i];
        const Course::Place at = place_of(i);
        const Indicator indicator = car.change >= 1  ? Indicator::None
                                    : car.offset < 0 ? Indicator::Left
                                                     : Indicator::Right;
        // Cars flash out of step.
        actors.push_back({d.cars[i].node, at.position, at.yaw, at.slope, 0, car.speed,
                          lamps_of(d.cars[i].beam, indicator, car.acceleration < -kBraking || car.speed < 0.1,
                                   seconds_ + 0.37 * double(i))});
    }
    for (size_t i = 0; i < walks_.size(); ++i) {
        const Walk& walk = walks_[i];
        const Course::Place at = (walk.back ? back_ : d.paths)[d.walkers[i].path].at(walk.s);
        actors.push_back({.node = d.walkers[i].node, .position = at.position, .yaw = at.yaw, .speed = walk.speed});
        if (walk.fallen) actors.back().pitch = std::numbers::pi / 2, actors.back().position.y += kLying;
    }
    // What is not there lies under the ground, in the dark.
    const size_t first = actors.size();
    for (const std::string& node : d.external_nodes) actors.push_back({.node = node, .position = {0, below_, 0}});
    for (const ExternalActor& external : external_actors_) {
        Actor& actor = actors[first + external.index];
        const std::string node = std::move(actor.node);
        actor = external.actor, actor.node = node;
    }
    return actors;
}

}  // namespace vesper::traffic
