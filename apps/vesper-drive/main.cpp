// The `vesper-drive` program: a simulator in a night street. SPDX-License-Identifier: MIT
#include "arguments/command_line.h"
#include "run/drive.h"

int main(int argc, char** argv) {
    vesper::apps::Program program{"Drive at night, see and record what the eye does (docs/simulator.md).",
                                  "vesper-drive"};
    program.version(VESPER_VERSION);
    vesper::drive::add_drive(program);
    return program.run(argc, argv);
}
