// SPDX-License-Identifier: BSD-3-Clause
// A map as bytes. What was described is not stored but described again: the same points and
// parameters give the same bits (describe.h).
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "blob.h"
#include "map_state.h"
#include "mrpt_terrain/core/tile_state.h"
#include "mrpt_terrain/params/ini.h"

IMPLEMENTS_SERIALIZABLE(CTerrainMap, mrpt::maps::CMetricMap, mrpt_terrain)

namespace mrpt_terrain {
namespace {

constexpr std::array<char, 8> kMagic{'T', 'E', 'R', 'R', 'A', 'I', 'N', '\n'};
/// Of format 1 the checksum did not cover MRPT's generic parameters. Since format 3, maps in field
/// mode store the things that they remember.
constexpr std::uint32_t kFormat = 3;
const std::string kPrefix = "map";

/// Of MRPT's parameters of all maps, and the bytes of a map. The parameters stand before the bytes,
/// as MRPT stores them.
std::uint32_t checksum_of(const mrpt::maps::TMapGenericParams& generic, std::uint32_t format,
                          const std::string& bytes) {
  const std::array<Bytef, 3> flags{generic.enableSaveAs3DObject,
                                   generic.enableObservationLikelihood,
                                   generic.enableObservationInsertion};
  uLong sum = crc32(0L, Z_NULL, 0);
  if (format >= 2) sum = crc32(sum, flags.data(), static_cast<uInt>(flags.size()));
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t n = std::min<std::size_t>(bytes.size() - begin, 1U << 30U);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(bytes.data() + begin), static_cast<uInt>(n));
    begin += n;
  }
  return static_cast<std::uint32_t>(sum);
}

std::string text_of(const MapParams& params) {
  MapParams copy = params;
  return params::ini_text(map_sections(kPrefix, copy));
}

MapParams params_of(const std::string& text) {
  mrpt::config::CConfigFileMemory config;
  config.setContent(text);
  MapParams params;
  load_stored_map_params(config, kPrefix, params);
  return params;
}

void put_pose(const Eigen::Isometry3d& T, BlobWriter& blob) {
  for (int k = 0; k < 16; ++k) blob.put(T.matrix()(k / 4, k % 4));
}

Eigen::Isometry3d get_pose(BlobReader& blob) {
  Eigen::Isometry3d T;
  for (int k = 0; k < 16; ++k) T.matrix()(k / 4, k % 4) = blob.get<double>();
  if (!T.matrix().allFinite()) throw std::runtime_error("a pose in it is not finite");
  return T;
}

// Field by field: the struct has padding, whose bytes mean nothing.
template <class Self, class Visit>
void visit_bin(Self& bin, Visit&& visit) {
  visit(bin.last_seen);
  visit(bin.layer);
  visit(bin.count);
  for (auto* value : {&bin.z_min, &bin.z_max, &bin.mean_x, &bin.mean_y, &bin.mean_z, &bin.m_xx,
                      &bin.m_xy, &bin.m_xz, &bin.m_yy, &bin.m_yz, &bin.m_zz}) {
    visit(*value);
  }
  visit(bin.scans);
  visit(bin.freed);
}

void put_bin(const HeightBin& bin, BlobWriter& blob) {
  visit_bin(bin, [&blob](const auto& value) { blob.put(value); });
}

HeightBin get_bin(BlobReader& blob) {
  HeightBin bin;
  visit_bin(bin, [&blob](auto& value) { value = blob.get<std::decay_t<decltype(value)>>(); });
  return bin;
}

void put_scan(const TerrainSnapshot& snapshot, BlobWriter& blob) {
  blob.put(snapshot.stamp);
  put_pose(snapshot.T_map_robot, blob);
  for (const auto* axis : {&snapshot.points.x, &snapshot.points.y, &snapshot.points.z}) {
    blob.put_all(*axis);
  }
  blob.put_all(snapshot.ray_origins);
  blob.put_all(snapshot.origin_of);
}

