// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/fused_tile.h"

namespace mrpt_terrain {

Moments moments_of(const HeightBin& bin, const MapLattice& lattice) {
  Moments m;
  m.n = bin.count;
  m.mean_x = bin.mean_x;
  m.mean_y = bin.mean_y;
  m.mean_z = lattice.bottom_of(bin.layer) + double{bin.mean_z};
  m.m_xx = bin.m_xx;
  m.m_xy = bin.m_xy;
  m.m_xz = bin.m_xz;
  m.m_yy = bin.m_yy;
  m.m_yz = bin.m_yz;
  m.m_zz = bin.m_zz;
  return m;
}

}  // namespace mrpt_terrain
