// A folder of files that spare work in later runs. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "base/cache.h"

namespace vesper::io {

/// One file for each digest, 32 hexadecimal digits and ".vesper-map". A file that is damaged, is of another kind, or
/// leads elsewhere by a link, counts as none and is replaced. Files appear complete, and several programs may use a
/// folder at the same time. After the first failure nothing more is written.
/// Only this user is trusted: a folder and files that others own or may write count as none, with one note each, and
/// files are sealed with a secret number of the folder (kSecretName), so that a digest made elsewhere fits none.
class CacheFolder : public Cache {
public:
    static constexpr const char* kSecretName = ".vesper-secret";
    static constexpr uint64_t kMostBytes = uint64_t{1} << 30u;  ///< of all files

    /// The folder need not exist: it is made when something is written. Files that were used longest ago are removed
    /// until all take at most `most_bytes`; what programs write meanwhile may exceed that by a sixteenth each.
    explicit CacheFolder(std::filesystem::path folder, uint64_t most_bytes = kMostBytes)
        : folder_(std::move(folder)), most_bytes_(most_bytes) {}

    /// Makes the folder. Throws Error if nothing can be written there, or others may write there.
    void make() const;

    uint64_t bytes(const Digest::Value& key) override;
    bool read(const Digest::Value& key, std::span<std::byte> bytes) override;
    bool writes() const override { return problem_.empty(); }
    void write(const Digest::Value& key, std::span<const std::byte> bytes) override;
    std::string settle() override;

private:
    using Secret = std::array<std::byte, 32>;
    struct Opened;
    bool is_trusted();  // the folder, or there is none
    std::optional<Opened> open(const Digest::Value& key);
    std::optional<Secret> secret() const;
    int make_secret(Secret& made) const;  // returns 0 or the error code
    std::filesystem::path file_of(const Digest::Value& key) const;
    int write_file(const Digest::Value& key, std::span<const std::byte> bytes) const;
    void remove_oldest();

    std::filesystem::path folder_;
    uint64_t most_bytes_;
    std::optional<uint64_t> found_bytes_;  // of all files, when they were last counted
    uint64_t written_bytes_ = 0;           // since
    std::string problem_;
    std::string note_;  // of a file that is not trusted
    bool told_ = false, noted_ = false;
};

}  // namespace vesper::io
