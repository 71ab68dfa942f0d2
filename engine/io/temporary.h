// Temporary files that have a name. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "io/descriptor.h"

namespace vesper::io {

/// The name of a temporary file, removed with this object or by remove_temporaries(). It is random: it follows no link
/// and nobody can take it before.
class Temporary {
public:
    /// Makes an empty file in a folder and opens it; see error() where that fails.
    explicit Temporary(const std::filesystem::path& folder);
    /// Gives an open, unnamed file a name in a folder.
    Temporary(const std::filesystem::path& folder, const Descriptor& unnamed);
    ~Temporary();
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    int error() const { return error_; }  ///< 0 or an error code
    Descriptor take() { return std::move(opened_); }
    /// Returns 0 or the error code.
    int rename_to(const std::filesystem::path& target);

private:
    /// Takes the first random name that `make` gives a file to; `make` returns false and sets errno where it cannot.
    void name(const std::filesystem::path& folder, const std::function<bool(const char*)>& make);
    void keep(const std::filesystem::path& name);

    std::string name_;
    Descriptor opened_;
    int error_ = 0, slot_ = -1;
};

/// Removes the files of all Temporary objects of the program. For handlers of signals that end it: calls only functions
/// that are safe in them.
void remove_temporaries() noexcept;

}  // namespace vesper::io
