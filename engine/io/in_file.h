// Errors of functions that know no file, with the file before them. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::io {

template <class Call>
auto in_file(const std::string& file, const Call& call) {
    try {
        return call();
    } catch (const OutOfHostMemory&) {
        throw;
    } catch (const Error& error) {
        throw Error(one_line(file) + ": " + error.what());
    }
}

}  // namespace vesper::io
