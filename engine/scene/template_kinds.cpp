// Kinds of sources, by the words of their names. SPDX-License-Identifier: MIT
#include "scene/template_kinds.h"

#include <algorithm>
#include <iterator>

#include "base/words.h"

namespace vesper::scene {
namespace {

constexpr size_t kLongestPart = 200;  // bytes of a part of a name that are looked at
constexpr size_t kMostParts = 10;     // of a name that are looked at, the last ones

constexpr glm::dvec3 kRed{1, 0.02, 0.01}, kAmber{1, 0.35, 0.02}, kGreen{0.05, 1, 0.55};

// Intensities and openings are those of docs/photometry.md and of the Rivoli street; the first that is named counts.
const SourceKind kKinds[] = {
    {.name = "turn signal",
     .compounds = "turnsignal,turn+,turnindicator,indicator,blinker,blink+",
     .candela = 200,
     .inner = 5,
     .outer = 50,
     .of_vehicle = true,
     .colour = kAmber,
     .width = 0.15,
     .height = 0.1,
     .luminance = 2000},
    {.name = "fog lamp",
     .compounds = "fog,frontfog,nebel",
     .standard = "front-fog",
     .of_vehicle = true,
     .kelvin = 3000,
     .width = 0.12,
     .round = true,
     .luminance = 5000},
    {.name = "high beam",
     .compounds = "highbeam,mainbeam,fern+",
     .standard = "high-beam",
     .of_vehicle = true,
     .kelvin = 3800,
     .width = 0.15,
     .round = true,
     .luminance = 20000},
    {.name = "brake lamp",
     .compounds = "brake,brems",
     .candela = 60,
     .inner = 10,
     .outer = 55,
     .of_vehicle = true,
     .colour = kRed,
     .width = 0.2,
     .height = 0.1,
     .luminance = 2000},
    {.name = "tail lamp",
     .compounds = "tail,rear+,rück+,rueck+,schluss+",
     .candela = 5,
     .inner = 10,
     .outer = 55,
     .of_vehicle = true,
     .colour = kRed,
     .width = 0.2,
     .height = 0.26,
     .luminance = 100},
    {.name = "headlamp",
     .compounds = "headlamp,headlight,headl ,front+,lowbeam,dippedbeam,abblend,scheinwerfer",
     .standard = "low-beam",
     .of_vehicle = true,
     .kelvin = 3800,
     .width = 0.265,
     .height = 0.14,
     .luminance = 20000},
    {.name = "red signal",
     .candela = 100,
     .inner = 5,
     .outer = 40,
     .colour = kRed,
     .width = 0.193,
     .round = true,
     .luminance = 3400},
    {.name = "amber signal",
     .candela = 100,
     .inner = 5,
     .outer = 40,
     .colour = kAmber,
     .width = 0.193,
     .round = true,
     .luminance = 3400},
    {.name = "green signal",
     .candela = 100,
     .inner = 5,
     .outer = 40,
     .colour = kGreen,
     .width = 0.193,
     .round = true,
     .luminance = 3400},
    {.name = "sign",
     .compounds = "neon,sign,billboard,advert,reklame,leuchtreklame,schild,poster,screen,display",
     .kelvin = 6500,
     .luminance = 200},
    {.name = "lit window", .kelvin = 2700, .luminance = 30},
    {.name = "window", .compounds = "window,fenster", .kelvin = 2700, .luminance = 3},
    {.name = "street lamp",
     .compounds = "street+,road+,lamppost,lamppole,lampmast,lightpole,lightpost,lightmast,lightcolumn,pole+,"
                  "luminaire,lantern,laterne,gaslaterne,strassen+,straßen+,mastleuchte,peitschen+",
     .standard = "street-lamp",
     .kelvin = 3000,
     .width = 0.45,
     .height = 0.2,
     .luminance = 8000},
    {.name = "lamp", .candela = 100, .kelvin = 2700, .width = 0.2, .round = true, .luminance = 2000},
};
constexpr std::string_view kSignals = "traffic+,trafficsignal,signal,ampel,semaphor";
constexpr std::string_view kColours[][4] = {
    {"red", "rot", "stop", "rosso"}, {"amber", "yellow", "orange", "gelb"}, {"green", "grün", "gruen", "go"}};

/// Whether `text` begins with a compound: "street+" stands before a word for a lamp, "headl " is a whole word.
bool begins_with(std::string_view text, const std::string& word, std::string_view compound) {
    constexpr std::string_view kLamps[] = {"lamp",    "light",     "licht",    "leuchte", "latern",
                                           "lantern", "luminaire", "strahler", "bulb"};
    if (compound.ends_with(' ')) return word == compound.substr(0, compound.size() - 1);
    if (compound.ends_with('+')) {
        const std::string_view before = compound.substr(0, compound.size() - 1);
        return text.starts_with(before) && std::ranges::any_of(kLamps, [&](std::string_view lamp) {
                   return text.substr(before.size()).starts_with(lamp);
               });
    }
    // "sign" begins "signal", which is another kind.
    return text.starts_with(compound) && !(compound == "sign" && text.starts_with("signal"));
}

/// Whether one of the compounds begins at the beginning of a word.
bool has(const std::vector<std::string>& words, std::string_view compounds) {
    std::string rest;
    for (size_t i = words.size(); i-- > 0;) {
        rest.insert(0, words[i]);
        for (std::string_view left = compounds; !left.empty();) {
            const std::string_view compound = left.substr(0, left.find(','));
            if (begins_with(rest, words[i], compound)) return true;
            left.remove_prefix(std::min(compound.size() + 1, left.size()));
        }
    }
    return false;
}

bool has_word(const std::vector<std::string>& words, std::span<const std::string_view> wanted) {
    return std::ranges::any_of(words,
                               [&](const std::string& w) { return std::ranges::find(wanted, w) != wanted.end(); });
}

const SourceKind& named(std::string_view name) {
    return *std::ranges::find_if(kKinds, [&](const SourceKind& kind) { return kind.name == name; });
}

/// 0 red, 1 amber, 2 green, 3 none.
size_t colour_of(const std::vector<std::string>& words) {
    size_t i = 0;
    while (i < 3 && !has_word(words, kColours[i])) ++i;
    return i;
}

}  // namespace

std::vector<std::vector<std::string>> parts_of(const std::string& name) {
    std::vector<std::vector<std::string>> parts;
    for (size_t end = name.size();;) {
        const size_t slash = end == 0 ? std::string::npos : name.rfind('/', end - 1);
        const size_t start = slash == std::string::npos ? 0 : slash + 1;
        parts.push_back(words_of(std::string_view(name).substr(start, std::min(end - start, kLongestPart))));
        if (slash == std::string::npos || parts.size() == kMostParts) return parts;
        end = slash;
    }
}

bool is_window(const std::vector<std::string>& words) {
    constexpr std::string_view kOthers[] = {"frame",   "sill",  "car",      "vehicle",    "truck",      "van",
                                            "rahmen",  "ledge", "trim",     "windshield", "windscreen", "auto",
                                            "shutter", "blind", "shutters", "blinds",     "border",     "wiper",
                                            "bus",     "taxi",  "tram",     "train"};
    return has(words, "window,fenster") && !has_word(words, kOthers);
}

bool is_vehicle_lamp(const std::vector<std::string>& words) {
    constexpr std::string_view kSides[] = {"left", "right", "l", "r", "glass", "lens"};
    return has(words, "turnsignal,blinker") || (has(words, "tail,indicator") && has_word(words, kSides));
}

bool says_lit(const std::vector<std::string>& words) {
    constexpr std::string_view kLit[] = {"lit", "illuminated", "beleuchtet", "glowing"};
    return has_word(words, kLit);
}

bool is_signal_colour(std::span<const std::vector<std::string>> parts) {
    if (parts.empty() || colour_of(parts[0]) == 3) return false;
    return has(parts[0], kSignals) || (parts.size() > 1 && has(parts[1], kSignals));
}

const SourceKind& plain_lamp() { return kKinds[std::size(kKinds) - 1]; }

const SourceKind& kind_of(std::span<const std::vector<std::string>> parts) {
    constexpr const char* kSignalNames[] = {"red signal", "amber signal", "green signal", "amber signal"};
    for (const auto& words : parts) {
        const bool lit_window = is_window(words) && says_lit(words);
        for (const SourceKind& kind : kKinds) {
            if (kind.name == std::string_view("red signal") && has(words, kSignals))
                return named(kSignalNames[std::min(colour_of(words), colour_of(parts[0]))]);
            if (kind.name == std::string_view("window") && !is_window(words)) continue;
            if (has(words, kind.compounds)) return lit_window ? named("lit window") : kind;
        }
    }
    return plain_lamp();
}

}  // namespace vesper::scene
