// The commands of the `vesper` program. SPDX-License-Identifier: MIT
#pragma once

#include "command_line.h"

namespace vesper {

void add_render(Command program);
void add_convert(Command program);
void add_road(Command program);
void add_merge(Command program);
void add_inspect(Command program);
void add_tonemap(Command program);
void add_display(Command program);
void add_study(Command program);

}  // namespace vesper
