#include "external/signal_lens.h"

#include <algorithm>
#include <map>

#include "base/lower.h"

namespace vesper::drive {
namespace {

using Colour = osi::TrafficLight::Colour;
constexpr double kNear = 1.5;  // m: opposite sides of a pole are nearer, but other signals are farther

const std::map<std::string, Colour> kColours{
    {"red", Colour::Red}, {"yellow", Colour::Yellow}, {"amber", Colour::Yellow}, {"green", Colour::Green}};

// The first word of a name that is a colour.
Colour colour_in(const std::string& name) {
    std::string word;
    for (const char c : lower(name) + " ") {
        if (c >= 'a' && c <= 'z') {
            word += c;
            continue;
        }
        if (const auto colour = kColours.find(word); colour != kColours.end()) return colour->second;
        word.clear();
    }
    return Colour::Other;
}

std::string signal_in(const std::string& node) {
    constexpr std::string_view kBegin = "signal_";
    const size_t slash = node.rfind('/');
    return node.starts_with(kBegin) && slash != node.npos ? node.substr(kBegin.size(), slash - kBegin.size()) : "";
}

}  // namespace

bool SignalLens::shines(double seconds) const {
    if (!phase) return otherwise;
    const roads::SignalAspect aspect = roads::aspect_at(*phase, seconds);
    return (colour == Colour::Red && aspect == roads::SignalAspect::Red) ||
           (colour == Colour::Yellow && aspect == roads::SignalAspect::Amber) ||
           (colour == Colour::Green && aspect == roads::SignalAspect::Green);
}

std::vector<SignalLens> lenses_of(const scene::Scene& scene, const std::map<std::string, roads::SignalPhase>& phases) {
    std::vector<SignalLens> lenses;
    std::map<std::string, bool> for_cars;
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const scene::Node& node = scene.nodes[i];
        if (node.lamp == scene::kNone) continue;
        SignalLens lens{.node = i, .signal = signal_in(node.name), .position = glm::dvec3(world[i][3])};
        lens.colour = colour_in(node.name);
        if (lens.colour == Colour::Other) lens.colour = colour_in(scene.lamps[node.lamp].name);
        if (lens.colour == Colour::Other) continue;
        if (const auto phase = phases.find("signal_" + lens.signal); phase != phases.end()) lens.phase = phase->second;
        for_cars[lens.signal] |= lens.colour == Colour::Yellow;
        lenses.push_back(std::move(lens));
    }
    for (SignalLens& lens : lenses)
        lens.otherwise = lens.signal.empty() || lens.colour == (for_cars[lens.signal] ? Colour::Red : Colour::Green);
    return lenses;
}

uint32_t LensFinder::find(const std::vector<SignalLens>& lenses, const osi::TrafficLight& light,
                          const glm::dvec3& position) {
    const auto [known, is_new] = known_.try_emplace({light.id, light.colour}, scene::kNone);
    if (!is_new) return known->second;
    double nearest = kNear;
    for (uint32_t i = 0; i < lenses.size(); ++i) {
        if (lenses[i].colour != light.colour) continue;
        const bool named = !light.signal.empty() && lenses[i].signal == light.signal;
        const double distance = named ? 0 : glm::distance(lenses[i].position, position);
        if (distance <= nearest && (named || distance < nearest)) nearest = distance, known->second = i;
        if (named) break;
    }
    return known->second;
}

}  // namespace vesper::drive