Eigen::Isometry3d get_scan(BlobReader& blob, io::Scan& scan) {
  scan.stamp = blob.get<double>();
  const Eigen::Isometry3d T_map_robot = get_pose(blob);
  for (auto* axis : {&scan.points.x, &scan.points.y, &scan.points.z}) blob.get_all(*axis);
  blob.get_all(scan.ray_origins);
  blob.get_all(scan.origin_of);
  const std::size_t n = scan.points.size();
  const auto known = [&](std::uint32_t k) { return k < scan.ray_origins.size(); };
  if (scan.points.y.size() != n || scan.points.z.size() != n ||
      (!scan.origin_of.empty() && scan.origin_of.size() != n) ||
      !std::all_of(scan.origin_of.begin(), scan.origin_of.end(), known)) {
    throw std::runtime_error("the arrays of its scan do not fit together");
  }
  return T_map_robot;
}

void put_tiles(const FusedSnapshot& fused, BlobWriter& blob) {
  blob.put(fused.window);
  blob.put(fused.time);
  blob.put(fused.scans);
  std::uint64_t tiles = 0;
  fused.tiles.for_each([&](TileIndex, const Tile&) { ++tiles; });
  blob.put(tiles);
  TileState state;
  fused.tiles.for_each([&](TileIndex index, const Tile& tile) {
    save_tile(index, tile, state);
    blob.put(state.tile);
    blob.put(static_cast<std::uint64_t>(state.cells.size()));
    for (const TileState::Cell& cell : state.cells) {
      blob.put(cell.place);
      blob.put(cell.bins);
      blob.put(cell.free);
    }
    blob.put(static_cast<std::uint64_t>(state.bins.size()));
    for (const HeightBin& bin : state.bins) put_bin(bin, blob);
  });
}

void get_tile(BlobReader& blob, TileState& state) {
  state.tile = blob.get<TileIndex>();
  state.cells.clear();
  state.bins.clear();
  for (auto n = blob.get<std::uint64_t>(); n > 0; --n) {
    TileState::Cell& cell = state.cells.emplace_back();
    cell.place = blob.get<std::uint8_t>();
    cell.bins = blob.get<std::uint16_t>();
    cell.free = blob.get<LayerSpan>();
  }
  for (auto n = blob.get<std::uint64_t>(); n > 0; --n) state.bins.push_back(get_bin(blob));
}

void get_tiles(BlobReader& blob, FusedGrid& grid) {
  const auto window = blob.get<MapCellRect>();
  const auto time = blob.get<double>();
  const auto scans = blob.get<std::uint64_t>();
  TileState state;
  for (auto tiles = blob.get<std::uint64_t>(); tiles > 0; --tiles) {
    get_tile(blob, state);
    const RestoreStatus status = restore_tile(state, grid);
    if (status != RestoreStatus::kOk) {
      throw std::runtime_error(std::string("a tile in it is wrong: ") + name_of(status));
    }
  }
  restore_progress(window, time, scans, grid);
}

std::vector<std::uint64_t> identities_of(const TerrainSnapshot& snapshot) {
  std::vector<std::uint64_t> identities;
  for (const ClusterView& cluster : snapshot.clusters) identities.push_back(cluster.identity);
  return identities;
}

bool has_tracker(const MapParams& params) {
  return params.description.description.mode == DescriptionMode::kField;
}

// Field by field: the structs have padding.
void put_tracks(const std::vector<ThingTracker::Track>& tracks, BlobWriter& blob) {
  blob.put(static_cast<std::uint64_t>(tracks.size()));
  for (const ThingTracker::Track& track : tracks) {
    blob.put(track.identity);
    blob.put(track.seen);
    for (const double value : {track.box.centre.x, track.box.centre.y, track.box.yaw,
                               track.box.length, track.box.width}) {
      blob.put(value);
    }
    blob.put(track.box.low);
    blob.put(track.box.high);
  }
}

