// Writing IES LM-63-2019 files. SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/one_line.h"
#include "photometry/ies.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

constexpr size_t kLineWidth = 120;  // the standard allows 256

/// The shortest decimal that comes back as it was; without an exponent where that is not long.
template <class Number>
std::string text_of(Number value) {
    char digits[64];
    const bool plain = value == 0 || (std::abs(value) >= Number(1e-4) && std::abs(value) < Number(1e15));
    const auto form = plain ? std::chars_format::fixed : std::chars_format::scientific;
    return {digits, std::to_chars(digits, digits + sizeof digits, value, form).ptr};
}

template <class Number>
void append(std::string& file, const std::vector<Number>& values) {
    size_t width = 0;
    for (const Number value : values) {
        const std::string text = text_of(value);
        if (width > 0 && width + text.size() + 1 > kLineWidth) {
            file += "\r\n";
            width = 0;
        }
        if (width > 0) file += ' ';
        file += text;
        width += text.size() + 1;
    }
    file += "\r\n";
}

void append_keyword(std::string& file, std::string key, const std::string& text) {
    size_t at = 0;
    while (true) {
        const size_t end = std::min(text.find('\n', at), text.size());
        file += "[" + key + "] " + text.substr(at, end - at) + "\r\n";
        if (end == text.size()) return;
        at = end + 1;
        key = "MORE";
    }
}

bool is_keyword(const std::string& key) {
    return !key.empty() && key.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == key.npos;
}

}  // namespace

std::string write_ies(const Distribution& d) {
    std::string file = "IES:LM-63-2019\r\n";
    const auto has = [&](const char* key) {
        for (const auto& [name, text] : d.metadata)
            if (name == key) return true;
        return false;
    };
    for (const char* key : {"TEST", "TESTLAB", "ISSUEDATE", "MANUFAC"})  // the standard demands them
        if (!has(key)) append_keyword(file, key, "unknown");
    if (!has("LUMINAIRE") && !d.name.empty()) append_keyword(file, "LUMINAIRE", d.name);
    for (const auto& [key, text] : d.metadata)
        if (is_keyword(key)) append_keyword(file, key, text);
    file += "TILT=NONE\r\n";

    std::vector<double> horizontal = d.horizontal, candela = d.candela;
    // H from 0 would stand for both sides: a dark plane just left of it says that this is the whole range.
    if (d.goniometry != Goniometry::CGamma && std::abs(horizontal.front()) < 1e-6) {
        horizontal.insert(horizontal.begin(), -1e-3);
        candela.insert(candela.begin(), d.vertical.size(), 0.0);
    }
    // V from 0, too: a dark row just below it.
    std::vector<double> vertical = d.vertical;
    if (d.goniometry != Goniometry::CGamma && std::abs(vertical.front()) < 1e-6) {
        const size_t count = vertical.size();
        std::vector<double> with_row;
        for (size_t h = 0; h < horizontal.size(); ++h) {
            with_row.push_back(0);
            with_row.insert(with_row.end(), candela.begin() + ptrdiff_t(h * count),
                            candela.begin() + ptrdiff_t((h + 1) * count));
        }
        vertical.insert(vertical.begin(), -1e-3);
        candela = std::move(with_row);
    }
    if (std::max(horizontal.size(), vertical.size()) > kMaxAngles)
        throw Error(one_line(d.name) + ": its light has " +
                    std::to_string(std::max(horizontal.size(), vertical.size())) +
                    " angles in a list, and an IES file is read with " + std::to_string(kMaxAngles) + " at most");
    const int type = d.goniometry == Goniometry::CGamma ? 1 : d.goniometry == Goniometry::TypeB ? 2 : 3;
    const double sign = d.opening.round ? -1 : 1;
    append<double>(file, {1, d.lamp_flux > 0 ? d.lamp_flux : -1, 1, static_cast<double>(vertical.size()),
                          static_cast<double>(horizontal.size()), static_cast<double>(type), 2, sign * d.opening.width,
                          sign * d.opening.length, d.opening.height});
    append<double>(file, {1, 1.00001, 0});  // ballast factor, how the file was generated (not stated), watts
    append(file, vertical);
    append(file, horizontal);
    const auto planes = static_cast<ptrdiff_t>(vertical.size());
    for (auto plane = candela.begin(); plane != candela.end(); plane += planes)
        append(file, std::vector<float>(plane, plane + planes));
    return file;
}

}  // namespace vesper::photometry
