// Obstacles that are watched: how visible they are, in numbers. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "arguments/command_line.h"

#include "render/seen_obstacles.h"
#include "render/tone_chain.h"

namespace vesper::apps {

/// --obstacle, which may be repeated, under the help group that is begun.
void add_obstacle_option(Command, std::vector<std::string>& patterns);

/// The obstacles of a scene that the option names. Throws Error, also for an operator without luminances.
std::vector<scene::Obstacle> obstacles_of(const scene::Scene&, const std::vector<std::string>& patterns,
                                          const render::ToneChainSettings&);

/// Columns of a log, each with a leading comma, NAME:OBSTACLE, and their values. Values that are not known are empty,
/// as are all of a frame that has no obstacles.
std::string obstacle_columns(std::span<const scene::Obstacle>);
std::string obstacle_values(std::span<const scene::Obstacle>, std::span<const render::SeenObstacle>,
                            const render::ToneChainSettings&);
/// Whether a text is the columns of some obstacles, or of none.
bool are_obstacle_columns(const std::string&);

/// A line for each.
std::string obstacle_lines(std::span<const scene::Obstacle>, std::span<const render::SeenObstacle>,
                           const render::ToneChainSettings&);

/// A name as part of a field of a CSV file: what parts fields is left out.
std::string csv_name(std::string name);

}  // namespace vesper::apps
