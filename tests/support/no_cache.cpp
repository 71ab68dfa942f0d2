// Programs that tests run keep nothing in the caches of whoever runs the tests. SPDX-License-Identifier: MIT
#include <cstdlib>

namespace vesper::test {
namespace {

const int no_cache = setenv("VESPER_CACHE", "off", 1);

}  // namespace
}  // namespace vesper::test
