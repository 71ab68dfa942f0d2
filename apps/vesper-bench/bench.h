// The `vesper-bench` program. SPDX-License-Identifier: MIT
#pragma once

#include "arguments/command_line.h"

namespace vesper::bench {

void add_bench(apps::Command program);

}  // namespace vesper::bench
