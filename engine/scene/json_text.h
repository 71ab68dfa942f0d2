// What a parser of JSON lets pass and a reader must not; before the parser takes memory for it. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vesper::scene {

/// A JSON pointer's token for a key.
std::string json_pointer_token(std::string_view key);
/// The key of such a token.
std::string json_pointer_key(std::string_view token);

/// Throws Error, with file and place, if a NUL stands in the text with anything but more of them behind, which parsers
/// take for the end, or an object has a key twice: which one counts is for no reader to say (RFC 8259, 4). So it does
/// where there are more values than `most_values`, they are nested deeper than 200, or an object has more than a
/// million keys, and for UTF-16. Other mistakes are the parser's.
void check_json_text(std::span<const uint8_t> text, const std::string& file, uint64_t most_values);

}  // namespace vesper::scene
