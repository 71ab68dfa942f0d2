// What parsers of JSON let pass and readers do not. SPDX-License-Identifier: MIT
#include "scene/json_text.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/json_value.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

std::string complaint(const std::string& text) {
    try {
        scene::parse_json({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, "x.json");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(JsonText, KeysAreThereOnce) {
    EXPECT_EQ(complaint(R"({"a": {"b": 1, "c": [{"b": 1}, {"b": 2}]}, "b": {"a": 1}})"), "");
    EXPECT_EQ(complaint(R"({"a": 1, "a": 2})"), "x.json: /a: is there twice");
    EXPECT_EQ(complaint(R"({"a": 1, "\u0061": 2})"), "x.json: /a: is there twice");
    EXPECT_EQ(complaint(R"({"x": [[], 7, "y", {"c": {}, "d/e": [1, 2, {"k": null, "l": 0, "k": 1}]}]})"),
              "x.json: /x/3/d~1e/2/k: is there twice");
    EXPECT_EQ(complaint(R"([{"a": {"z": 1}, "b": 1, "a": {"z": 2}}])"), "x.json: /0/a: is there twice");
}

TEST(JsonText, ANulEndsNothing) {
    const std::string text = R"({"a": 1})";
    EXPECT_EQ(complaint(text + std::string(3, '\0')), "");  // how binary glTF is filled up by some
    EXPECT_TRUE(contains(complaint(text + '\0' + ",\"b\": 2}"), "x.json: byte 9: not valid JSON: a NUL"));
    EXPECT_TRUE(contains(complaint(text + '\0' + text), "a NUL"));
}

}  // namespace
}  // namespace vesper::test
