// One reader under libFuzzer (scripts/fuzz). SPDX-License-Identifier: MIT
#include "fuzz/targets.h"

using namespace vesper::test;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
    static const FuzzTarget& target = VESPER_FUZZ_TARGETS().at(VESPER_FUZZ_TARGET);
    target({bytes, size});
    return 0;
}

// Each living pipeline of lavapipe is one "leak" of 48 bytes: all it keeps of its memory context is the address behind
// the context's header, which is the end of the block, and there the sanitizer no longer takes it for a pointer into
// that.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libvulkan_lvp.so\n"; }
