#include "scene/json_text.h"

#include <algorithm>

#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {

void refuse_text_behind_nul(std::span<const uint8_t> text, const std::string& file) {
    const auto nul = std::find(text.begin(), text.end(), uint8_t{0});
    if (std::any_of(nul, text.end(), [](uint8_t byte) { return byte != 0; }))
        throw Error(file + ": byte " + std::to_string(nul - text.begin() + 1) + ": not valid JSON: a NUL");
}

std::string json_pointer_token(std::string_view key) {
    std::string token;
    for (const char c : key) token += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
    return token;
}

void UniqueKeys::see(nlohmann::json::parse_event_t event, const nlohmann::json& value) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
        levels_.push_back({.array = event == Event::array_start, .key = {}, .keys = {}});
    } else if (event == Event::key) {
        Level& object = levels_.back();
        object.key = value.get<std::string>();
        if (object.keys.insert(object.key).second) return;
        std::string pointer;
        for (const Level& level : levels_) pointer += "/" + (level.array ? std::to_string(level.index) : json_pointer_token(level.key));
        throw Error(file_ + ": " + one_line(pointer) + ": is there twice");
    } else {
        if (event != Event::value) levels_.pop_back();
        if (!levels_.empty() && levels_.back().array) ++levels_.back().index;
    }
}

}  // namespace vesper
