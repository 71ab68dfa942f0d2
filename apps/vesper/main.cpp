// The `vesper` program: convert a daytime database to photometry, render it at night. SPDX-License-Identifier: MIT
#include "arguments/command_line.h"
#include "commands.h"

int main(int argc, char** argv) {
    vesper::apps::Program program{"What a driver sees at night, on the screen you have.", "vesper"};
    program.version(VESPER_VERSION);
    program.requires_command();
    program.footer(
        "vesper SUBCOMMAND --help says what each takes; vesper-drive is the simulator.\n"
        "Example:\n"
        "  vesper convert street.gltf --photometry street.photometry.json -o night.gltf\n"
        "  vesper render night.gltf --camera driver --stats -o night.png\n");
    vesper::commands::add_convert(program);
    vesper::commands::add_render(program);
    vesper::commands::add_road(program);
    vesper::commands::add_merge(program);
    vesper::commands::add_inspect(program);
    vesper::commands::add_tonemap(program);
    vesper::commands::add_compare(program);
    vesper::commands::add_display(program);
    vesper::commands::add_study(program);
    vesper::commands::add_saliency(program);
    vesper::commands::add_devices(program);
    return program.run(argc, argv);
}
