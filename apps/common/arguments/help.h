// The pages of --help and --help-all: what most people need, and everything in groups. SPDX-License-Identifier: MIT
#pragma once

#include <memory>

namespace CLI {
class FormatterBase;
}

namespace vesper::apps {

/// --help lists the options of the first page (kFirstPage), each with the first line of its description; --help-all
/// lists all options by groups, with all lines.
std::shared_ptr<CLI::FormatterBase> help_pages();

}  // namespace vesper::apps
