// Words of names. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vesper {

/// Runs of letters in lower(): "LEDStreetLamp_03" is led, street, lamp. A word also ends before a capital after a small
/// letter, and before the last of several capitals if a small letter follows; the s of "LEDs" is no word. Bytes beyond
/// ASCII are letters.
std::vector<std::string> words_of(std::string_view name);

}  // namespace vesper
