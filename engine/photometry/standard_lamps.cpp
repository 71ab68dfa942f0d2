// The lamps that are built in. SPDX-License-Identifier: MIT
#include "photometry/standard_lamps.h"

#include <string_view>
#include <utility>

#include "base/error.h"
#include "photometry/grid.h"
#include "photometry/ies.h"

namespace vesper::photometry {
namespace {

/// Name and text of each file.
constexpr std::pair<std::string_view, std::string_view> kLamps[] = {
#include <photometry/lamps.inc>
};

}  // namespace

Distribution standard_lamp(const std::string& name) {
    for (const auto& [known, text] : kLamps) {
        if (known != name) continue;
        const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
        return text.starts_with("IES") ? parse_ies(bytes, name) : parse_grid_csv(bytes, name);
    }
    throw Error("there is no lamp '" + name + "': street-lamp, low-beam, high-beam and front-fog are built in");
}

}  // namespace vesper::photometry
