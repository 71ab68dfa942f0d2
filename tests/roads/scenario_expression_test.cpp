// Expressions of OpenSCENARIO files. SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "roads/esmini_parts.h"

namespace vesper::test {
namespace {

// Ranks of operators, functions and their arguments, numbers with exponents: values by hand.
TEST(ScenarioExpressions, HaveTheirValues) {
    const roads::Parameters scope{{"v", "3"}, {"yes", "true"}, {"word", "fast"}};
    const auto value = [&](const char* text) { return roads::expression_value(text, scope).value_or(NAN); };
    EXPECT_EQ(value("1 + 2 * $v"), 7);
    EXPECT_EQ(value("(1 + 2) * -$v"), -9);
    EXPECT_EQ(value("10 - 4 - 3"), 3);
    EXPECT_EQ(value("7 % $v * 2"), 2);
    EXPECT_EQ(value("1e-1 * 1.5E+2 + 2e1"), 35);
    EXPECT_EQ(value("round(1.4) + floor(1.9) + ceil(0.1)"), 3);
    EXPECT_EQ(value("sqrt(pow(2, 4)) + abs(-2)"), 6);
    EXPECT_EQ(value("max(min(5, $v), 2) - sign(-8)"), 4);
    EXPECT_NEAR(value("sin(pi / 6) + asin(1)"), 0.5 + std::numbers::pi / 2, 1e-12) << "rad";
    EXPECT_EQ(value("not ($v < 3) and $yes"), 1);
    EXPECT_EQ(value("$v == 4 || !true"), 0);
    EXPECT_EQ(value("1 < 2 or 1 / 0 > 1"), 1);
}

TEST(ScenarioExpressions, OthersAreNone) {
    const roads::Parameters scope{{"word", "fast"}};
    for (const char* text : {"", "1 +", "1 2", "$none", "$word", "2 * (1", "round()", "round(1, 2)", "pow(2)",
                             "pow(2,)", "noSuch(1)", "1/0", "sqrt(-1)", "notx", "5 and", "1e400"})
        EXPECT_FALSE(roads::expression_value(text, scope)) << text;
    EXPECT_FALSE(roads::expression_value(std::string(500, '(') + "1" + std::string(500, ')'), scope));
    EXPECT_FALSE(roads::expression_value(std::string(5000, '-') + "1", scope));
}

}  // namespace
}  // namespace vesper::test
