// Which emitters a part of a scene sees, learned on the way. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace vesper::transport {

/// Of each group of emitters, about the part of looks that will see it from the next of some cells beside each other:
/// from the looks of those before, the last of which count most. Looks by these shares have no bias, since each counts
/// by how likely it was when it was taken.
class Sight {
public:
    explicit Sight(size_t groups) : of_all_(groups), of_last_(groups), shares_(groups, kUnknown) {}

    std::span<const float> shares() const { return shares_; }
    /// Of a look.
    void add(size_t group, bool seen) { of_last_[group].looks += 1, of_last_[group].seen += seen ? 1.0f : 0.0f; }
    void end_cell() {
        if (++cells_ % kFadesAfter != 0) return;
        for (size_t g = 0; g < shares_.size(); ++g) {
            Count& all = of_all_[g];
            Recent& last = of_last_[g];
            all.looks += last.looks - last.counted.looks, all.seen += last.seen - last.counted.seen;
            const float usual = (kUnknown + all.seen) / (1 + all.looks);
            shares_[g] = std::max((usual + last.seen) / (1 + last.looks), kLeast);
            last.looks *= kFade, last.seen *= kFade;
            last.counted = last;
        }
    }

private:
    static constexpr float kUnknown = 0.25f;    // before any look
    static constexpr float kLeast = 0.01f;      // so that what comes into sight is found soon
    static constexpr uint32_t kFadesAfter = 2;  // cells
    static constexpr float kFade = 0.85f;
    struct Count {
        float looks = 0, seen = 0;
    };
    struct Recent : Count {
        Count counted;  // of it, in those of all
    };
    std::vector<Count> of_all_;
    std::vector<Recent> of_last_;
    std::vector<float> shares_;
    uint32_t cells_ = 0;
};

}  // namespace vesper::transport
