#include "signal_lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/one_line.h"

namespace vesper::drive {
namespace {

constexpr std::array kColours{"red", "yellow", "green"};  // from the top

using Mode = SignalLens::Mode;

const std::map<std::string, Mode> kModes{
    {"on", Mode::On},   {"steady", Mode::On},    {"constant", Mode::On},       {"solidon", Mode::On},
    {"off", Mode::Off}, {"solidoff", Mode::Off}, {"flashing", Mode::Flashing}, {"blinking", Mode::Flashing}};
const std::map<std::string, std::set<std::string>> kShining{{"red", {"red"}},
                                                            {"stop", {"red"}},
                                                            {"yellow", {"yellow"}},
                                                            {"amber", {"yellow"}},
                                                            {"orange", {"yellow"}},
                                                            {"green", {"green"}},
                                                            {"go", {"green"}},
                                                            {"redyellow", {"red", "yellow"}},
                                                            {"redamber", {"red", "yellow"}}};

// In lower case, parted at any of `at`, without spaces around them.
std::vector<std::string> words_of(const std::string& text, const std::string& at) {
    std::vector<std::string> words(1);
    for (const char c : text) {
        if (at.find(c) != at.npos)
            words.emplace_back();
        else if (c != ' ')
            words.back() += char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    }
    return words;
}

}  // namespace

bool SignalLens::shines(double seconds) const {
    const auto after =
        std::upper_bound(changes.begin(), changes.end(), seconds, [](double t, const Change& c) { return t < c.time; });
    if (after == changes.begin()) return otherwise;
    const Change& now = after[-1];
    return now.mode == Mode::On || (now.mode == Mode::Flashing && std::fmod(seconds - now.time, 1.0) < 0.5);
}

std::optional<std::vector<Mode>> lenses_in(const std::string& state, const std::vector<std::string>& colours) {
    std::vector<Mode> shown;
    for (const std::string& word : words_of(state, ";"))
        if (const auto mode = kModes.find(word); mode != kModes.end()) shown.push_back(mode->second);
    const size_t places = size_t(std::count(state.begin(), state.end(), ';')) + 1;
    if (shown.size() == places && places == colours.size()) return shown;

    std::set<std::string> shining;
    std::optional<Mode> how;
    for (const std::string& word : words_of(state, " ,+-_/")) {
        if (word.empty()) continue;
        const auto mode = kModes.find(word);
        const auto these = kShining.find(word);
        if (these != kShining.end())
            shining.insert(these->second.begin(), these->second.end());
        else if (mode != kModes.end() && !how)
            how = mode->second;
        else
            return std::nullopt;
    }
    // All dark is one word; of a lens that is named, on and flashing can be said; each of the colours must be there.
    if (shining.empty() != (how == Mode::Off)) return std::nullopt;
    shown.clear();
    for (const std::string& colour : colours)
        shown.push_back(shining.erase(colour) > 0 ? how.value_or(Mode::On) : Mode::Off);
    if (!shining.empty()) return std::nullopt;
    return shown;
}

std::vector<SignalLens> lenses_of(const scene::Scene& scene, const roads::RoadNetwork& network,
                                  const roads::EsminiRun& run, std::vector<std::string>& notes) {
    std::map<std::string, uint32_t> lamps;  // by the names of their nodes
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != scene::kNone) lamps.try_emplace(scene.nodes[i].name, i);
    std::map<std::string, std::vector<size_t>> set;  // events by signal
    for (size_t i = 0; i < run.signals.size(); ++i) set[run.signals[i].signal].push_back(i);

    std::vector<SignalLens> lenses;
    std::vector<bool> found(run.signals.size(), false);
    std::set<std::pair<std::string, std::string>> unknown;  // states, with their signals
    for (const roads::Road& road : network.roads)
        for (const roads::RoadSignal& signal : road.signals) {
            const std::string name = "signal_" + signal.id + "/";
            const bool on_foot = !lamps.contains(name + "yellow");
            std::vector<SignalLens> own;
            std::vector<std::string> colours;
            for (const char* colour : kColours) {
                const auto lamp = lamps.find(name + colour);
                if (lamp == lamps.end()) continue;
                own.push_back({.node = lamp->second,
                               .otherwise = colour == std::string(on_foot ? "green" : "red"),
                               .changes = {}});
                colours.emplace_back(colour);
                lamps.erase(lamp);  // of several signals with one id the first counts
            }
            if (own.empty()) continue;
            const auto events = set.find(set.contains(signal.id) ? signal.id : signal.name);
            for (const size_t i : events == set.end() ? std::vector<size_t>() : events->second) {
                const roads::SignalEvent& event = run.signals[i];
                found[i] = true;
                const auto shown = lenses_in(event.state, colours);
                for (size_t k = 0; shown && k < own.size(); ++k) own[k].changes.push_back({event.time, (*shown)[k]});
                if (!shown && unknown.emplace(event.signal, event.state).second)
                    notes.push_back(event.place + ": '" + one_line(event.state) + "' is no state of traffic light " +
                                    one_line(event.signal) + ": it stays as it is");
            }
            lenses.insert(lenses.end(), own.begin(), own.end());
        }
    std::set<std::string> missing;
    for (size_t i = 0; i < run.signals.size(); ++i)
        if (!found[i] && missing.insert(run.signals[i].signal).second)
            notes.push_back(run.signals[i].place + ": there is no traffic light " + one_line(run.signals[i].signal) +
                            " in the roads");
    return lenses;
}

}  // namespace vesper::drive
