// Patterns for names that differ by a number. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace vesper::scene {

/// A name with '*' for each number in it: "lamp_01" and "lamp_40" are "lamp_*".
std::string without_numbers(const std::string& name);
/// The same without a number behind a point at the end, which editors add to copies, and with '*' for left and right:
/// "lamp" and "lamp.001" are alike, "headlamp_left" and "headlamp_right" too.
std::string family_of(const std::string& name);

/// Names, to find those that patterns match.
class NameIndex {
public:
    /// `scene`: names of nodes, with those above them. Without it: of other things, alone.
    explicit NameIndex(std::vector<std::string> names, const Scene* scene = nullptr);
    /// Numbers of all things that one of the patterns matches, ascending.
    std::vector<uint32_t> matched(const std::vector<std::string>& patterns) const;
    /// Names that were compared so far: a pattern that begins with a wildcard is compared with all.
    size_t compared() const { return compared_; }

private:
    void add_range(const std::string& prefix, const std::string& pattern, std::vector<uint32_t>& found) const;

    std::vector<std::string> names_;
    const Scene* scene_;
    std::vector<uint32_t> order_;  ///< by name
    mutable size_t compared_ = 0;
};

/// Patterns, few if possible, that match these members and nothing that is not one of them; by numbers as '*', as one
/// '?' for each digit, else the names themselves. Empty where that takes more than some dozens, or after too many
/// comparisons. `names[i]` is the text to match member i by: a name, or a path.
std::vector<std::string> patterns_for(const NameIndex& index, const std::vector<uint32_t>& members,
                                      const std::vector<std::string>& texts);

}  // namespace vesper::scene
