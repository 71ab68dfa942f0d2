#include "program.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {
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

/// Whether all that was printed has got where it goes; says otherwise on standard error.
bool output_ended(const std::string& program) {
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return true;
    std::fprintf(stderr, "%s: standard output: %s\n", program.c_str(), std::strerror(errno));
    return false;
}

}  // namespace

int run_program(CLI::App& program, int argc, char** argv) {
    keep_freed_memory();
    const std::string name = program.get_name();
    try {
        program.parse(argc, argv);
        if (!output_ended(name)) return kBadInput;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // --help, --version
            program.exit(error);
            return output_ended(name) ? 0 : kBadInput;
        }
        std::string message = error.what();
        // What is missing may be missing only because this was meant for it.
        const std::vector<std::string> unknown = program.remaining(true);
        if (error.get_name() == "RequiredError" && !unknown.empty()) message = "there is no " + unknown.front();
        std::replace(message.begin(), message.end(), '\n', ' ');
        std::fprintf(stderr, "%s: %s (--help shows what is possible)\n", name.c_str(), one_line(message, 1000).c_str());
        return kBadInput;
    } catch (const Error& error) {
        std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
        return kBadInput;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "%s: out of memory\n", name.c_str());
        return kBadInput;
    }
    return 0;
}

}  // namespace vesper
