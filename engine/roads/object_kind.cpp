// Kinds of objects. SPDX-License-Identifier: MIT
#include "roads/object_kind.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include "base/lower.h"

namespace vesper::roads {
namespace {

constexpr size_t kLongestName = 200;  // letters that are looked at

// The first that is found counts: "rail-pole" is a pole.
constexpr std::pair<std::string_view, ObjectKind> kWords[] = {{"streetlamp", ObjectKind::StreetLamp},
                                                              {"street lamp", ObjectKind::StreetLamp},
                                                              {"streetlight", ObjectKind::StreetLamp},
                                                              {"street light", ObjectKind::StreetLamp},
                                                              {"lamppost", ObjectKind::StreetLamp},
                                                              {"lamp post", ObjectKind::StreetLamp},
                                                              {"lamppole", ObjectKind::StreetLamp},
                                                              {"lamp pole", ObjectKind::StreetLamp},
                                                              {"lightpole", ObjectKind::StreetLamp},
                                                              {"light pole", ObjectKind::StreetLamp},
                                                              {"luminaire", ObjectKind::StreetLamp},
                                                              {"lamp", ObjectKind::StreetLamp},
                                                              {"lantern", ObjectKind::StreetLamp},
                                                              {"lamp standard", ObjectKind::StreetLamp},
                                                              {"light standard", ObjectKind::StreetLamp},
                                                              {"lighting column", ObjectKind::StreetLamp},
                                                              {"lamp column", ObjectKind::StreetLamp},
                                                              {"lightpost", ObjectKind::StreetLamp},
                                                              {"light post", ObjectKind::StreetLamp},
                                                              {"road light", ObjectKind::StreetLamp},
                                                              {"roadlight", ObjectKind::StreetLamp},
                                                              {"street lighting", ObjectKind::StreetLamp},
                                                              {"laterne", ObjectKind::StreetLamp},
                                                              {"laternen", ObjectKind::StreetLamp},
                                                              {"straßenlaterne", ObjectKind::StreetLamp},
                                                              {"straßenlaternen", ObjectKind::StreetLamp},
                                                              {"strassenlaterne", ObjectKind::StreetLamp},
                                                              {"strassenlaternen", ObjectKind::StreetLamp},
                                                              {"straßenlampe", ObjectKind::StreetLamp},
                                                              {"straßenlampen", ObjectKind::StreetLamp},
                                                              {"strassenlampe", ObjectKind::StreetLamp},
                                                              {"strassenlampen", ObjectKind::StreetLamp},
                                                              {"straßenleuchte", ObjectKind::StreetLamp},
                                                              {"straßenleuchten", ObjectKind::StreetLamp},
                                                              {"strassenleuchte", ObjectKind::StreetLamp},
                                                              {"strassenleuchten", ObjectKind::StreetLamp},
                                                              {"straßenbeleuchtung", ObjectKind::StreetLamp},
                                                              {"strassenbeleuchtung", ObjectKind::StreetLamp},
                                                              {"mastleuchte", ObjectKind::StreetLamp},
                                                              {"mastleuchten", ObjectKind::StreetLamp},
                                                              {"peitschenleuchte", ObjectKind::StreetLamp},
                                                              {"laternenmast", ObjectKind::StreetLamp},
                                                              {"laternenpfahl", ObjectKind::StreetLamp},
                                                              {"lichtmast", ObjectKind::StreetLamp},
                                                              {"beleuchtungsmast", ObjectKind::StreetLamp},
                                                              {"lampadaire", ObjectKind::StreetLamp},
                                                              {"réverbère", ObjectKind::StreetLamp},
                                                              {"reverbere", ObjectKind::StreetLamp},
                                                              {"candélabre", ObjectKind::StreetLamp},
                                                              {"candelabre", ObjectKind::StreetLamp},
                                                              {"éclairage public", ObjectKind::StreetLamp},
                                                              {"eclairage public", ObjectKind::StreetLamp},
                                                              {"farola", ObjectKind::StreetLamp},
                                                              {"farol", ObjectKind::StreetLamp},
                                                              {"luminaria", ObjectKind::StreetLamp},
                                                              {"luminária", ObjectKind::StreetLamp},
                                                              {"alumbrado", ObjectKind::StreetLamp},
                                                              {"poste luz", ObjectKind::StreetLamp},
                                                              {"lampione", ObjectKind::StreetLamp},
                                                              {"lampioni", ObjectKind::StreetLamp},
                                                              {"lantaarn", ObjectKind::StreetLamp},
                                                              {"lantaarns", ObjectKind::StreetLamp},
                                                              {"straatlantaarn", ObjectKind::StreetLamp},
                                                              {"straatlantaarns", ObjectKind::StreetLamp},
                                                              {"lantaarnpaal", ObjectKind::StreetLamp},
                                                              {"straatverlichting", ObjectKind::StreetLamp},
                                                              {"latarnia", ObjectKind::StreetLamp},
                                                              {"latarnie", ObjectKind::StreetLamp},
                                                              {"lampa", ObjectKind::StreetLamp},
                                                              {"lampy", ObjectKind::StreetLamp},
                                                              {"lámpa", ObjectKind::StreetLamp},
                                                              {"lampă", ObjectKind::StreetLamp},
                                                              {"gatulampa", ObjectKind::StreetLamp},
                                                              {"gatlykta", ObjectKind::StreetLamp},
                                                              {"gatubelysning", ObjectKind::StreetLamp},
                                                              {"lyktstolpe", ObjectKind::StreetLamp},
                                                              {"belysningsstolpe", ObjectKind::StreetLamp},
                                                              {"gadelampe", ObjectKind::StreetLamp},
                                                              {"gadelygte", ObjectKind::StreetLamp},
                                                              {"gatelys", ObjectKind::StreetLamp},
                                                              {"gatelykt", ObjectKind::StreetLamp},
                                                              {"katuvalo", ObjectKind::StreetLamp},
                                                              {"katulamppu", ObjectKind::StreetLamp},
                                                              {"lamba", ObjectKind::StreetLamp},
                                                              {"lambası", ObjectKind::StreetLamp},
                                                              {"фонарь", ObjectKind::StreetLamp},
                                                              {"Фонарь", ObjectKind::StreetLamp},
                                                              {"guidepost", ObjectKind::GuidePost},
                                                              {"guide post", ObjectKind::GuidePost},
                                                              {"gantry", ObjectKind::Gantry},
                                                              {"mastarm", ObjectKind::Gantry},
                                                              {"mast arm", ObjectKind::Gantry},
                                                              {"signal arm", ObjectKind::Gantry},
                                                              {"cantilever", ObjectKind::Gantry},
                                                              {"catenary", ObjectKind::Gantry},
                                                              {"span wire", ObjectKind::Gantry},
                                                              {"sign bridge", ObjectKind::Gantry},
                                                              {"signal bridge", ObjectKind::Gantry},
                                                              {"portal", ObjectKind::Gantry},
                                                              {"truss", ObjectKind::Gantry},
                                                              {"bush", ObjectKind::Bush},
                                                              {"tree", ObjectKind::Tree},
                                                              {"vegetation", ObjectKind::Tree},
                                                              {"pole", ObjectKind::Pole},
                                                              {"mast", ObjectKind::Pole},
                                                              {"post", ObjectKind::Pole},
                                                              {"rail", ObjectKind::Railing},
                                                              {"railing", ObjectKind::Railing},
                                                              {"guardrail", ObjectKind::Railing},
                                                              {"handrail", ObjectKind::Railing},
                                                              {"barrier", ObjectKind::Barrier},
                                                              {"fence", ObjectKind::Barrier},
                                                              {"building", ObjectKind::Building},
                                                              {"crosswalk", ObjectKind::Crosswalk},
                                                              {"cross walk", ObjectKind::Crosswalk},
                                                              {"parkingspace", ObjectKind::ParkingSpace},
                                                              {"parking space", ObjectKind::ParkingSpace},
                                                              {"roadmark", ObjectKind::RoadMark},
                                                              {"stencil", ObjectKind::RoadMark},
                                                              {"arrow type", ObjectKind::RoadMark},
                                                              {"road arrow", ObjectKind::RoadMark},
                                                              {"lane arrow", ObjectKind::RoadMark},
                                                              {"turn arrow", ObjectKind::RoadMark},
                                                              {"left arrow", ObjectKind::RoadMark},
                                                              {"right arrow", ObjectKind::RoadMark},
                                                              {"straight arrow", ObjectKind::RoadMark},
                                                              {"arrow left", ObjectKind::RoadMark},
                                                              {"arrow right", ObjectKind::RoadMark},
                                                              {"arrow straight", ObjectKind::RoadMark},

                                                              {"mark", ObjectKind::RoadMark},
                                                              {"marking", ObjectKind::RoadMark},
                                                              {"stopline", ObjectKind::RoadMark},
                                                              {"stop line", ObjectKind::RoadMark},
                                                              {"patch", ObjectKind::Patch},
                                                              {"island", ObjectKind::Island}};

// Languages that write without spaces: parts of names.
constexpr std::string_view kLampParts[] = {"路灯", "路燈",     "街灯",   "街燈",  "街路灯",
                                           "灯杆", "道路照明", "照明柱", "가로등"};

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
}
bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }

