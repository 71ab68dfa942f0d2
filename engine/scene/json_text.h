// What a parser of JSON lets pass and a reader must not. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vesper {

/// Throws Error if a NUL stands in the text with anything but more of them behind: parsers take it for the end.
void refuse_text_behind_nul(std::span<const uint8_t> text, const std::string& file);

/// A JSON pointer's token for a key.
std::string json_pointer_token(std::string_view key);

/// Follows a parser (nlohmann::json::parser_callback_t) and throws Error, with file and JSON pointer, where an object has a key twice:
/// of which one would count is for no reader to say (RFC 8259, 4).
class UniqueKeys {
public:
    explicit UniqueKeys(std::string file) : file_(std::move(file)) {}
    void see(nlohmann::json::parse_event_t, const nlohmann::json& value);

private:
    // An object or an array that the parser is in.
    struct Level {
        bool array = false;
        size_t index = 0;
        std::string key;
        std::set<std::string> keys;
    };

    std::string file_;
    std::vector<Level> levels_;
};

}  // namespace vesper
