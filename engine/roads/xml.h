// XML with errors that name file and line. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include <pugixml.hpp>

namespace vesper::roads {

constexpr double kMaxNumber = 1e9;  ///< of any attribute, either sign, unless said otherwise

class XmlFile;

/// An element of an XML file. Name prefixes (odr:road) are ignored. Every access checks its value and throws Error with
/// file, line and reason.
class XmlElement {
public:
    XmlElement(const XmlFile& file, pugi::xml_node node) : file_(&file), node_(node) {}

    std::string_view name() const;
    size_t line() const;

    /// Children of this name, or all of them, in the order of the file.
    std::vector<XmlElement> children(std::string_view name = {}) const;
    std::optional<XmlElement> child(std::string_view name) const;
    /// The children of all children of a name: children_of("objects", "object").
    std::vector<XmlElement> children_of(std::string_view holder, std::string_view name) const;

    /// Trimmed text of an attribute; empty optional if missing or empty.
    std::optional<std::string_view> attribute(std::string_view name) const;
    std::string text(std::string_view name) const;
    std::string text_or(std::string_view name, const std::string& fallback) const;
    /// Finite numbers. An empty one is none.
    double number(std::string_view name, double low = -kMaxNumber, double high = kMaxNumber) const;
    double number_or(std::string_view name, double fallback, double low = -kMaxNumber, double high = kMaxNumber) const;
    int integer(std::string_view name, int low, int high) const;
    bool flag(std::string_view name) const;  ///< "true", "1", "yes"

    /// "file:line: element: ", as messages begin.
    std::string place() const;
    [[noreturn]] void fail(const std::string& reason) const;

private:
    /// As attribute, but empty where it is.
    std::optional<std::string_view> given(std::string_view name) const;
    /// Remembers that elements of this name are read for a child ('/') or an attribute ('@') of a name.
    void ask(char sign, std::string_view name) const;

    const XmlFile* file_;
    pugi::xml_node node_;
};

/// An XML file in memory.
class XmlFile {
public:
    /// Parses; throws Error. Entities other than XML's own are not expanded.
    XmlFile(std::string_view text, const std::string& name);
    XmlFile(const XmlFile&) = delete;

    const std::string& name() const { return name_; }
    XmlElement root() const;
    /// The line of an offset into the file, from 1.
    size_t line_of(ptrdiff_t offset) const;

    /// Names that no reader has asked for, and how often they are there: "lane/access" and "lane@level". Elements that
    /// were not asked for count without their contents. The first 1,000.
    std::map<std::string, size_t> unread() const;

private:
    friend class XmlElement;
    std::string name_;
    pugi::xml_document document_;
    std::vector<uint32_t> line_starts_;
    mutable std::unordered_set<size_t> asked_;  ///< hashes of names of elements and of what they were asked for
};

}  // namespace vesper::roads
