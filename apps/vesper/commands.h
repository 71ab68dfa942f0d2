// The commands of the `vesper` program. SPDX-License-Identifier: MIT
#pragma once

#include "arguments/command_line.h"

namespace vesper::commands {

void add_render(apps::Command program);
void add_convert(apps::Command program);
void add_road(apps::Command program);
void add_merge(apps::Command program);
void add_inspect(apps::Command program);
void add_tonemap(apps::Command program);
void add_compare(apps::Command program);
void add_display(apps::Command program);
void add_study(apps::Command program);
void add_saliency(apps::Command program);
void add_devices(apps::Command program);

}  // namespace vesper::commands
