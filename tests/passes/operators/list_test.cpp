// The list of operators, and the table of them in docs/tone.md. SPDX-License-Identifier: MIT
#include "render/passes/operators.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <vesper/vesper.h>

#include "places.h"

namespace vesper::test::list_test {
namespace {

/// "`--key`, `--white`", by the name of an operator.
std::map<std::string, std::string> options_of_operators() {
    std::map<std::string, std::string> made;
    render::OperatorSettings all;
    size_t index = 0;
    all.each([&](auto& settings) {
        std::string& list = made[std::string(render::operators()[index++].name)];
        settings.options([&](const render::OperatorOption& option, auto&) {
            list += (list.empty() ? "`" : ", `") + std::string(option.name) + "`";
        });
    });
    return made;
}

std::string table() {
    const char* const adapt_to[]{"gaze", "gaze-mean", "texel", "average"};
    const char* const ceiling[]{"eye", "human", "cones", "linear"};
    const auto options = options_of_operators();
    std::string text =
        "| `--operator` | source | earlier frames | `--adapt-to` | `--ceiling` | options |\n"
        "| --- | --- | --- | --- | --- | --- |\n";
    for (const render::OperatorInfo& op : render::operators()) {
        const std::string name(op.name);
        text += "| `" + name + "` | " + std::string(op.summary) + " | " + (op.remembers ? "yes" : "no") + " | `" +
                adapt_to[op.adapt_to] + "` | `" + ceiling[op.ceiling] + "` | " + options.at(name) + " |\n";
    }
    return text;
}

TEST(Operators, TheDocumentListsThem) {
    std::ifstream stream(VESPER_SOURCE_DIR "/docs/tone.md", std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    const size_t from = text.find("<!-- operators"), until = text.find("<!-- /operators -->");
    ASSERT_TRUE(from != text.npos && until != text.npos && from < until);
    const size_t begin = text.find('\n', from) + 1;
    EXPECT_EQ(text.substr(begin, until - begin), table());
}

TEST(Operators, HaveNamesAndOptionsOfTheirOwn) {
    std::set<std::string> names, options;
    for (const render::OperatorInfo& op : render::operators()) {
        EXPECT_TRUE(names.emplace(op.name).second) << op.name;
        EXPECT_FALSE(op.summary.empty()) << op.name;
    }
    render::OperatorSettings all;
    all.each([&](auto& settings) {
        settings.options([&](const render::OperatorOption& option, auto&) {
            EXPECT_TRUE(options.emplace(option.name).second) << option.name;
            EXPECT_NE(std::string(option.help), "");
        });
    });
}

// Programs of other people hold these numbers.
TEST(Operators, KeepTheirValues) {
    const std::pair<VesperOperator, int> values[]{{VESPER_IRAWAN, 0}, {VESPER_WARD, 1},      {VESPER_REINHARD, 2},
                                                  {VESPER_LINEAR, 3}, {VESPER_PATTANAIK, 5}, {VESPER_FERWERDA, 6},
                                                  {VESPER_DURAND, 7}, {VESPER_GRAVE, 8}};
    for (const auto& [value, wanted] : values) EXPECT_EQ(int(value), wanted);
    EXPECT_EQ(render::operator_info(render::Operator::Pattanaik).name, "pattanaik");
    EXPECT_EQ(render::operator_info(render::Operator::Grave).name, "grave");
}

TEST(Operators, SettingsThatContradictEachOtherAreRefused) {
    render::OperatorSettings all;
    EXPECT_NO_THROW(all.check());
    all.linear = {.low = 5, .high = 5};
    EXPECT_THROW(all.check(), Error);
}

}  // namespace
}  // namespace vesper::test::list_test
