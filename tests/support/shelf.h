// A cache in memory. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/cache.h"

namespace vesper::test {

class Shelf : public Cache {
public:
    std::map<Digest::Value, std::vector<std::byte>> kept;
    bool full = false;

    uint64_t bytes(const Digest::Value& key) override {
        const auto found = kept.find(key);
        return found == kept.end() ? 0 : found->second.size();
    }
    bool read(const Digest::Value& key, std::span<std::byte> bytes) override {
        const auto found = kept.find(key);
        if (found == kept.end() || found->second.size() != bytes.size()) return false;
        std::ranges::copy(found->second, bytes.begin());
        return true;
    }
    bool writes() const override { return !full; }
    void write(const Digest::Value& key, std::span<const std::byte> bytes) override {
        kept[key].assign(bytes.begin(), bytes.end());
    }
    std::string settle() override { return full ? "full" : ""; }
};

}  // namespace vesper::test
