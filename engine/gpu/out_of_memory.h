// What check() throws where memory of the host has run out. SPDX-License-Identifier: MIT
#pragma once

#include "base/error.h"

namespace vesper {

/// The driver found no memory of the host; nothing else is wrong.
struct OutOfHostMemory : Error {
    using Error::Error;
};

}  // namespace vesper
