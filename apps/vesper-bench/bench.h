// The `vesper-bench` program. SPDX-License-Identifier: MIT
#pragma once

namespace CLI {
class App;
}

namespace vesper {

void add_bench(CLI::App& program);

}  // namespace vesper
