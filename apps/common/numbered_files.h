// Files with a number in their name: frame.%04d.exr. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vesper::apps {

/// A name with one number in it.
struct NumberedName {
    std::string before, after;
    unsigned digits = 1;  ///< at least so many

    std::string at(unsigned number) const;
};
/// Takes a name with %d or %04d apart; none if there is no % in it. Throws Error where another thing follows the %.
std::optional<NumberedName> numbered_name(const std::string& option, const std::string& name);

struct NumberedFile {
    unsigned number = 0;
    std::string file;
};
/// The number that a file has by its name, whatever its folder; none: it is not of that name.
std::optional<unsigned> number_in(const NumberedName&, const std::string& file);
/// The files that exist of a name, ascending by number.
std::vector<NumberedFile> existing_files(const NumberedName&);
/// The same. Throws Error if there are none.
std::vector<NumberedFile> numbered_files(const NumberedName&);

}  // namespace vesper::apps
