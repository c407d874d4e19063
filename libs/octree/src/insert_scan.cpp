// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/octree/insert_scan.h"

#include <cassert>
#include <cmath>
#include <typeinfo>

#include "collect_cells.h"
#include "guard_cells.h"
#include "octomap_insertion.h"
#include "update_tree.h"

namespace mrpt_terrain::octree {

struct InsertionWorkspace::Memory {
  CollectionWorkspace collection;
};

InsertionWorkspace::InsertionWorkspace() : memory_(std::make_unique<Memory>()) {}
InsertionWorkspace::~InsertionWorkspace() = default;
InsertionWorkspace::InsertionWorkspace(InsertionWorkspace&&) noexcept = default;
InsertionWorkspace& InsertionWorkspace::operator=(InsertionWorkspace&&) noexcept = default;

bool is_supported(const octomap::OcTree& tree) {
  const bool has_finite_odds =
      std::isfinite(tree.getProbHitLog()) && std::isfinite(tree.getProbMissLog()) &&
      std::isfinite(tree.getClampingThresMinLog()) && std::isfinite(tree.getClampingThresMaxLog());
  return typeid(tree) == typeid(octomap::OcTree) && !tree.bbxSet() &&
         !tree.isChangeDetectionEnabled() && has_finite_odds;
}

InsertionResult insert_scan(const RayEnds& ends, const RayOrigins& origins,
                            const InsertionOptions& options, InsertionWorkspace& workspace,
                            octomap::OcTree& tree, std::vector<FreedCube>* freed, FreeCells* free) {
  assert(origins.origins != nullptr && origins.size > 0);
  if (freed != nullptr) freed->clear();
  if (!is_supported(tree)) {
    const InsertionResult result = insert_with_octomap(ends, origins, options, tree, free);
    if (free != nullptr) free->assign(tree);
    return result;
  }
  CollectionWorkspace& collection = workspace.memory().collection;
  InsertionResult result =
      collect_cells<Ties::kAsOctomap>(ends, origins, options, tree.getResolution(), collection);
  if (options.guarded != nullptr) {
    result.kept = guard_cells(*options.guarded, collection.cells, tree, free);
  }
  update_tree(collection.cells, tree, freed, free);
  return result;
}

}  // namespace mrpt_terrain::octree
