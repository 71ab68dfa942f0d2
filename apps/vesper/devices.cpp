// `vesper devices`: the Vulkan devices of the machine. SPDX-License-Identifier: MIT
#include <memory>
#include <string>

#include "arguments/command_line.h"
#include "commands.h"
#include "gpu/device.h"
#include "gpu/requirements.h"
#include "print.h"

namespace vesper::commands {

void add_devices(apps::Command program) {
    apps::Command command = program.add_command("devices", "List the Vulkan devices of this machine");
    const auto only_default = std::make_shared<bool>(false);
    command.add_flag("--default", *only_default,
                     "Only the one that is taken without --device: that of VESPER_DEVICE, else the best");
    command.callback([only_default] {
        if (*only_default)
            apps::print("%s\n", gpu::described(gpu::Device().physical()).c_str());
        else
            for (const std::string& line : gpu::list_devices()) apps::print("%s\n", line.c_str());
    });
}

}  // namespace vesper::commands
