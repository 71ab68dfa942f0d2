// Arrows. SPDX-License-Identifier: MIT
#include "roads/stencils.h"

#include <algorithm>

#include "base/lower.h"

namespace vesper::roads {
namespace {

// Parts of the length and the width of an arrow, about as in RMS 1980.
constexpr double kHeadAhead = 0.35;                // length of the head of an arrow straight on
constexpr double kHeadAlong = 0.12;                // half of the base of a head to the side
constexpr double kHeadAcross = 0.45, kBar = 0.03;  // length of that head; half of its bar
constexpr double kStem = 0.075;                    // m, half of the stem

bool has(const std::string& text, const char* word) { return text.find(word) != text.npos; }

/// "Stencil_ArrowType4L" ends in the direction, before a number of the copy.
std::string without_copy(std::string text) {
    while (!text.empty() && ((text.back() >= '0' && text.back() <= '9') || text.back() == '_')) text.pop_back();
    return text;
}

/// None of the directions where the text does not say it.
std::optional<ArrowShape> arrow_in(const std::string& text) {
    const size_t at = text.find("arrow");
    if (at == text.npos) return std::nullopt;
    ArrowShape shape{has(text, "straight") || has(text, "ahead") || has(text, "through") || has(text, "forward"),
                     has(text, "left"), has(text, "right")};
    if (shape.straight || shape.left || shape.right) return shape;
    // The kind after "ArrowType" is a number and L, R, S or both of them; "Long" and "Short" are lengths.
    const std::string rest = without_copy(text.substr(at + 5));
    if (!rest.starts_with("type") || has(rest, "long") || has(rest, "short")) return shape;
    for (const char c : rest.substr(4)) {
        if (c != 'l' && c != 'r' && c != 's' && (c < '0' || c > '9')) break;
        shape.straight |= c == 's', shape.left |= c == 'l', shape.right |= c == 'r';
    }
    return shape;
}

}  // namespace

std::optional<ArrowShape> arrow_of(const RoadObject& object) {
    bool is_arrow = false, turns = false;
    for (const std::string* stated : {&object.subtype, &object.name, &object.type}) {
        const std::string text = lower(*stated);
        for (const char* back : {"uturn", "u-turn", "u_turn", "u turn"})
            if (has(text, back)) return std::nullopt;
        turns |= has(text, "turn");
        const std::optional<ArrowShape> shape = arrow_in(text);
        if (shape && (shape->straight || shape->left || shape->right)) return shape;
        is_arrow |= shape.has_value();
    }
    return is_arrow && !turns ? std::optional(ArrowShape{.straight = true}) : std::nullopt;
}

bool is_shapeless(const RoadObject& object) {
    const std::string text = lower(object.subtype + " " + object.name);
    if (has(text, "arrow") && !arrow_of(object)) return true;
    if (has(text, "line") || has(text, "crosswalk")) return false;
    return has(text, "stencil") || has(text, "lettering") || has(text, "symbol");
}

double usual_width(const ArrowShape& shape) { return shape.left || shape.right ? 1.2 : 0.6; }

std::vector<std::vector<glm::dvec2>> arrow_parts(const ArrowShape& shape, double length, double width) {
    const double half = width / 2, stem = std::min(kStem, width / 6), rear = -length / 2;
    // With one turn the stem stands on the other side.
    const double middle = (shape.left == shape.right ? 0 : width / 4) * (shape.left ? -1 : 1);
    const double room = half - std::abs(middle), head = shape.left || shape.right ? std::min(room, width / 5) : room;
    const double across = shape.straight ? 0.05 * length : (0.5 - kHeadAlong) * length;  // where bars leave the stem
    const double bar = kBar * length, tip = length / 2, shoulder = tip - kHeadAhead * length;
    std::vector<std::vector<glm::dvec2>> parts;
    const double stem_end = shape.straight ? shoulder : across + bar;
    parts.push_back(
        {{rear, middle - stem}, {stem_end, middle - stem}, {stem_end, middle + stem}, {rear, middle + stem}});
    if (shape.straight) parts.push_back({{shoulder, middle - head}, {tip, middle}, {shoulder, middle + head}});
    for (const double side : {1.0, -1.0}) {
        if (!(side > 0 ? shape.left : shape.right)) continue;
        const double end = side * half, base = end - kHeadAcross * (end - middle), begin = middle + side * stem;
        parts.push_back({{across - bar, begin}, {across + bar, begin}, {across + bar, base}, {across - bar, base}});
        parts.push_back({{across - kHeadAlong * length, base}, {across + kHeadAlong * length, base}, {across, end}});
    }
    return parts;
}

}  // namespace vesper::roads
