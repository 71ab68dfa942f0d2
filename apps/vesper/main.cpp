// The `vesper` program: convert a daytime database to photometry, render it at night. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "commands.h"
#include "gpu/device.h"

namespace {

// A CPU device builds tens of MiB of its own lists in every frame. glibc would give them back to the system after each, and
// have every page cleared again in the next: a twentieth of the frame.
void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 64 << 20);
    mallopt(M_MMAP_THRESHOLD, 32 << 20);  // setting the first fixes this at 128 KiB
#endif
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    CLI::App program{"What a driver sees at night, on the screen you have.", "vesper"};
    program.set_version_flag("--version", VESPER_VERSION);
    program.require_subcommand(1);
    program.footer("Example:\n"
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
    CLI::App* devices = program.add_subcommand("devices", "List the Vulkan devices of this machine");
    devices->callback([] {
        for (const std::string& line : vesper::list_devices()) std::puts(line.c_str());
    });
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
        std::string message = error.what();
        std::replace(message.begin(), message.end(), '\n', ' ');
        std::fprintf(stderr, "vesper: %s (--help shows what is possible)\n", message.c_str());
        return vesper::kBadInput;
    } catch (const vesper::Error& error) {
        std::fprintf(stderr, "vesper: %s\n", error.what());
        return vesper::kBadInput;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "vesper: out of memory\n");
        return vesper::kBadInput;
    }
    return 0;
}
