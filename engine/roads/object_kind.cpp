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
                                                              {"mark", ObjectKind::RoadMark},
                                                              {"marking", ObjectKind::RoadMark},
                                                              {"stopline", ObjectKind::RoadMark},
                                                              {"stop line", ObjectKind::RoadMark},
                                                              {"patch", ObjectKind::Patch},
                                                              {"island", ObjectKind::Island}};

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
