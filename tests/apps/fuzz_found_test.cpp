// SPDX-License-Identifier: MIT
#include "fuzz/found.h"

namespace vesper::test {
namespace {

TEST(FuzzFound, EveryInputOfProgramsIsAnswered) { expect_answers(program_fuzz_targets()); }

}  // namespace
}  // namespace vesper::test
