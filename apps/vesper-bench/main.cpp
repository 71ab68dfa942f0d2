// The `vesper-bench` program: how fast is it here? SPDX-License-Identifier: MIT
#include "arguments/command_line.h"
#include "bench.h"

int main(int argc, char** argv) {
    vesper::apps::Program program{"Measures how fast Vesper is on this machine (docs/benchmark.md).", "vesper-bench"};
    program.version(VESPER_VERSION);
    vesper::bench::add_bench(program);
    return program.run(argc, argv);
}
