// Names of nodes and materials that say lamp. SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/words.h"
#include "scene/apply_rules.h"

namespace vesper::scene {
namespace {

/// Words for a lamp or its light, in small letters and singular.
constexpr std::string_view kLampWords[]{"lamp",    "light",    "lantern",  "luminaire", "bulb",        "glow",  "neon",
                                        "led",     "emissive", "emission", "emitter",   "headl",       "taill", "lampe",
                                        "leuchte", "licht",    "laterne",  "strahler",  "scheinwerfer"};

/// Words that are written together with one of the above: "streetlight", "lamppost".
constexpr std::string_view kBefore[]{"street",  "road",  "head",    "tail",    "rear",  "front", "flood",    "spot",
                                     "brake",   "stop",  "fog",     "traffic", "side",  "park",  "turn",     "city",
                                     "wall",    "pole",  "ceiling", "desk",    "floor", "back",  "bulk",     "tunnel",
                                     "signal",  "flash", "search",  "gas",     "lime",  "night", "strassen", "straßen",
                                     "decken",  "wand",  "brems",   "blink",   "ampel", "nebel", "rück",     "rueck",
                                     "schluss", "stand", "fern",    "abblend", "hof",   "lamp",  "led"};
constexpr std::string_view kAfter[]{"post", "pole", "head", "bulb", "bar", "strip", "source", "box", "mast"};

/// Without the ending of a plural, English or German.
bool is_word(std::string_view text) {
    for (const std::string_view plural : {"", "s", "n", "er"})
        if (text.ends_with(plural) &&
            std::ranges::find(kLampWords, text.substr(0, text.size() - plural.size())) != std::end(kLampWords))
            return true;
    return false;
}

bool is_word_or_compound(std::string_view word) {
    return is_word(word) || std::ranges::any_of(kBefore, [&](std::string_view before) {
               return word.starts_with(before) && is_word(word.substr(before.size()));
           });
}

bool says_lamp(std::string_view word) {
    if (is_word_or_compound(word)) return true;
    for (const std::string_view after : kAfter)
        for (const std::string_view plural : {"", "s"})
            if (const std::string ending = std::string(after) + std::string(plural);
                word.ends_with(ending) && is_word_or_compound(word.substr(0, word.size() - ending.size())))
                return true;
    return false;
}

}  // namespace

bool sounds_like_light(const std::string& name) {
    const std::vector<std::string> words = words_of(name);
    for (size_t i = 0; i < words.size(); ++i)
        // "LEDlight" is split into le and dlight.
        if (says_lamp(words[i]) || (i > 0 && says_lamp(words[i - 1] + words[i]))) return true;
    return false;
}

}  // namespace vesper::scene
