// Elements of a storyboard by name. SPDX-License-Identifier: MIT
#include "roads/storyboard_elements.h"

namespace vesper::roads {

static constexpr int kMostNames = 16;  // of a reference; a story has six below one another
namespace {

constexpr size_t kMaxElements = 20'000;

}  // namespace

size_t StoryElements::add(ElementKind kind, const XmlElement& element, const std::string& name, size_t above) {
    if (entries_.size() >= kMaxElements)
        element.fail("the storyboard has more than " + std::to_string(kMaxElements) + " elements");
    std::string path = above == kNone ? name : entries_[above].path + "::" + name;
    if (path.size() > StoryElements::kMaxPath)
        element.fail("its name and those around it are longer than " + std::to_string(StoryElements::kMaxPath));
    entries_.push_back({kind, std::move(path)});
    return entries_.size() - 1;
}

std::pair<size_t, size_t> StoryElements::find(ElementKind kind, std::string_view reference) {
    for (; entered_ < entries_.size(); ++entered_) {
        const Entry& entry = entries_[entered_];
        std::string_view end = entry.path;
        for (int names = 0; names < kMostNames; ++names) {
            Found& found = by_end_[{entry.kind, end}];
            if (found.count++ == 0) found.first = entered_;
            const size_t colon = end.find("::");
            if (colon == end.npos) break;
            end.remove_prefix(colon + 2);
        }
    }
    const auto found = by_end_.find({kind, reference});
    return found == by_end_.end() ? std::pair{kNone, size_t{0}} : std::pair{found->second.first, found->second.count};
}

}  // namespace vesper::roads
