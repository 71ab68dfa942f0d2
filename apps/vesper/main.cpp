// The `vesper` program: convert a daytime database to photometry, render it at night. SPDX-License-Identifier: MIT
#include <string>

#include "command_line.h"
#include "commands.h"
#include "gpu/device.h"
#include "print.h"

int main(int argc, char** argv) {
    vesper::Program program{"What a driver sees at night, on the screen you have.", "vesper"};
    program.version(VESPER_VERSION);
    program.requires_command();
    program.footer(
        "vesper SUBCOMMAND --help says what each takes; vesper-drive is the simulator.\n"
        "Example:\n"
        "  vesper convert street.gltf --photometry street.photometry.json -o night.gltf\n"
        "  vesper render night.gltf --camera driver --stats -o night.png\n");
    vesper::add_convert(program);
    vesper::add_render(program);
    vesper::add_road(program);
    vesper::add_merge(program);
    vesper::add_inspect(program);
    vesper::add_tonemap(program);
    vesper::add_display(program);
    vesper::add_study(program);
    vesper::Command devices = program.add_command("devices", "List the Vulkan devices of this machine");
    devices.callback([] {
        for (const std::string& line : vesper::list_devices()) vesper::print("%s\n", line.c_str());
    });
    return program.run(argc, argv);
}