/// "LEDStreetLamp_03" as "led street lamp ".
std::string words_of(std::string_view text) {
    std::string words;
    const auto end_word = [&] {
        if (!words.empty() && words.back() != ' ') words += ' ';
    };
    for (size_t i = 0; i < text.size(); ++i) {
        const bool after_capital = i > 0 && is_capital(text[i - 1]),
                   before_small = i + 1 < text.size() && text[i + 1] >= 'a' && text[i + 1] <= 'z';
        if (!is_letter(text[i]) || (is_capital(text[i]) && (!after_capital || before_small))) end_word();
        if (is_letter(text[i])) words += text[i];
    }
    end_word();
    return lower(words);
}

/// Place in the list of a word, or of two, in singular or plural; the length of the list where it is not there.
size_t place_of(std::string_view word) {
    static const std::map<std::string_view, size_t> kPlaces = [] {
        std::map<std::string_view, size_t> places;
        for (size_t i = 0; i < std::size(kWords); ++i) places.emplace(kWords[i].first, i);
        return places;
    }();
    for (const std::string_view plural : {"", "s", "es"})
        if (word.ends_with(plural))
            if (const auto found = kPlaces.find(word.substr(0, word.size() - plural.size())); found != kPlaces.end())
                return found->second;
    return std::size(kWords);
}

ObjectKind kind_of(std::string_view text) {
    const std::string words = words_of(text.substr(0, kLongestName));
    for (const std::string_view part : kLampParts)
        if (words.find(part) != words.npos) return ObjectKind::StreetLamp;
    size_t best = std::size(kWords), before = 0;
    for (size_t at = 0; at < words.size();) {
        const size_t end = words.find(' ', at);
        const std::string_view all = words;
        best = std::min({best, place_of(all.substr(at, end - at)), place_of(all.substr(before, end - before))});
        before = at, at = end + 1;
    }
    return best < std::size(kWords) ? kWords[best].second : ObjectKind::Other;
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

bool is_flat(ObjectKind kind) {
    return kind == ObjectKind::Crosswalk || kind == ObjectKind::ParkingSpace || kind == ObjectKind::RoadMark ||
           kind == ObjectKind::Patch;
}

}  // namespace vesper::roads
