// Ends of the rays of light transport. SPDX-License-Identifier: MIT
#pragma once

namespace vesper::transport {

/// Where rays start before a surface, m: points on it are rounded, and what touches it does not hide it.
constexpr double kSkin = 1e-4;
/// How far rays look for a surface, m; beyond is the sky.
constexpr double kReach = 1e5;

}  // namespace vesper::transport
