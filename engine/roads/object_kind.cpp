// Kinds of objects. SPDX-License-Identifier: MIT
#include "roads/object_kind.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/words.h"

namespace vesper::roads {
namespace {

constexpr size_t kLongestName = 200;  // letters that are looked at

struct KindWords {
    ObjectKind kind;
    std::string_view words;  ///< between commas: single ones, or two
};

// The first that is found counts: "rail-pole" is a pole, a "post office building" is none.
constexpr KindWords kWords[] = {
    {ObjectKind::StreetLamp,
     "streetlamp, street lamp, streetlight, street light, lamppost, lamp post, lamppole, lamp pole, "
     "lightpole, light pole, luminaire, lamp, lantern, lamp standard, light standard, lighting column, "
     "lamp column, lightpost, light post, road light, roadlight, street lighting, laterne, laternen, "
     "straßenlaterne, straßenlaternen, strassenlaterne, strassenlaternen, straßenlampe, straßenlampen, "
     "strassenlampe, strassenlampen, straßenleuchte, straßenleuchten, strassenleuchte, strassenleuchten, "
     "straßenbeleuchtung, strassenbeleuchtung, mastleuchte, mastleuchten, peitschenleuchte, laternenmast, "
     "laternenpfahl, lichtmast, beleuchtungsmast, lampadaire, réverbère, reverbere, candélabre, "
     "candelabre, éclairage public, eclairage public, farola, farol, luminaria, luminária, alumbrado, "
     "poste luz, lampione, lampioni, lantaarn, lantaarns, straatlantaarn, straatlantaarns, lantaarnpaal, "
     "straatverlichting, latarnia, latarnie, lampa, lampy, lámpa, lampă, gatulampa, gatlykta, "
     "gatubelysning, lyktstolpe, belysningsstolpe, gadelampe, gadelygte, gatelys, gatelykt, katuvalo, "
     "katulamppu, lamba, lambası, фонарь, Фонарь"},
    {ObjectKind::GuidePost, "guidepost, guide post"},
    {ObjectKind::Gantry,
     "gantry, mastarm, mast arm, signal arm, cantilever, catenary, span wire, sign bridge, signal bridge, "
     "truss, sign portal, signal portal, gantry portal"},
    {ObjectKind::Bush, "bush"},
    {ObjectKind::Tree, "tree, vegetation"},
    {ObjectKind::Building, "building"},
    {ObjectKind::Pole, "pole, mast, post"},
    {ObjectKind::Railing, "rail, railing, guardrail, handrail"},
    {ObjectKind::Barrier, "barrier, fence"},
    {ObjectKind::Crosswalk, "crosswalk, cross walk"},
    {ObjectKind::ParkingSpace, "parkingspace, parking space"},
    {ObjectKind::RoadMark,
     "roadmark, stencil, arrow type, road arrow, lane arrow, turn arrow, left arrow, right arrow, "
     "straight arrow, arrow left, arrow right, arrow straight, mark, marking, stopline, stop line"},
    {ObjectKind::Patch, "patch"},
    {ObjectKind::Island, "island"},
};

/// Lamps after these words light no street: "traffic light pole", "warning lamp".
constexpr std::string_view kOtherLights[] = {"traffic", "signal", "warning", "hazard", "brake", "stop"};

// Languages that write without spaces: parts of names.
constexpr std::string_view kLampParts[] = {"路灯", "路燈",     "街灯",   "街燈",  "街路灯",
                                           "灯杆", "道路照明", "照明柱", "가로등"};

std::string_view singular(std::string_view word) {
    return word.ends_with('s') ? word.substr(0, word.size() - 1) : word;
}

/// Words without those that name the lamp of a signal.
std::vector<std::string> without_signals(const std::vector<std::string>& words) {
    std::vector<std::string> rest;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string_view word = singular(words[i]);
        const bool names_lamp = word == "light" || word == "lamp" || word == "lantern";
        const bool other = i > 0 && std::ranges::find(kOtherLights, words[i - 1]) != std::end(kOtherLights);
        const bool at_stop = i > 1 && words[i - 1] == "stop" && (words[i - 2] == "bus" || words[i - 2] == "tram");
        if (!names_lamp || !other || at_stop) rest.push_back(words[i]);
    }
    return rest;
}

/// Place in the list of a word, or of two, in singular or plural; the length of the list where it is not there.
size_t place_of(std::string_view word) {
    static const std::map<std::string_view, size_t> kPlaces = [] {
        std::map<std::string_view, size_t> places;
        for (size_t i = 0; i < std::size(kWords); ++i)
            for (std::string_view rest = kWords[i].words; !rest.empty();) {
                const size_t comma = std::min(rest.find(", "), rest.size());
                places.emplace(rest.substr(0, comma), i);
                rest.remove_prefix(std::min(comma + 2, rest.size()));
            }
        return places;
    }();
    for (const std::string_view plural : {"", "s", "es"})
        if (word.ends_with(plural))
            if (const auto found = kPlaces.find(word.substr(0, word.size() - plural.size())); found != kPlaces.end())
                return found->second;
    return std::size(kWords);
}

ObjectKind kind_of(std::string_view stated) {
    const std::string_view text = stated.substr(0, kLongestName);
    for (const std::string_view part : kLampParts)
        if (text.find(part) != text.npos) return ObjectKind::StreetLamp;
    const std::vector<std::string> words = without_signals(words_of(text));
    size_t best = std::size(kWords);
    for (size_t i = 0; i < words.size(); ++i) {
        best = std::min(best, place_of(words[i]));
        if (i > 0) best = std::min(best, place_of(words[i - 1] + " " + words[i]));
    }
    return best < std::size(kWords) ? kWords[best].kind : ObjectKind::Other;
}

}  // namespace

ObjectKind kind_of(const RoadObject& object) {
    ObjectKind found = ObjectKind::Other;
    for (const std::string* text : {&object.type, &object.subtype, &object.name}) {
        const ObjectKind said = kind_of(*text);
        const bool closer =
            (found == ObjectKind::Pole &&
             (said == ObjectKind::StreetLamp || said == ObjectKind::GuidePost || said == ObjectKind::Gantry)) ||
            (found == ObjectKind::Tree && said == ObjectKind::Bush);
        if (found == ObjectKind::Other || closer) found = said;
    }
    return found;
}

bool is_unnamed(const RoadObject& pole) {
    const std::vector<std::string> words = words_of(std::string_view(pole.name).substr(0, kLongestName));
    return std::ranges::all_of(words, [](const std::string& word) {
        return word == "pole" || word == "mast" || word == "post" || word == "object";
    });
}

bool is_flat(ObjectKind kind) {
    return kind == ObjectKind::Crosswalk || kind == ObjectKind::ParkingSpace || kind == ObjectKind::RoadMark ||
           kind == ObjectKind::Patch;
}

}  // namespace vesper::roads
