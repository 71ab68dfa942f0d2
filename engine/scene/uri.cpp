// URIs as glTF uses them: relative paths and data (RFC 2397, RFC 4648). SPDX-License-Identifier: MIT
#include "scene/uri.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "io/named_file.h"

namespace vesper::scene {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

int hex_value(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percent_decoded(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        const int high = text[i] == '%' && i + 2 < text.size() ? hex_value(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_value(text[i + 2]) : -1;
        if (low >= 0) {
            result += static_cast<char>(high * 16 + low);
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

std::vector<uint8_t> base64_decoded(std::string_view text) {
    std::array<int8_t, 256> value;
    value.fill(-1);
    for (size_t i = 0; i < kDigits.size(); ++i) value[static_cast<uint8_t>(kDigits[i])] = static_cast<int8_t>(i);
    value['-'] = 62, value['_'] = 63;
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    for (const char c : text)
        if (value[static_cast<uint8_t>(c)] < 0)
            throw Error("base64 data contains " + std::string(c == '\n' || c == '\r' ? "a line break"
                                                              : c == ' '             ? "a space"
                                                                         : "a character that is none of its digits"));
    if (text.size() % 4 == 1) throw Error("base64 data is cut off");
    std::vector<uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        bits = bits << 6 | static_cast<uint32_t>(value[static_cast<uint8_t>(c)]);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<uint8_t>(bits >> count));
        }
    }
    return bytes;
}

/// "https:", "file:", but not "c d.png".
bool has_scheme(const std::string& uri) {
    const size_t colon = uri.find(':');
    if (colon == std::string::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0]))) return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

}  // namespace

bool is_data_uri(std::string_view uri) { return lower(uri.substr(0, 5)) == "data:"; }

std::vector<uint8_t> decode_data_uri(std::string_view uri) {
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos) throw Error("data URI without a comma");
    const std::string_view head = uri.substr(0, comma), body = uri.substr(comma + 1);
    if (constexpr std::string_view kMark = ";base64";
        head.size() >= kMark.size() && lower(head.substr(head.size() - kMark.size())) == kMark)
        return body.find('%') == std::string_view::npos ? base64_decoded(body) : base64_decoded(percent_decoded(body));
    const std::string bytes = percent_decoded(body);
    return {bytes.begin(), bytes.end()};
}

std::string encode_data_uri(std::string_view media_type, std::span<const uint8_t> bytes) {
    std::string uri = "data:" + std::string(media_type) + ";base64,";
    uri.reserve(uri.size() + (bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = std::min<size_t>(3, bytes.size() - i);
        uint32_t bits = static_cast<uint32_t>(bytes[i]) << 16;
        if (left > 1) bits |= static_cast<uint32_t>(bytes[i + 1]) << 8;
        if (left > 2) bits |= bytes[i + 2];
        uri += kDigits[bits >> 18];
        uri += kDigits[bits >> 12 & 63];
        uri += left > 1 ? kDigits[bits >> 6 & 63] : '=';
        uri += left > 2 ? kDigits[bits & 63] : '=';
    }
    return uri;
}

std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri) {
    const std::string decoded = percent_decoded(uri);
    if (uri.empty()) throw Error("empty URI");
    if (decoded.find('\0') != std::string::npos) throw Error("URI contains a zero byte");
    if (has_scheme(uri))
        throw Error("URI '" + one_line(uri, 80) + "' is not a relative path: only files beside this one are read");
    for (const std::string& path : {uri, decoded})
        if (path[0] == '/' || path[0] == '\\')
            throw Error("URI '" + one_line(uri) + "' is an absolute path: only files beside this one are read");
    std::error_code ignored;
    // Exporters that forget to encode write "50%20off.png" for a file of that very name.
    return io::named_file(folder, uri != decoded && std::filesystem::exists(folder / uri, ignored) ? uri : decoded);
}

}  // namespace vesper::scene
