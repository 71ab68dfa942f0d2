// SPDX-License-Identifier: MIT
#include "fuzz/found.h"

namespace vesper::test {
namespace {

TEST(FuzzFound, EveryInputIsAnswered) { expect_answers(fuzz_targets()); }

}  // namespace
}  // namespace vesper::test
