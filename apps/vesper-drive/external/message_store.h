// Messages of a live source, for as long as its drive may still be recorded. SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "io/growing_file.h"
#include "osi/message.h"

namespace vesper::drive {

/// Keeps what it is given in a temporary file, which nobody else sees, and from open() on also in that trace. At most
/// as much as a trace may have.
class MessageStore {
public:
    /// False: it cannot be kept, and no more will be; open() says why.
    bool add(const osi::Message&);
    /// Throws Error, also where something could not be kept.
    void open(const std::filesystem::path& trace);
    void close();
    const std::string& problem() const { return problem_; }

private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void keep(const std::string& bytes);

    std::unique_ptr<std::FILE, Closer> all_;  // made when first needed
    uint64_t bytes_ = 0;
    std::string problem_;
    std::unique_ptr<io::GrowingFile> trace_;
};

}  // namespace vesper::drive
