// The `vesper-bench` program. SPDX-License-Identifier: MIT
#pragma once

#include "command_line.h"

namespace vesper {

void add_bench(Command program);

}  // namespace vesper
