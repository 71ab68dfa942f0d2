// How many threads a program uses. SPDX-License-Identifier: MIT
#pragma once

#include "arguments/command_line.h"

namespace vesper::apps {

/// --threads: of a CPU device's driver and of the host's own loops; 0, as at first: see use_threads().
void add_thread_option(Command, unsigned& threads);
/// To be called before a device is opened and a thread is started. Sets the variables of wanted_threads().
void use_threads(unsigned asked);

/// Numbers for VESPER_THREADS, of loops of the host, and LP_NUM_THREADS, of the driver; 0: the variable stays.
struct WantedThreads {
    unsigned host = 0, driver = 0;
};
/// As `asked` says; else as that variable says, else as the other one does; else one for each of the processors that
/// this process may use, over the number of ranks on this machine. Where these are not known the driver has its own
/// way. `host` and `driver`: texts of the variables, or null; `ranks`: 0: unknown.
WantedThreads wanted_threads(unsigned asked, const char* host, const char* driver, unsigned processors, unsigned ranks);

}  // namespace vesper::apps
