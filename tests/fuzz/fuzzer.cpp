// One reader under libFuzzer (scripts/fuzz). SPDX-License-Identifier: MIT
#include "fuzz/targets.h"

using namespace vesper::test;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
    static const FuzzTarget& target = VESPER_FUZZ_TARGETS().at(VESPER_FUZZ_TARGET);
    target({bytes, size});
    return 0;
}
