// The list of operators, and the table of them in docs/tone.md. SPDX-License-Identifier: MIT
#include "render/passes/operators.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <vesper/vesper.h>

#include "places.h"
#include "render/settings.h"
#include "render/tone_rows.h"

namespace vesper::test::list_test {
namespace {

/// "`--key`, `--white`", by the name of an operator.
std::map<std::string, std::string> options_of_operators() {
    std::map<std::string, std::string> made;
    size_t index = 0;
    render::OperatorSettings::each([&](auto of) {
        std::string& list = made[std::string(render::operators()[index++].name)];
        using Own = std::remove_reference_t<decltype(std::declval<render::OperatorSettings&>().*of)>;
        Own::options([&](auto, const render::OperatorOption& option) {
            list += (list.empty() ? "`--" : ", `--") + render::tone_row(option.name).option() + "`";
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

TEST(Operators, HaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const render::OperatorInfo& op : render::operators()) {
        EXPECT_TRUE(names.emplace(op.name).second) << op.name;
        EXPECT_FALSE(op.summary.empty()) << op.name;
    }
}

TEST(ToneRows, HaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const render::LightSetting& row : render::light_rows()) names.emplace(row.name);
    for (const render::ToneRow& row : render::tone_rows()) {
        EXPECT_TRUE(names.emplace(row.name).second) << row.name;
        EXPECT_FALSE(row.help.empty()) << row.name;
    }
}

// Every value of a choice, and both ends of a range: what was set is what is got, and what its text says.
TEST(ToneRows, SettingsAreTextsThatReadBack) {
    for (const render::ToneRow& row : render::tone_rows()) {
        EXPECT_EQ(row.get({}), row.value(render::Quality::Standard)) << row.name;
        std::vector<double> values{row.low, row.high};
        if (row.kind == render::SettingKind::Choice)
            for (double value = row.low; value < row.high; ++value) values.push_back(value);
        for (const double value : values) {
            render::ToneChainSettings settings;
            row.set(settings, row.parse(row.text(row.checked(value))));
            EXPECT_EQ(row.get(settings), row.rounded(value)) << row.name;
            for (const render::ToneRow& other : render::tone_rows())
                EXPECT_TRUE(&other == &row || other.get(settings) == other.get({}))
                    << row.name << " sets " << other.name;
        }
        for (const double value : {row.low - 1, row.high * 1.01 + 1, std::nan("")})
            EXPECT_THROW(row.checked(value), Error) << row.name << " " << value;
    }
    EXPECT_THROW(render::tone_row("pupils"), Error);
    EXPECT_THROW(render::tone_row("glare").parse("moss"), Error);
}

// An observer has one age: of thresholds and of the scatter in the eye.
TEST(ToneRows, AnObserverHasOneAge) {
    render::ToneChainSettings settings;
    EXPECT_EQ(settings.scatter.eye.age, settings.tone.observer.age);
    render::tone_row("age").set(settings, 71);
    EXPECT_EQ(settings.scatter.eye.age, 71);
    EXPECT_EQ(settings.tone.observer.age, 71);
}

std::string table_of_rows() {
    std::string text = "| option | value | default | meaning |\n| --- | --- | ---: | --- |\n";
    for (const render::ToneRow& row : render::tone_rows()) {
        const std::string help(row.help.substr(0, row.help.find('\n')));
        text += "| `--" + row.option() + "` | " + row.range() + " | " + row.text(row.value(render::Quality::Standard)) +
                " | " + help + " |\n";
    }
    return text;
}

TEST(ToneRows, TheDocumentListsThem) {
    std::ifstream stream(VESPER_SOURCE_DIR "/docs/tone-settings.md", std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    const size_t from = text.find("<!-- settings"), until = text.find("<!-- /settings -->");
    ASSERT_TRUE(from != text.npos && until != text.npos && from < until);
    const size_t begin = text.find('\n', from) + 1;
    EXPECT_EQ(text.substr(begin, until - begin), table_of_rows());
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
