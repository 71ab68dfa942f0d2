// Files of data/ may name each other in tests, as they may in the programs. SPDX-License-Identifier: MIT
#include "io/named_file.h"
#include "places.h"

namespace vesper::test {
namespace {

const io::AllowedFolder own_data(VESPER_SOURCE_DIR "/data");

}  // namespace
}  // namespace vesper::test
