// The folder that keeps results for later runs, as commands take it. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "arguments/command_line.h"

#include "base/cache.h"

namespace vesper::apps {

/// --cache: a folder, or off; empty: see cache_of(). `default_words` says the default.
void add_cache_option(Command, std::string& asked,
                      const std::string& default_words = "VESPER_CACHE, or vesper in XDG_CACHE_HOME or ~/.cache");
/// Where shadow maps and light between surfaces are kept from run to run: as `asked` with --cache, else as VESPER_CACHE
/// says, else in the folder for caches of the user. Null with "off", or where no folder is known.
std::shared_ptr<Cache> cache_of(const std::string& asked);
/// Says on standard error why nothing is kept any more, if there is a reason.
void print_cache_note(const std::string& problem);

}  // namespace vesper::apps
