// The reference of pictures: units, and what passes through. SPDX-License-Identifier: MIT
#include "passes/picture_reference.h"

#include <limits>

#include <gtest/gtest.h>

namespace vesper::test::picture_reference_test {
namespace {

TEST(PictureReference, IsLinear) {
    EXPECT_EQ(reference::add_picture({1, 0.5, 2}, 100), glm::dvec4(100, 50, 200, 1));
    EXPECT_EQ(reference::add_picture({0, 0, 0}, 1e9), glm::dvec4(0, 0, 0, 1));
    EXPECT_EQ(reference::add_picture({std::numeric_limits<double>::infinity(), 1, 1}, 2).r,
              std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace vesper::test::picture_reference_test