void get_tracks(BlobReader& blob, ThingTracker::State& tracker) {
  std::uint64_t last = 0;
  for (auto n = blob.get<std::uint64_t>(); n > 0; --n) {
    ThingTracker::Track& track = tracker.tracks.emplace_back();
    track.identity = blob.get<std::uint64_t>();
    track.seen = blob.get<double>();
    bool finite = std::isfinite(track.seen);
    for (double* value : {&track.box.centre.x, &track.box.centre.y, &track.box.yaw,
                          &track.box.length, &track.box.width}) {
      *value = blob.get<double>();
      finite = finite && std::isfinite(*value);
    }
    track.box.low = blob.get<float>();
    track.box.high = blob.get<float>();
    if (track.identity <= last || track.identity >= tracker.next || !finite) {
      throw std::runtime_error("the things that it remembers are wrong");
    }
    last = track.identity;
  }
}

/// What the tracker of an older map would remember: the things of its last scan.
void add_tracks_of(const TerrainSnapshot& snapshot, const std::vector<std::uint64_t>& identities,
                   double time, ThingTracker::State& tracker) {
  for (std::size_t k = 0; k < identities.size(); ++k) {
    const OrientedBox box = moved(snapshot.description.things[k].box, snapshot.T_map_window);
    tracker.tracks.push_back({identities[k], box, time});
  }
  std::sort(tracker.tracks.begin(), tracker.tracks.end(),
            [](const auto& a, const auto& b) { return a.identity < b.identity; });
}

/// Field mode: identities of the things of a snapshot that was described again, and the tracker.
void restore_things(BlobReader& blob, std::uint32_t format, MapWriter& writer,
                    TerrainSnapshot& snapshot) {
  std::vector<std::uint64_t> identities;
  blob.get_all(identities);
  // A later version of the description may find other things in the same scan.
  const bool same = identities.size() == snapshot.description.things.size();
  ThingTracker::State tracker{writer.next_identity, {}};
  if (format >= 3) {
    get_tracks(blob, tracker);
  } else if (same) {
    add_tracks_of(snapshot, identities, writer.time, tracker);
  }
  writer.tracker.restore(std::move(tracker));
  snapshot.list_clusters();
  snapshot.set_identities(same ? identities
                               : writer.tracker.update(snapshot.description.things,
                                                       snapshot.T_map_window, writer.time));
}

/// Paper mode: identities of the clusters of a snapshot that was described again.
void restore_clusters(BlobReader& blob, MapWriter& writer, TerrainSnapshot& snapshot) {
  const std::uint64_t next_identity = writer.next_identity;
  snapshot.name_clusters(nullptr, writer.next_identity);
  std::vector<std::uint64_t> identities;
  blob.get_all(identities);
  // A later version of the description may find other clusters in the same scan: they are new.
  if (identities.size() != snapshot.clusters.size()) return;
  for (std::size_t k = 0; k < identities.size(); ++k) snapshot.clusters[k].identity = identities[k];
  writer.next_identity = next_identity;
}

std::string read_bytes(mrpt::serialization::CArchive& in, std::uint64_t n) {
  // Piece by piece: a damaged length must not ask for more memory than the file has bytes.
  constexpr std::uint64_t kPiece = 1U << 20U;
  std::string bytes;
  while (bytes.size() < n) {
    const std::size_t begin = bytes.size();
    const auto piece = static_cast<std::size_t>(std::min(kPiece, n - begin));
    bytes.resize(begin + piece);
    if (in.ReadBuffer(bytes.data() + begin, piece) != piece) {
      throw std::runtime_error("terrain map: it is cut off");
    }
  }
  return bytes;
}

}  // namespace

