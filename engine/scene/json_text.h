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

/// Throws Error, with file and place, for a NUL inside the text, a repeated key (RFC 8259, 4), UTF-16, more than
/// `most_values` values, nesting over 200, or an object with over a million keys. Other mistakes are the parser's.
void check_json_text(std::span<const uint8_t> text, const std::string& file, uint64_t most_values);

}  // namespace vesper::scene
