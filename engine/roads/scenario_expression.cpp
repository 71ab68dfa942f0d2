// Expressions of OpenSCENARIO files. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "photometry/table.h"
#include "roads/esmini_parts.h"

namespace vesper::roads {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }
bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Calls of one argument, and of two. Angles rad and sign(0) = 1 as esmini has them.
std::optional<double> call(std::string_view name, double a) {
    if (name == "round") return std::rint(a);
    if (name == "floor") return std::floor(a);
    if (name == "ceil") return std::ceil(a);
    if (name == "sqrt") return std::sqrt(a);
    if (name == "abs") return std::abs(a);
    if (name == "sign") return a < 0 ? -1.0 : 1.0;
    if (name == "sin") return std::sin(a);
    if (name == "cos") return std::cos(a);
    if (name == "tan") return std::tan(a);
    if (name == "asin") return std::asin(a);
    if (name == "acos") return std::acos(a);
    if (name == "atan") return std::atan(a);
    return std::nullopt;
}
std::optional<double> call(std::string_view name, double a, double b) {
    if (name == "pow") return std::pow(a, b);
    if (name == "min") return std::min(a, b);
    if (name == "max") return std::max(a, b);
    return std::nullopt;
}

/// Operators of numbers and parameters (OpenSCENARIO 1.3, 10.1); truth is 1 or 0.
struct Expression {
    using Value = std::optional<double>;
    using Level = Value (Expression::*)();

    std::string_view text;
    const Parameters& scope;
    size_t at = 0;
    int depth = 0;

    void skip() {
        while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
    }
    bool take(std::string_view sign) {
        skip();
        if (!text.substr(at).starts_with(sign)) return false;
        const bool is_word = is_name(sign[0]) && at + sign.size() < text.size() && is_name(text[at + sign.size()]);
        if (is_word) return false;
        at += sign.size();
        return true;
    }
    std::string_view word() {
        const size_t first = at;
        while (at < text.size() && is_name(text[at])) ++at;
        return text.substr(first, at - first);
    }
    static Value value_of(std::string_view words) {
        if (words == "true") return 1;
        if (words == "false") return 0;
        return photometry::number_of(words, false);
    }

    Value number() {
        const size_t first = at;
        const auto digits = [&] {
            while (at < text.size() && (is_digit(text[at]) || text[at] == '.')) ++at;
        };
        digits();
        if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
            const size_t exponent = at + 1 + (at + 1 < text.size() && (text[at + 1] == '-' || text[at + 1] == '+'));
            if (exponent < text.size() && is_digit(text[exponent])) at = exponent, digits();
        }
        return photometry::number_of(text.substr(first, at - first), false);
    }
    Value named(std::string_view name) {
        if (!take("(")) {
            if (name == "pi") return std::numbers::pi;
            if (name == "e") return std::numbers::e;
            return name == "true" || name == "false" ? value_of(name) : std::nullopt;
        }
        const Value a = either();
        const Value b = a && take(",") ? either() : std::nullopt;
        if (!a || !take(")")) return std::nullopt;
        return b ? call(name, *a, *b) : call(name, *a);
    }
    Value factor() {
        if (++depth > 100) return std::nullopt;
        Value value;
        if (take("(")) {
            value = either();
            if (!take(")")) value.reset();
        } else if (take("-")) {
            if ((value = factor())) value = -*value;
        } else if (take("!") || take("not")) {
            if ((value = factor())) value = *value == 0;
        } else if (take("$")) {
            const auto found = scope.find(word());
            if (found != scope.end()) value = value_of(found->second);
        } else if (skip(); at < text.size() && is_name(text[at]) && !is_digit(text[at])) {
            value = named(word());
        } else {
            value = number();
        }
        --depth;
        return value;
    }
    /// Operators of the same rank, from the left.
    template <size_t N>
    Value chain(Level next, const std::array<std::string_view, N>& signs, auto&& apply) {
        Value value = (this->*next)();
        while (value) {
            const auto sign = std::find_if(signs.begin(), signs.end(), [&](std::string_view s) { return take(s); });
            if (sign == signs.end()) return value;
            const Value other = (this->*next)();
            if (!other) return std::nullopt;
            value = apply(*sign, *value, *other);
        }
        return value;
    }
    Value product() {
        return chain<3>(&Expression::factor, {"*", "/", "%"}, [](std::string_view sign, double a, double b) {
            return sign == "*" ? a * b : sign == "/" ? a / b : std::fmod(a, b);
        });
    }
    Value sum() {
        return chain<2>(&Expression::product, {"+", "-"},
                        [](std::string_view sign, double a, double b) { return sign == "+" ? a + b : a - b; });
    }
    Value comparison() {
        return chain<6>(&Expression::sum, {"<=", ">=", "==", "!=", "<", ">"},
                        [](std::string_view sign, double a, double b) -> double {
                            if (sign == "==" || sign == "!=") return (a == b) == (sign == "==");
                            return sign[0] == '<' ? (sign == "<" ? a < b : a <= b) : (sign == ">" ? a > b : a >= b);
                        });
    }
    Value both() {
        return chain<2>(&Expression::comparison, {"&&", "and"},
                        [](std::string_view, double a, double b) -> double { return a != 0 && b != 0; });
    }
    Value either() {
        return chain<2>(&Expression::both, {"||", "or"},
                        [](std::string_view, double a, double b) -> double { return a != 0 || b != 0; });
    }
};

}  // namespace

std::optional<double> expression_value(std::string_view text, const Parameters& scope) {
    Expression expression{text, scope};
    const auto value = expression.either();
    expression.skip();
    if (!value || !std::isfinite(*value) || expression.at != text.size()) return std::nullopt;
    return value;
}

}  // namespace vesper::roads