std::string CTerrainMap::State::bytes() const {
  BlobWriter blob;
  blob.put_text(text_of(params));
  TerrainSnapshotPtr now;
  std::shared_ptr<const octomap::OcTree> tree;
  ThingTracker::State tracker;
  const bool tracked = has_tracker(params);
  {
    // What belongs together is taken together; writing it down needs no lock.
    const std::lock_guard lock(writing);
    now = snapshot();
    if (octree) tree = octree->copy();
    blob.put(now->revision);
    if (tracked) tracker = writer.tracker.state();
    blob.put(tracked ? tracker.next : writer.next_identity);
    blob.put(writer.time);
  }
  if (now->revision != 0) {
    if (params.creation.fusion == Fusion::kRolling) put_tiles(now->fused, blob);
    put_scan(*now, blob);
    blob.put_all(identities_of(*now));
    if (tracked) put_tracks(tracker.tracks, blob);
  }
  if (tree) blob.put_text(OctreeHalf::bytes_of(*tree));
  return blob.bytes();
}

std::unique_ptr<CTerrainMap::State> CTerrainMap::State::from_bytes(const std::string& bytes,
                                                                   std::uint32_t format) {
  BlobReader blob(bytes);
  auto state = std::make_unique<State>(params_of(blob.get_text()));
  const auto revision = blob.get<std::uint64_t>();
  MapWriter& writer = state->writer;
  const bool tracked = has_tracker(state->params);
  writer.next_identity = blob.get<std::uint64_t>();
  if (tracked) writer.tracker.restore({writer.next_identity, {}});
  writer.time = blob.get<double>();
  if (revision != 0) {
    if (writer.fusion) get_tiles(blob, writer.fusion->grid);
    io::Scan scan;
    const Eigen::Isometry3d T_map_robot = get_scan(blob, scan);
    const auto next = describe_scan(scan, T_map_robot, writer.time, state->params, writer);
    next->revision = revision;
    if (tracked) {
      restore_things(blob, format, writer, *next);
    } else {
      restore_clusters(blob, writer, *next);
    }
    state->publish(next);
  }
  if (state->octree) state->octree->restore(blob.get_text());
  if (!blob.at_end()) throw std::runtime_error("there is more in it than a map");
  return state;
}

uint8_t CTerrainMap::serializeGetVersion() const { return 0; }

void CTerrainMap::serializeTo(mrpt::serialization::CArchive& out) const {
  const std::string bytes = state_->bytes();
  out << genericMapParams;
  out.WriteBuffer(kMagic.data(), kMagic.size());
  out << kFormat << static_cast<std::uint64_t>(bytes.size())
      << checksum_of(genericMapParams, kFormat, bytes);
  if (!bytes.empty()) out.WriteBuffer(bytes.data(), bytes.size());
}

void CTerrainMap::serializeFrom(mrpt::serialization::CArchive& in, uint8_t version) {
  if (version != 0) {
    throw std::runtime_error("terrain map: written by a later version of this class (" +
                             std::to_string(version) + "), which this one cannot read");
  }
  mrpt::maps::TMapGenericParams generic;
  in >> generic;
  std::array<char, 8> magic{};
  in.ReadBuffer(magic.data(), magic.size());
  if (magic != kMagic) throw std::runtime_error("terrain map: these bytes are no terrain map");
  std::uint32_t format = 0, checksum = 0;
  std::uint64_t size = 0;
  in >> format >> size >> checksum;
  if (format < 1 || format > kFormat) {
    throw std::runtime_error("terrain map: format " + std::to_string(format) +
                             " is unknown; this version reads 1 to " + std::to_string(kFormat));
  }
  const std::string bytes = read_bytes(in, size);
  if (checksum_of(generic, format, bytes) != checksum) {
    throw std::runtime_error("terrain map: it is damaged (the checksum is wrong)");
  }
  try {
    state_ = State::from_bytes(bytes, format);
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("terrain map: ") + error.what());
  }
  genericMapParams = generic;
}

}  // namespace mrpt_terrain
