#include "signal_lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include "io/atomic_file.h"

namespace vesper {
namespace {

constexpr std::array kColours{"red", "yellow", "green"};  // from the top

std::optional<SignalLens::Mode> mode_of(std::string word) {
    std::erase(word, ' ');
    if (word == "on") return SignalLens::Mode::On;
    if (word == "off") return SignalLens::Mode::Off;
    if (word == "flashing") return SignalLens::Mode::Flashing;
    return std::nullopt;
}

}  // namespace

bool SignalLens::shines(double seconds) const {
    const auto after = std::upper_bound(changes.begin(), changes.end(), seconds, [](double t, const Change& c) { return t < c.time; });
    if (after == changes.begin()) return otherwise;
    const Change& now = after[-1];
    return now.mode == Mode::On || (now.mode == Mode::Flashing && std::fmod(seconds - now.time, 1.0) < 0.5);
}

std::optional<SignalLens::Mode> lens_in(const std::string& state, size_t place, const std::string& colour) {
    if (state.find(';') == state.npos && state != "on" && state != "flashing") {
        if (state == "off") return SignalLens::Mode::Off;
        const auto names = [&](const std::string& word) { return state.find(word) != state.npos; };
        if (!names("red") && !names("yellow") && !names("amber") && !names("green")) return std::nullopt;
        return names(colour) || (colour == "yellow" && names("amber")) ? SignalLens::Mode::On : SignalLens::Mode::Off;
    }
    std::istringstream parts(state);
    std::string word;
    for (size_t i = 0; std::getline(parts, word, ';'); ++i)
        if (i == place) return mode_of(word);
    return std::nullopt;
}

std::vector<SignalLens> lenses_of(const Scene& scene, const RoadNetwork& network, const EsminiRun& run, std::vector<std::string>& notes) {
    std::map<std::string, uint32_t> lamps;  // by the names of their nodes
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].light != kNone) lamps.try_emplace(scene.nodes[i].name, i);
    std::map<std::string, std::vector<size_t>> set;  // events by signal
    for (size_t i = 0; i < run.signals.size(); ++i) set[run.signals[i].signal].push_back(i);

    std::vector<SignalLens> lenses;
    std::vector<bool> known(run.signals.size(), false);
    for (const Road& road : network.roads)
        for (const RoadSignal& signal : road.signals) {
            const std::string name = "signal_" + signal.id + "/";
            const auto events = set.find(set.contains(signal.id) ? signal.id : signal.name);
            const bool on_foot = !lamps.contains(name + "yellow");
            size_t place = 0;
            for (const char* colour : kColours) {
                const auto lamp = lamps.find(name + colour);
                if (lamp == lamps.end()) continue;
                SignalLens lens{.node = lamp->second, .otherwise = colour == std::string(on_foot ? "green" : "red"), .changes = {}};
                if (events != set.end())
                    for (const size_t i : events->second)
                        if (const auto mode = lens_in(run.signals[i].state, place, colour)) lens.changes.push_back({run.signals[i].time, *mode}), known[i] = true;
                lenses.push_back(std::move(lens));
                lamps.erase(lamp);  // of several signals with one id the first counts
                ++place;
            }
        }
    for (size_t i = 0; i < run.signals.size(); ++i)
        if (!known[i]) {
            notes.push_back("traffic light " + one_line(run.signals[i].signal) + ": there is none in the roads, or '" + one_line(run.signals[i].state) + "' is no state of it");
            break;
        }
    return lenses;
}

}  // namespace vesper
