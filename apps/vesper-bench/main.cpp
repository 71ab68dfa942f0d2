// The `vesper-bench` program: how fast is it here? SPDX-License-Identifier: MIT
#include "bench.h"
#include "help.h"
#include "program.h"

int main(int argc, char** argv) {
    CLI::App program{"Measures how fast Vesper is on this machine (docs/benchmark.md).", "vesper-bench"};
    vesper::add_help(program);
    program.set_version_flag("--version", VESPER_VERSION);
    vesper::add_bench(program);
    return vesper::run_program(program, argc, argv);
}
