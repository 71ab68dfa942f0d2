#include "scene/json_text.h"

#include <algorithm>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

constexpr size_t kMostDepth = 200, kMostKeys = 1'000'000;  // of an object

/// Follows a parser from value to value, of which it keeps the keys of those objects that it is in.
class JsonBounds {
public:
    JsonBounds(std::string file, uint64_t most_values) : file_(std::move(file)), most_values_(most_values) {}

    bool key(std::string& name) {
        Level& object = levels_.back();
        object.key = name;
        if (!object.keys.insert(std::move(name)).second) fail("is there twice");
        if (object.keys.size() > kMostKeys)
            fail("is beyond the " + std::to_string(kMostKeys) + " keys that an object may have");
        return true;
    }
    bool start_object(size_t) { return start(false); }
    bool start_array(size_t) { return start(true); }
    bool end_object() { return end(); }
    bool end_array() { return end(); }
    bool null() { return value(); }
    bool boolean(bool) { return value(); }
    bool number_integer(json::number_integer_t) { return value(); }
    bool number_unsigned(json::number_unsigned_t) { return value(); }
    bool number_float(json::number_float_t, const std::string&) { return value(); }
    bool string(std::string&) { return value(); }
    bool binary(json::binary_t&) { return value(); }
    bool parse_error(size_t, const std::string&, const json::exception&) { return false; }

private:
    // An object or an array that the parser is in.
    struct Level {
        bool array;
        size_t index;
        std::string key;
        std::set<std::string> keys;
    };

    bool start(bool array) {
        count();
        if (levels_.size() == kMostDepth)
            throw Error(file_ + ": JSON nested deeper than " + std::to_string(kMostDepth));
        levels_.push_back({array, 0, {}, {}});
        return true;
    }
    bool end() {
        levels_.pop_back();
        return step();
    }
    bool value() {
        count();
        return step();
    }
    void count() {
        if (++values_ > most_values_)
            throw Error(file_ + ": JSON of more than " + std::to_string(most_values_) + " values");
    }
    bool step() {
        if (!levels_.empty()) ++levels_.back().index;
        return true;
    }

    [[noreturn]] void fail(const std::string& reason) const {
        std::string pointer;
        for (const Level& level : levels_)
            pointer += "/" + (level.array ? std::to_string(level.index) : json_pointer_token(level.key));
        throw Error(file_ + ": " + one_line(pointer) + ": " + reason);
    }

    std::string file_;
    uint64_t most_values_, values_ = 0;
    std::vector<Level> levels_;
};

}  // namespace

std::string json_pointer_token(std::string_view key) {
    std::string token;
    for (const char c : key) token += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
    return token;
}

std::string json_pointer_key(std::string_view token) {
    std::string key;
    for (size_t i = 0; i < token.size(); ++i) {
        const char next = token[i] == '~' && i + 1 < token.size() ? token[i + 1] : ' ';
        if (next == '0' || next == '1') ++i;
        key += next == '0' ? '~' : next == '1' ? '/' : token[i];
    }
    return key;
}

void check_json_text(std::span<const uint8_t> text, const std::string& file, uint64_t most_values) {
    if (text.size() > 1 && ((text[0] == 0xff && text[1] == 0xfe) || (text[0] == 0xfe && text[1] == 0xff) ||
                            (text[0] == 0) != (text[1] == 0)))
        throw Error(file + ": is not valid JSON: it is no UTF-8, as it has to be, but looks like UTF-16");
    const auto nul = std::find(text.begin(), text.end(), uint8_t{0});
    if (std::any_of(nul, text.end(), [](uint8_t byte) { return byte != 0; }))
        throw Error(file + ": byte " + std::to_string(nul - text.begin() + 1) + ": not valid JSON: a NUL");
    JsonBounds bounds(file, most_values);
    json::sax_parse(text.begin(), text.end(), &bounds);
}

}  // namespace vesper::scene
