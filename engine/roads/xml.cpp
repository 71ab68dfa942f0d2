// Reading XML with complaints that name file and line. SPDX-License-Identifier: MIT
#include "roads/xml.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/budget.h"
#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "photometry/table.h"

namespace vesper::roads {
namespace {

std::string_view local_part(std::string_view name) {
    const size_t colon = name.rfind(':');
    return colon == name.npos ? name : name.substr(colon + 1);
}

/// Which byte of a unit of UTF-16 comes first; neither: UTF-8.
struct Encoding {
    bool low_first, high_first;
    explicit Encoding(std::string_view text) {
        const auto begins = [&](const char(&with)[3]) { return text.starts_with(std::string_view(with, 2)); };
        low_first = begins("\xFF\xFE") || begins("<\0"), high_first = begins("\xFE\xFF") || begins("\0<");
    }
    bool is_utf8() const { return !low_first && !high_first; }
};

/// Where lines begin in the UTF-8 that the parser makes of a text, which may be UTF-16.
std::vector<uint32_t> line_starts_of(std::string_view text) {
    std::vector<uint32_t> starts{0};
    const Encoding encoding(text);
    if (encoding.is_utf8()) {
        for (size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') starts.push_back(static_cast<uint32_t>(i + 1));
        return starts;
    }
    uint32_t at = 0;
    for (size_t i = 0; i + 1 < text.size(); i += 2) {
        const auto byte = [&](size_t k) { return static_cast<uint32_t>(static_cast<unsigned char>(text[i + k])); };
        const uint32_t unit = encoding.low_first ? byte(0) | byte(1) << 8 : byte(1) | byte(0) << 8;
        at += unit < 0x80 ? 1 : unit < 0x800 || (unit & 0xF800) == 0xD800 ? 2 : 3;  // half of a pair: half of four
        if (unit == '\n') starts.push_back(at);
    }
    return starts;
}

/// The node after this one in the order of the file, below a root; not one inside of it, if so wished.
pugi::xml_node next_in(pugi::xml_node root, pugi::xml_node node, bool inside = true) {
    if (const pugi::xml_node child = node.first_child(); child && inside) return child;
    while (node != root && !node.next_sibling()) node = node.parent();
    return node == root ? pugi::xml_node() : node.next_sibling();
}

size_t question(std::string_view element, char sign, std::string_view name) {
    const std::hash<std::string_view> hash;
    return hash(element) * 31 + hash(name) * 7 + static_cast<size_t>(sign);
}

}  // namespace

XmlFile::XmlFile(std::string_view text, const std::string& name) : name_(one_line(name)) {
    line_starts_ = line_starts_of(text);
    const auto refuse = [&](ptrdiff_t offset, const std::string& reason) {
        throw Error(name_ + ":" + std::to_string(line_of(offset)) + ": is no XML: " + reason);
    };
    const pugi::xml_parse_result result =
        document_.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_fragment);
    if (!result) {
        std::string reason = result.description();
        if (!reason.empty()) reason = lower(reason.substr(0, 1)) + reason.substr(1);
        refuse(result.offset, reason);
    }
    // What the parser lets pass (XML 1.0, 2.1, 2.2 and 3.1). Of a fragment it keeps text beside the root.
    if (const size_t nul = text.find('\0'); Encoding(text).is_utf8() && nul != text.npos)
        refuse(static_cast<ptrdiff_t>(nul), "a NUL");
    const pugi::xml_node root = document_.document_element();
    if (!root) refuse(0, "no document element found");
    for (const pugi::xml_node node : document_.children()) {
        if (node.type() == pugi::node_element && node != root) refuse(node.offset_debug(), "a second root");
        if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata)
            refuse(node.offset_debug(), "text beside the root");
    }
    std::vector<std::string_view> names;
    for (pugi::xml_node node = root; node; node = next_in(root, node)) {
        names.clear();
        for (const pugi::xml_attribute attribute : node.attributes()) names.emplace_back(attribute.name());
        std::sort(names.begin(), names.end());
        if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
            refuse(node.offset_debug(), "the attribute " + photometry::quoted(std::string(*twice)) + " is there twice");
    }
}

XmlElement XmlFile::root() const { return {*this, document_.document_element()}; }

size_t XmlFile::line_of(ptrdiff_t offset) const {
    const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(),
                                        static_cast<uint32_t>(std::max<ptrdiff_t>(offset, 0)));
    return static_cast<size_t>(after - line_starts_.begin());
}

std::map<std::string, size_t> XmlFile::unread() const {
    constexpr size_t kMost = 1000;
    std::map<std::string, size_t> found;
    const auto is_read = [&](std::string_view element, char sign, std::string_view name) {
        if (asked_.contains(question(element, sign, name)) || asked_.contains(question(element, sign, {}))) return true;
        const std::string text = std::string(element) + sign + std::string(name);
        if (found.size() < kMost || found.contains(text)) ++found[text];
        return false;
    };
    const pugi::xml_node root = document_.document_element();
    bool inside = true;
    for (pugi::xml_node node = root; node; node = next_in(root, node, inside)) {
        check_time();
        const std::string_view name = local_part(node.name());
        inside =
            node.type() == pugi::node_element && (node == root || is_read(local_part(node.parent().name()), '/', name));
        if (!inside) continue;
        for (const pugi::xml_attribute attribute : node.attributes())
            if (!std::string_view(attribute.name()).starts_with("xmlns"))
                is_read(name, '@', local_part(attribute.name()));
    }
    return found;
}

std::string_view XmlElement::name() const { return local_part(node_.name()); }

size_t XmlElement::line() const { return file_->line_of(node_.offset_debug()); }

void XmlElement::ask(char sign, std::string_view name) const {
    file_->asked_.insert(question(this->name(), sign, name));
}

std::vector<XmlElement> XmlElement::children(std::string_view name) const {
    ask('/', name);
    std::vector<XmlElement> found;
    for (const pugi::xml_node child : node_.children())
        if (child.type() == pugi::node_element && (name.empty() || local_part(child.name()) == name))
            found.emplace_back(*file_, child);
    return found;
}

std::optional<XmlElement> XmlElement::child(std::string_view name) const {
    ask('/', name);
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
    const auto found = given(name);
    return found && !found->empty() ? found : std::nullopt;
}

std::optional<std::string_view> XmlElement::given(std::string_view name) const {
    ask('@', name);
    for (const pugi::xml_attribute attribute : node_.attributes())
        if (local_part(attribute.name()) == name) return photometry::trimmed(attribute.value());
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
    const auto found = given(name);
    if (!found) fail(std::string(name) + " is missing");
    const std::string whole(*found);
    const auto value = photometry::number_of(whole, false);
    if (!value) fail(std::string(name) + " " + photometry::quoted(whole) + " is no number");
    if (*value < low || *value > high) fail(std::string(name) + " " + photometry::quoted(whole) + " is out of range");
    return *value;
}

double XmlElement::number_or(std::string_view name, double fallback, double low, double high) const {
    return given(name) ? number(name, low, high) : fallback;
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

}  // namespace vesper::roads
