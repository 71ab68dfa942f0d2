// The exceptions of the library. SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace vesper {

/// Thrown for everything that can go wrong outside the program itself: a file, a device, a declaration. The message is
/// one line that names the file, pass or resource, the place in it, and the reason. The library never prints or exits.
class Error : public std::runtime_error {
public:
    explicit Error(const std::string& message) : std::runtime_error(message) {}
};

/// There was no memory of the host for a file, or for the driver.
struct OutOfHostMemory : Error {
    using Error::Error;
};

}  // namespace vesper
