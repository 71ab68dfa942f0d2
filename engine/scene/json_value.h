// Reading JSON with complaints that name file and place. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cfloat>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vesper::scene {

/// A JSON text in memory, or a part of one, and the name of the file it came from.
struct JsonFile {
    std::string name;
    nlohmann::json root;
    std::string pointer;  ///< JSON pointer of the root in its file; of a whole file empty

    JsonFile() = default;
    JsonFile(std::string name_of_file, nlohmann::json value, std::string pointer_of_root = {})
        : name(std::move(name_of_file)), root(std::move(value)), pointer(std::move(pointer_of_root)) {}
    JsonFile(JsonFile&&) = default;
    JsonFile& operator=(JsonFile&&) = default;
    ~JsonFile();
};

/// Parses JSON of bounded depth and size, so that nothing that walks it can run out of stack or memory. Throws Error.
JsonFile parse_json(std::span<const uint8_t> text, const std::string& name);

/// One value of a JSON file. Every access checks type and range and throws Error with file, JSON pointer and reason.
class JsonValue {
public:
    explicit JsonValue(const JsonFile& file) : JsonValue(file, file.root) {}
    JsonValue(const JsonFile& file, const nlohmann::json& value) : file_(&file), value_(&value) {}

    const nlohmann::json& json() const { return *value_; }

    /// Object members: the first must exist, the second may.
    JsonValue at(const char* key) const;
    std::optional<JsonValue> find(const char* key) const;
    /// Refuses members other than these.
    void allow_only(std::initializer_list<const char*> keys) const { allow_only(std::span(keys.begin(), keys.size())); }
    void allow_only(std::span<const char* const> keys) const;

    /// Values of all members of this object.
    std::vector<JsonValue> members() const;

    /// Array elements; `count` elements exactly where that is not 0.
    std::vector<JsonValue> elements(size_t count = 0) const;
    /// The element of this array that an index names.
    JsonValue element_at(const JsonValue& index, const char* of) const;
    /// Elements of an array that may be missing.
    std::vector<JsonValue> elements_of(const char* key) const;

    /// Numbers, finite also as float.
    double number(double low = -FLT_MAX, double high = FLT_MAX) const;
    double number_or(const char* key, double fallback, double low = -FLT_MAX, double high = FLT_MAX) const;
    template <size_t N, class Number = float>
    std::array<Number, N> numbers(double low = -FLT_MAX, double high = FLT_MAX) const {
        std::array<Number, N> values{};
        size_t i = 0;
        for (const JsonValue& element : elements(N)) values[i++] = static_cast<Number>(element.number(low, high));
        return values;
    }
    /// A whole number in [0, high]; also written as 3.0.
    uint64_t integer(uint64_t high = UINT64_MAX) const;
    uint64_t integer_or(const char* key, uint64_t fallback, uint64_t high = UINT64_MAX) const;
    /// An index into something that has `size` elements.
    uint32_t index(size_t size, const char* of) const;

    bool boolean() const;
    bool boolean_or(const char* key, bool fallback) const;
    const std::string& text() const;
    std::string text_or(const char* key, const std::string& fallback) const;

    /// File and JSON pointer, as messages begin.
    std::string place() const;
    [[noreturn]] void fail(const std::string& reason) const;

private:
    const JsonFile* file_;
    const nlohmann::json* value_;
};

}  // namespace vesper::scene
