// Radiosity that is kept from run to run. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cache.h"
#include "transport/radiosity.h"

namespace vesper::transport {

/// Of all that gather_radiosity() depends on.
Digest::Value radiosity_key(const scene::Scene& scene, std::span<const glm::dmat4> world,
                            const std::vector<bool>& moving, const RadiositySettings& settings);

std::optional<Radiosity> read_radiosity(Cache& cache, const Digest::Value& key);
/// Returns a line if the cache failed.
std::string write_radiosity(Cache& cache, const Digest::Value& key, const Radiosity& radiosity);

/// What the cache (null: none) has, or gather_radiosity(), which is then kept; `problem`: why it is not.
std::optional<Radiosity> kept_or_gathered(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                          const std::vector<bool>& moving, const RadiositySettings& settings,
                                          Cache* cache, const std::function<bool(double)>& progress,
                                          std::string* problem = nullptr);

}  // namespace vesper::transport
