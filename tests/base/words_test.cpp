// Words of names. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "base/words.h"

namespace vesper::test {
namespace {

TEST(Words, EndAtSignsDigitsAndCapitals) {
    using Words = std::vector<std::string>;
    EXPECT_EQ(words_of("LEDStreetLamp_03"), (Words{"led", "street", "lamp"}));
    EXPECT_EQ(words_of("street-light 2b"), (Words{"street", "light", "b"}));
    EXPECT_EQ(words_of("HDRIs"), (Words{"hdris"}));
    EXPECT_EQ(words_of("HDRIsky"), (Words{"hdr", "isky"}));
    EXPECT_EQ(words_of("Straßenlaterne"), (Words{"straßenlaterne"}));
    EXPECT_EQ(words_of("CLamp"), (Words{"c", "lamp"}));
    EXPECT_EQ(words_of("aB"), (Words{"a", "b"}));
    for (const char* none : {"", "003", "_-."}) EXPECT_TRUE(words_of(none).empty());
}

}  // namespace
}  // namespace vesper::test
