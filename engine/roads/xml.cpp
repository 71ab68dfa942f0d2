// Reading XML with complaints that name file and line. SPDX-License-Identifier: MIT
#include "roads/xml.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/atomic_file.h"
#include "photometry/table.h"

namespace vesper {
namespace {

std::string_view local_part(std::string_view name) {
    const size_t colon = name.rfind(':');
    return colon == name.npos ? name : name.substr(colon + 1);
}

/// Where lines begin in the UTF-8 that the parser makes of a text, which may be UTF-16.
std::vector<uint32_t> line_starts_of(std::string_view text) {
    std::vector<uint32_t> starts{0};
    const auto begins = [&](const char (&with)[3]) { return text.starts_with(std::string_view(with, 2)); };
    const bool low_first = begins("\xFF\xFE") || begins("<\0"), high_first = begins("\xFE\xFF") || begins("\0<");
    if (!low_first && !high_first) {
        for (size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') starts.push_back(static_cast<uint32_t>(i + 1));
        return starts;
    }
    uint32_t at = 0;
    for (size_t i = 0; i + 1 < text.size(); i += 2) {
        const auto byte = [&](size_t k) { return static_cast<uint32_t>(static_cast<unsigned char>(text[i + k])); };
        const uint32_t unit = low_first ? byte(0) | byte(1) << 8 : byte(1) | byte(0) << 8;
        at += unit < 0x80 ? 1 : unit < 0x800 || (unit & 0xF800) == 0xD800 ? 2 : 3;  // half of a pair: half of four
        if (unit == '\n') starts.push_back(at);
    }
    return starts;
}

}  // namespace

XmlFile::XmlFile(std::string_view text, const std::string& name) : name_(one_line(name)) {
    line_starts_ = line_starts_of(text);
    const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
    if (!result) {
        std::string reason = result.description();
        if (!reason.empty()) reason[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(reason[0])));
        throw Error(name_ + ":" + std::to_string(line_of(result.offset)) + ": is no XML: " + reason);
    }
}

XmlElement XmlFile::root() const { return {*this, document_.document_element()}; }

size_t XmlFile::line_of(ptrdiff_t offset) const {
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(),
                                        static_cast<uint32_t>(std::max<ptrdiff_t>(offset, 0)));
    return static_cast<size_t>(after - line_starts_.begin());
}

std::string_view XmlElement::name() const { return local_part(node_.name()); }

size_t XmlElement::line() const { return file_->line_of(node_.offset_debug()); }

std::vector<XmlElement> XmlElement::children(std::string_view name) const {
    std::vector<XmlElement> found;
    for (const pugi::xml_node child : node_.children())
        if (child.type() == pugi::node_element && (name.empty() || local_part(child.name()) == name))
            found.emplace_back(*file_, child);
    return found;
}

std::optional<XmlElement> XmlElement::child(std::string_view name) const {
    for (const pugi::xml_node child : node_.children())
        if (child.type() == pugi::node_element && local_part(child.name()) == name) return XmlElement(*file_, child);
    return std::nullopt;
}

std::vector<XmlElement> XmlElement::children_of(std::string_view holder, std::string_view name) const {
    std::vector<XmlElement> found;
    for (const XmlElement& each : children(holder))
        for (const XmlElement& child : each.children(name)) found.push_back(child);
    return found;
}

std::optional<std::string_view> XmlElement::attribute(std::string_view name) const {
    for (const pugi::xml_attribute attribute : node_.attributes())
        if (local_part(attribute.name()) == name) {
            const std::string_view text = trimmed(attribute.value());
            return text.empty() ? std::nullopt : std::optional(text);
        }
    return std::nullopt;
}

std::string XmlElement::text(std::string_view name) const {
    const auto found = attribute(name);
    if (!found) fail(std::string(name) + " is missing");
    return std::string(*found);
}

std::string XmlElement::text_or(std::string_view name, const std::string& fallback) const {
    const auto found = attribute(name);
    return found ? std::string(*found) : fallback;
}

double XmlElement::number(std::string_view name, double low, double high) const {
    const std::string whole = text(name);
    const auto value = number_of(whole, false);
    if (!value) fail(std::string(name) + " " + vesper::quoted(whole) + " is no number");
    if (*value < low || *value > high) fail(std::string(name) + " " + vesper::quoted(whole) + " is out of range");
    return *value;
}

double XmlElement::number_or(std::string_view name, double fallback, double low, double high) const {
    return attribute(name) ? number(name, low, high) : fallback;
}

int XmlElement::integer(std::string_view name, int low, int high) const {
    const double value = number(name, low, high);
    if (value != std::floor(value)) fail(std::string(name) + " must be a whole number");
    return static_cast<int>(value);
}

bool XmlElement::flag(std::string_view name) const {
    const std::string value = text_or(name, "");
    return value == "true" || value == "1" || value == "yes";
}

std::string XmlElement::place() const {
    return file_->name() + ":" + std::to_string(line()) + ": " + one_line(std::string(name()), 60);
}

void XmlElement::fail(const std::string& reason) const { throw Error(place() + ": " + reason); }

}  // namespace vesper
