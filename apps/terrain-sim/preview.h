// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "simulation.h"

/// Draws the scene from above with its things, the path of the robot and where it starts. Throws
/// std::runtime_error if the picture cannot be written.
void write_preview(const std::string& file, const Simulation& simulation);
