#include "external/external_bodies.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/one_line.h"
#include "external/lamp_name.h"
#include "external/plain_car.h"
#include "io/in_file.h"
#include "scene/append.h"
#include "scene/apply_photometry.h"
#include "scene_notes.h"

namespace vesper::drive {
namespace {

constexpr size_t kMostBodies = 2000;

// Boxes by the kinds of their objects, and how many wait where messages are not known beforehand.
struct PlainKind {
    const char* name;
    osi::MovingObject::Kind kind;
    bool lamps;
    size_t live;
};
using Kind = osi::MovingObject::Kind;
constexpr std::array<PlainKind, 6> kPlain{{{"car", Kind::Car, true, 32},
                                           {"truck", Kind::Truck, true, 8},
                                           {"motorcycle", Kind::Motorcycle, true, 4},
                                           {"trailer", Kind::Trailer, false, 4},
                                           {"person", Kind::Pedestrian, false, 16},
                                           {"thing", Kind::Object, false, 8}}};

const char* plain_kind(Kind kind) {
    if (kind == Kind::Bus) kind = Kind::Truck;
    if (kind == Kind::Bicycle || kind == Kind::Animal) kind = Kind::Pedestrian;
    return std::find_if(kPlain.begin(), kPlain.end(), [&](const PlainKind& k) { return k.kind == kind; })->name;
}

void add_roles(traffic::LampRoles& to, const traffic::LampRoles& more) {
    for (const auto& [name, role] : traffic::kLampRoles)
        for (const std::string& lamp : more.*role)
            if (std::find((to.*role).begin(), (to.*role).end(), lamp) == (to.*role).end()) (to.*role).push_back(lamp);
}

// Lamps that the table names must be there, by the names that Scenery has for them.
void check_lamps(const Model& model, const scene::Scene& scene) {
    std::set<std::string> names;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != scene::kNone) names.insert(lamp_name(scene, i));
    for (const auto& [role, lamps] : traffic::kLampRoles)
        for (const std::string& lamp : model.roles.*lamps)
            if (!names.contains(lamp))
                throw Error(model.place + "/lamps/" + role + ": " + one_line(model.scene.string()) +
                            " has no lamp of the name " + one_line(lamp));
}

}  // namespace

ExternalBodies::ExternalBodies(scene::Scene& scene, traffic::WorldFile& file, const MessageSource& source,
                               std::span<const osi::Message> messages) {
    traffic::WorldDescription& world = file.world;
    for (const traffic::TrafficCar& car : world.cars)
        if (!car.node.empty()) world.external_nodes.push_back(car.node);
    for (const traffic::Walker& walker : world.walkers)
        if (!walker.node.empty()) world.external_nodes.push_back(walker.node);
    world.cars.clear(), world.walkers.clear();
    for (const std::string& node : world.external_nodes) nodes_.insert(node), all_.push_back({.kind = "node " + node});
    if (!source.models.empty()) models_ = read_models(source.models);
    std::map<std::string, size_t> wanted = most_at_once(*this, messages);
    for (size_t i = 0; i < models_.size(); ++i) {
        const size_t known = wanted["model " + std::to_string(i)];
        add_model(scene, file, i, source.live ? models_[i].places : known);
    }
    for (const PlainKind& plain : kPlain)
        add_plain(scene, file, plain.name, source.live ? plain.live : wanted[plain.name]);
    if (all_.size() > kMostBodies)
        throw Error("objects need more than " + std::to_string(kMostBodies) +
                    " bodies at once (of messages, or as the places of --models say)");
}

std::string ExternalBodies::kind_of(const osi::MovingObject& object) const {
    if (nodes_.contains(object.model)) return "node " + object.model;
    for (size_t i = 0; i < models_.size(); ++i)
        if (models_[i].is_meant_by(object.model)) return "model " + std::to_string(i);
    return plain_kind(object.kind);
}

glm::dvec3 ExternalBodies::size_of(const osi::MovingObject& object) {
    const bool known = object.size.x > 0 && object.size.y > 0 && object.size.z > 0;
    return known ? object.size : osi::usual_size(object.kind);
}

void ExternalBodies::add_plain(scene::Scene& scene, traffic::WorldFile& file, const std::string& kind, size_t count) {
    const auto plain = std::find_if(kPlain.begin(), kPlain.end(), [&](const PlainKind& k) { return k.name == kind; });
    const glm::dvec3 size = osi::usual_size(plain->kind);
    const PlainBody body{.size = size, .centre = {0, 0, size.z / 2}, .lamps = plain->lamps};
    if (count > 0 && plain->lamps) add_roles(file.roles, plain_lamps());
    for (size_t i = 0; i < count && all_.size() <= kMostBodies; ++i) {
        const std::string node = "external_" + std::to_string(all_.size());
        scene.nodes.push_back({.name = node});
        add_plain_body(scene, uint32_t(scene.nodes.size() - 1), "plain " + kind, body);
        file.world.external_nodes.push_back(node);
        all_.push_back({.kind = kind, .size = size});
    }
}

void ExternalBodies::add_model(scene::Scene& scene, traffic::WorldFile& file, size_t index, size_t count) {
    if (count == 0) return;
    const Model& model = models_[index];
    scene::LoadedScene loaded = scene::read_lit_scene(model.scene, model.photometry);
    check_lamps(model, loaded.scene);
    const std::vector<std::string> said = apps::notes_of(loaded, model.scene.string());
    notes_.insert(notes_.end(), said.begin(), said.end());
    const auto insert =
        io::in_file(model.scene.string(), [&] { return scene::SceneInsert(scene, std::move(loaded.scene)); });
    for (size_t i = 0; i < count && all_.size() <= kMostBodies; ++i) {
        const std::string node = "external_" + std::to_string(all_.size());
        insert.add(scene, node);
        file.world.external_nodes.push_back(node), file.turns[node] = model.turn;
        all_.push_back({.kind = "model " + std::to_string(index)});
    }
    add_roles(file.roles, model.roles);
}

std::map<std::string, size_t> most_at_once(const ExternalBodies& bodies, std::span<const osi::Message> messages) {
    std::map<std::string, size_t> most;
    for (const osi::Message& message : messages) {
        std::map<std::string, size_t> now;
        for (const osi::MovingObject& object : message.objects) ++now[bodies.kind_of(object)];
        for (const auto& [kind, count] : now) most[kind] = std::max(most[kind], count);
    }
    return most;
}

}  // namespace vesper::drive
