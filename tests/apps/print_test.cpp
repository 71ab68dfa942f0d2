// Text of files reaches the terminal as plain characters. SPDX-License-Identifier: MIT
#include "print.h"

#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using apps::format;

constexpr const char* kHostile = "a\x1b[31mb\nc\r\xc2\x9b";

TEST(Print, FormatsAsPrintfDoes) {
    const auto expect = [](const std::string& text, const char* pattern, auto... values) {
        char wanted[200];
        std::snprintf(wanted, sizeof wanted, pattern, values...);
        EXPECT_EQ(text, wanted) << pattern;
    };
#define EXPECT_AS_PRINTF(...) expect(format(__VA_ARGS__), __VA_ARGS__)
    EXPECT_AS_PRINTF("%u of %u, %zu, %llu, %ld", 3u, 4294967295u, size_t(1) << 40, 1ull << 63, -5L);
    EXPECT_AS_PRINTF("%d %4d %04d %+d %x %c", -7, 12, 12, 3, 255u, 'q');
    EXPECT_AS_PRINTF("%g %.4g %8.3f %+.2f %.17g %e", 0.1, 12345.6789, -2.5, 1.0, 0.1, 1e300);
    EXPECT_AS_PRINTF("%*.3g|%10.*f|%0*u|%-*s|", 9, 1.5, 2, 3.14159, 6, 42u, 5, "ab");
    EXPECT_AS_PRINTF("%s|%8s|%-8s|%.2s| 5 %%", "text", "r", "l", "cut");
    EXPECT_AS_PRINTF("nothing");
#undef EXPECT_AS_PRINTF
    EXPECT_EQ(format("%f", 1e300).size(), 308u) << "numbers of any length";
}

TEST(Print, MakesTextPlain) {
    EXPECT_EQ(format("%s\n", kHostile), "a?[31mb?c???\n");
    testing::internal::CaptureStdout();
    apps::print("%s\n", kHostile);
    apps::print_text(std::string("one\n") + "t\x1bwo\n\nlast");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "a?[31mb?c???\none\nt?wo\n\nlast");
    testing::internal::CaptureStderr();
    apps::print_note(kHostile), apps::print_warning(kHostile), apps::print_error("p", kHostile);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "note: a?[31mb?c???\nwarning: a?[31mb?c???\np: a?[31mb?c???\n");
}

std::string printed(const std::vector<std::string>& notes) {
    testing::internal::CaptureStderr();
    apps::print_notes(notes);
    return testing::internal::GetCapturedStderr();
}

TEST(Print, CountsNotesOfOneKind) {
    std::vector<std::string> notes;
    for (int i = 0; i < 21; ++i)
        notes.push_back("road '" + std::string(size_t(i + 1), 'x') + "' jumps by " + std::to_string(i * -0.5) + " m");
    notes.emplace_back("another");
    const std::string text = printed(notes);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 22);
    EXPECT_NE(text.find("note: another\nnote: and 1 more like these\n"), text.npos) << text;
    notes.clear();
    for (int i = 0; i < 26 * 26; ++i) notes.push_back(std::string{char('a' + i % 26), char('a' + i / 26)});
    const std::string many = printed(notes);
    EXPECT_EQ(std::count(many.begin(), many.end(), '\n'), 101);
    EXPECT_TRUE(many.ends_with("note: and 576 more like these\n"));
    EXPECT_EQ(printed({}), "");
}

}  // namespace
}  // namespace vesper::test
