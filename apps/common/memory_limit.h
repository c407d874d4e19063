// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Lets the program have at most half of the machine's memory. Damaged files can announce objects
/// of many gigabytes; with the limit the allocation fails and is reported, and the machine goes on.
void limit_memory();
