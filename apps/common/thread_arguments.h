// How many threads a program uses. SPDX-License-Identifier: MIT
#pragma once

#include "command_line.h"

namespace vesper::apps {

/// --threads: of a CPU device's driver and of the host's own loops; 0, as at first: see use_threads().
void add_thread_option(Command, unsigned& threads);
/// To be called before a device is opened and a thread is started. `asked` 0: what LP_NUM_THREADS and VESPER_THREADS
/// say; without them one for each processor, divided by the number of ranks that share the machine.
void use_threads(unsigned asked);

}  // namespace vesper::apps
