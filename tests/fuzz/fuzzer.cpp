// One reader under libFuzzer (scripts/fuzz). SPDX-License-Identifier: MIT
#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
    static const vesper::test::FuzzTarget& target = vesper::test::fuzz_targets().at(VESPER_FUZZ_TARGET);
    target({bytes, size});
    return 0;
}
