// The commands of the `vesper` program. SPDX-License-Identifier: MIT
#pragma once

namespace CLI {
class App;
}

namespace vesper {

void add_render(CLI::App& program);
void add_convert(CLI::App& program);
void add_road(CLI::App& program);
void add_merge(CLI::App& program);
void add_inspect(CLI::App& program);
void add_tonemap(CLI::App& program);
void add_display(CLI::App& program);
void add_study(CLI::App& program);

}  // namespace vesper
