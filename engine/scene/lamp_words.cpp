// Names of nodes and materials that say lamp. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "base/lower.h"
#include "scene/apply_rules.h"

namespace vesper::scene {
namespace {

/// Words for a lamp or its light, in small letters and singular.
constexpr std::string_view kWords[]{"lamp",    "light",    "lantern",  "luminaire", "bulb",        "glow",  "neon",
                                    "led",     "emissive", "emission", "emitter",   "headl",       "taill", "lampe",
                                    "leuchte", "licht",    "laterne",  "strahler",  "scheinwerfer"};

/// Words that are written together with one of the above: "streetlight", "lamppost".
constexpr std::string_view kBefore[]{"street",  "road",  "head",    "tail",    "rear",  "front", "flood",    "spot",
                                     "brake",   "stop",  "fog",     "traffic", "side",  "park",  "turn",     "city",
                                     "wall",    "pole",  "ceiling", "desk",    "floor", "back",  "bulk",     "tunnel",
                                     "signal",  "flash", "search",  "gas",     "lime",  "night", "strassen", "straßen",
                                     "decken",  "wand",  "brems",   "blink",   "ampel", "nebel", "rück",     "rueck",
                                     "schluss", "stand", "fern",    "abblend", "hof"};
constexpr std::string_view kAfter[]{"post", "pole", "head", "bulb", "bar", "strip", "source", "box", "mast"};

bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
/// Bytes beyond ASCII are of letters, too.
bool is_letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

/// The words of a name, in small letters: between signs, digits and where capitals begin: "HDRStreetLight_03" is hdr,
/// street, light.
std::vector<std::string> words_of(const std::string& name) {
    std::vector<std::string> words;
    bool fresh = true;
    for (size_t i = 0; i < name.size(); ++i) {
        if (!is_letter(name[i])) {
            fresh = true;
            continue;
        }
        const bool after_small = i > 0 && is_lower(name[i - 1]);
        const bool before_small = i > 0 && is_upper(name[i - 1]) && i + 1 < name.size() && is_lower(name[i + 1]);
        if (fresh || (is_upper(name[i]) && (after_small || before_small))) words.emplace_back();
        words.back() += name[i];
        fresh = false;
    }
    for (std::string& word : words) word = lower(word);
    return words;
}

/// Without the ending of a plural, English or German.
bool is_word(std::string_view text) {
    for (const std::string_view plural : {"", "s", "n", "er"})
        if (text.ends_with(plural) &&
            std::ranges::find(kWords, text.substr(0, text.size() - plural.size())) != std::end(kWords))
            return true;
    return false;
}

bool says_lamp(std::string_view word) {
    if (is_word(word)) return true;
    for (const std::string_view before : kBefore)
        if (word.starts_with(before) && is_word(word.substr(before.size()))) return true;
    return std::ranges::any_of(kAfter, [&](std::string_view after) {
        for (const std::string_view plural : {"", "s"})
            if (const std::string ending = std::string(after) + std::string(plural);
                word.ends_with(ending) && is_word(word.substr(0, word.size() - ending.size())))
                return true;
        return false;
    });
}

}  // namespace

bool sounds_like_light(const std::string& name) { return std::ranges::any_of(words_of(name), says_lamp); }

}  // namespace vesper::scene
