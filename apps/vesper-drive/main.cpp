// The `vesper-drive` program: a simulator in a night street. SPDX-License-Identifier: MIT
#include "drive.h"
#include "help.h"
#include "program.h"

int main(int argc, char** argv) {
    CLI::App program{"Drive at night, see and record what the eye does (docs/simulator.md).", "vesper-drive"};
    vesper::add_help(program);
    program.set_version_flag("--version", VESPER_VERSION);
    vesper::add_drive(program);
    return vesper::run_program(program, argc, argv);
}
