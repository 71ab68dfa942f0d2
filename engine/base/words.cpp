// Words of names. SPDX-License-Identifier: MIT
#include "base/words.h"

#include <utility>

#include "base/lower.h"

namespace vesper {
namespace {

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_letter(char c) { return is_capital(c) || is_small(c) || static_cast<unsigned char>(c) >= 0x80; }

/// Whether a small letter that is more than the ending of a plural is at `i`.
bool goes_on(std::string_view name, size_t i) {
    if (i >= name.size() || !is_small(name[i])) return false;
    return name[i] != 's' || (i + 1 < name.size() && is_small(name[i + 1]));
}

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
    std::vector<std::string> words;
    bool in_word = false;
    for (size_t i = 0; i < name.size(); ++i) {
        const bool was_in_word = std::exchange(in_word, is_letter(name[i]));
        if (!in_word) continue;
        if (!was_in_word || (is_capital(name[i]) && (!is_capital(name[i - 1]) || goes_on(name, i + 1))))
            words.emplace_back();
        words.back() += name[i];
    }
    for (std::string& word : words) word = lower(word);
    return words;
}

}  // namespace vesper
