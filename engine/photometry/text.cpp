// Text files of distributions: lines, numbers, names. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

/// Length of the UTF-8 character a text begins with; 0 when it begins with none.
size_t utf8_length(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    const size_t length = byte(0) < 0x80 ? 1 : byte(0) < 0xc2 ? 0 : byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : 4;
    if (length == 0 || byte(0) > 0xf4 || length > text.size()) return 0;
    for (size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    return length;
}

void append_utf8(std::string& text, uint32_t code) {
    const auto add = [&](uint32_t byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
        add(code);
    } else if (code < 0x800) {
        add(0xc0 | code >> 6), add(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        add(0xe0 | code >> 12), add(0x80 | (code >> 6 & 0x3f)), add(0x80 | (code & 0x3f));
    } else {
        add(0xf0 | code >> 18), add(0x80 | (code >> 12 & 0x3f)), add(0x80 | (code >> 6 & 0x3f));
        add(0x80 | (code & 0x3f));
    }
}

/// UTF-16 behind its byte order mark as UTF-8, of at most 1.5 times the size; half a pair becomes U+FFFD, an odd byte
/// at the end nothing.
std::string utf8_of(std::span<const uint8_t> bytes, bool big_endian) {
    constexpr uint32_t kNone = 0xfffd;
    const auto unit = [&](size_t i) -> uint32_t { return bytes[i + !big_endian] << 8 | bytes[i + big_endian]; };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (size_t i = 0; i + 1 < bytes.size(); i += 2) {
        uint32_t code = unit(i);
        if (code >= 0xd800 && code < 0xe000) {
            const uint32_t low = code < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
            const bool pair = low >= 0xdc00 && low < 0xe000;
            code = pair ? 0x10000 + ((code - 0xd800) << 10 | (low - 0xdc00)) : kNone;
            if (pair) i += 2;
        }
        append_utf8(text, code);
    }
    return text;
}

/// Whether a number beyond what a double can be is too small for it, not too large.
bool vanishes(std::string_view number) {
    const size_t e = std::min(number.find_first_of("eE"), number.size());
    const std::string_view digits = number.substr(0, e);
    std::string_view exponent = number.substr(std::min(e + 1, number.size()));
    if (exponent.starts_with('+')) exponent.remove_prefix(1);
    double order = 0;
    std::from_chars(exponent.data(), exponent.data() + exponent.size(), order);
    const auto place = [&](const char* of) {
        return static_cast<double>(std::min(digits.find_first_of(of), digits.size()));
    };
    return order + place(".") - place("123456789") < 0;
}

}  // namespace

LineReader::LineReader(std::span<const uint8_t> bytes, std::string name)
    : name_(std::move(name)), text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {
    const bool big_endian = text_.starts_with("\xfe\xff");
    if (text_.starts_with("\xef\xbb\xbf")) {
        text_.remove_prefix(3);
    } else if (big_endian || text_.starts_with("\xff\xfe")) {
        converted_ = std::make_shared<const std::string>(utf8_of(bytes.subspan(2), big_endian));
        text_ = *converted_;
    }
}

std::optional<std::string_view> LineReader::next() {
    ++line_;
    if (at_ >= text_.size()) return std::nullopt;
    const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end + (text_.substr(end).starts_with("\r\n") ? 2 : end < text_.size() ? 1 : 0);
    return line;
}

void LineReader::fail_at(size_t line, const std::string& reason) const {
    throw Error(one_line(name_ + ": line " + std::to_string(line) + ": " + reason, 600));
}

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0' || c == '\x1a'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string readable(std::string_view text) {
    text = trimmed(text).substr(0, 1000);
    std::string made;
    while (!text.empty()) {
        const auto byte = static_cast<unsigned char>(text.front());
        size_t length = utf8_length(text);
        if (byte < 0x20 || byte == 0x7f) {
            made += ' ';
        } else if (length > 0) {
            made += text.substr(0, length);
        } else {
            made += static_cast<char>(0xc0 | byte >> 6);
            made += static_cast<char>(0x80 | (byte & 0x3f));
        }
        text.remove_prefix(std::max<size_t>(length, 1));
    }
    return made;
}

std::string quoted(std::string_view text) { return "'" + one_line(readable(text.substr(0, 40)), 40) + "'"; }

std::vector<std::string> words_of(std::string_view heading) {
    std::vector<std::string> words;
    bool within = false;
    for (const char c : lower(readable(heading))) {
        const auto byte = static_cast<unsigned char>(c);
        const bool letter =
            std::isalnum(byte) || (byte >= 0x80 && byte != 0xc2 && byte != 0xb0);  // these two are a degree sign
        if (letter && !within) words.emplace_back();
        if (letter) words.back() += c;
        within = letter;
    }
    return words;
}

bool names_tan_gamma(std::string_view cell) {
    for (const std::string& word : words_of(cell))
        if (word.starts_with("tan") || word.starts_with("tg")) return true;
    return false;
}

std::optional<double> number_of(std::string_view text, bool comma) {
    text = trimmed(text);
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    if (text.starts_with('+')) text.remove_prefix(1);
    std::string pointed;
    if (comma && text.find(',') != text.npos) {
        pointed = text;
        std::replace(pointed.begin(), pointed.end(), ',', '.');
        text = pointed;
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range && vanishes(text)) return 0;
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator, size_t most) {
    std::vector<std::string_view> fields;
    while (fields.size() <= most) {
        const size_t end = line.find(separator);
        fields.push_back(trimmed(line.substr(0, end)));
        if (end == line.npos) break;
        line.remove_prefix(end + 1);
    }
    return fields;
}

}  // namespace vesper::photometry
