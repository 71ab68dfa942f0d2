// Reading JSON with complaints that name file and place. A value knows only its own address: its JSON pointer is
// searched for when something is wrong with it, so that the way there costs nothing. SPDX-License-Identifier: MIT
#include "scene/json_value.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/decimal.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/one_line.h"
#include "scene/json_text.h"

namespace vesper::scene {
namespace {

constexpr uint64_t kMostValues = 32'000'000;  // a million nodes have about half of this

/// The JSON pointer from `here` to the value at an address; depth is bounded by parse_json.
std::optional<std::string> pointer_to(const nlohmann::json& here, const nlohmann::json* wanted) {
    if (&here == wanted) return "";
    if (here.is_object()) {
        for (const auto& [key, member] : here.items())
            if (auto rest = pointer_to(member, wanted)) return "/" + json_pointer_token(key) + *rest;
    } else if (here.is_array()) {
        for (size_t i = 0; i < here.size(); ++i)
            if (auto rest = pointer_to(here[i], wanted)) return "/" + std::to_string(i) + *rest;
    }
    return std::nullopt;
}

// nlohmann::json takes memory to go, and ends the program where there is none: so it goes empty. Depth is bounded by
// parse_json.
void empty(nlohmann::json& value) noexcept {
    if (!value.is_structured()) return;
    for (nlohmann::json& member : value) empty(member);
    value.clear();
}

}  // namespace

JsonFile::~JsonFile() { empty(root); }

JsonFile parse_json(std::span<const uint8_t> text, const std::string& name) {
    const std::string file = one_line(name);
    check_json_text(text, file, scaled_limit(kMostValues));
    try {
        return JsonFile(file, nlohmann::json::parse(text.begin(), text.end()));
    } catch (const nlohmann::json::parse_error& error) {
        const bool encoding = std::string_view(error.what()).find("ill-formed UTF-8") != std::string_view::npos;
        throw Error(file + ": byte " + std::to_string(error.byte) + ": not valid JSON" +
                    (encoding ? ": is no UTF-8" : ""));
    } catch (const nlohmann::json::exception& error) {  // a number beyond double
        throw Error(file + ": not valid JSON: " + one_line(error.what()));
    }
}

JsonValue JsonValue::at(const char* key) const {
    if (auto member = find(key)) return *member;
    fail("has no \"" + std::string(key) + "\"");
}

std::optional<JsonValue> JsonValue::find(const char* key) const {
    if (!value_->is_object()) fail("must be an object");
    const auto member = value_->find(key);
    if (member == value_->end()) return std::nullopt;
    return JsonValue(*file_, *member);
}

void JsonValue::allow_only(std::span<const char* const> keys) const {
    if (!value_->is_object()) fail("must be an object");
    for (const auto& item : value_->items())
        if (std::none_of(keys.begin(), keys.end(), [&](const char* allowed) { return item.key() == allowed; }))
            JsonValue(*file_, item.value()).fail("unknown key");
}

std::vector<JsonValue> JsonValue::members() const {
    if (!value_->is_object()) fail("must be an object");
    std::vector<JsonValue> result;
    for (const nlohmann::json& member : *value_) result.emplace_back(*file_, member);
    return result;
}

std::vector<JsonValue> JsonValue::elements(size_t count) const {
    if (!value_->is_array()) fail("must be an array");
    if (count != 0 && value_->size() != count)
        fail("must have " + std::to_string(count) + " elements, has " + std::to_string(value_->size()));
    std::vector<JsonValue> result;
    result.reserve(value_->size());
    for (const nlohmann::json& element : *value_) result.emplace_back(*file_, element);
    return result;
}

JsonValue JsonValue::element_at(const JsonValue& index, const char* of) const {
    if (!value_->is_array()) fail("must be an array");
    return JsonValue(*file_, (*value_)[index.index(value_->size(), of)]);
}

std::vector<JsonValue> JsonValue::elements_of(const char* key) const {
    const auto member = find(key);
    return member ? member->elements() : std::vector<JsonValue>{};
}

double JsonValue::number(double low, double high) const {
    if (!value_->is_number()) fail("must be a number");
    const double number = value_->get<double>();
    if (!std::isfinite(number) || std::abs(number) > FLT_MAX) fail("must be a finite number");
    if (number < low || number > high) {
        if (high == FLT_MAX) fail("must be at least " + decimal(low, 6) + ", is " + decimal(number, 6));
        fail("must be from " + decimal(low, 6) + " to " + decimal(high, 6) + ", is " + decimal(number, 6));
    }
    return number;
}

double JsonValue::number_or(const char* key, double fallback, double low, double high) const {
    const auto member = find(key);
    return member ? member->number(low, high) : fallback;
}

uint64_t JsonValue::integer(uint64_t high) const {
    uint64_t number = 0;
    if (value_->is_number_integer() && (value_->is_number_unsigned() || value_->get<int64_t>() >= 0)) {
        number = value_->get<uint64_t>();
    } else if (value_->is_number_float()) {
        const double real = value_->get<double>();
        if (!(real >= 0 && real <= 9007199254740992.0) || real != std::floor(real))
            fail("must be a whole number from 0");
        number = static_cast<uint64_t>(real);
    } else {
        fail("must be a whole number from 0");
    }
    if (number > high) fail("must be at most " + std::to_string(high) + ", is " + std::to_string(number));
    return number;
}

uint64_t JsonValue::integer_or(const char* key, uint64_t fallback, uint64_t high) const {
    const auto member = find(key);
    return member ? member->integer(high) : fallback;
}

uint32_t JsonValue::index(size_t size, const char* of) const {
    const uint64_t value = integer();
    if (value >= size || value >= UINT32_MAX)
        fail("names number " + std::to_string(value) + " of the " + of + ", of which there are " +
             std::to_string(size));
    return static_cast<uint32_t>(value);
}

bool JsonValue::boolean() const {
    if (!value_->is_boolean()) fail("must be true or false");
    return value_->get<bool>();
}

bool JsonValue::boolean_or(const char* key, bool fallback) const {
    const auto member = find(key);
    return member ? member->boolean() : fallback;
}

const std::string& JsonValue::text() const {
    if (!value_->is_string()) fail("must be a string");
    return value_->get_ref<const std::string&>();
}

std::string JsonValue::text_or(const char* key, const std::string& fallback) const {
    const auto member = find(key);
    return member ? member->text() : fallback;
}

std::string JsonValue::place() const {
    const std::string pointer = file_->pointer + pointer_to(file_->root, value_).value_or("");
    return file_->name + ": " + (pointer.empty() ? "/" : one_line(pointer));
}

void JsonValue::fail(const std::string& reason) const { throw Error(place() + ": " + one_line(reason, 1000)); }

}  // namespace vesper::scene
