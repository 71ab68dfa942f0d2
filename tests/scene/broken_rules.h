// What a glTF file is said to break, for tests of the rules. SPDX-License-Identifier: MIT
#pragma once

#include "scene/scene_files.h"

namespace vesper::test {

/// The notes of rules that a file breaks, without what they all begin with.
inline std::vector<std::string> broken(const nlohmann::json& root) {
    const std::string begins = "breaks a rule of glTF 2.0";
    GltfFile file;
    file.root = root;
    std::vector<std::string> rules;
    for (const std::string& note : file.read().notes)
        if (note.starts_with(begins)) rules.push_back(note.substr(note.find(": ") + 2));
    return rules;
}

/// Puts each fault alone into a file that keeps all rules, or takes out what it names where its value is null: one note says so.
inline void expect_broken(const nlohmann::json& sound, const std::vector<Fault>& faults, size_t most_notes = 1) {
    EXPECT_EQ(broken(sound), std::vector<std::string>{});
    for (const Fault& fault : faults) {
        nlohmann::json root = sound;
        if (fault.value.is_null())
            root = root.patch({{{"op", "remove"}, {"path", fault.pointer}}});
        else
            root[nlohmann::json::json_pointer(fault.pointer)] = fault.value;
        const std::vector<std::string> rules = broken(root);
        EXPECT_TRUE(mentions(rules, fault.place)) << fault.pointer << " = " << fault.value << ": " << nlohmann::json(rules);
        EXPECT_LE(rules.size(), most_notes) << fault.pointer << ": " << nlohmann::json(rules);
    }
}

}  // namespace vesper::test
