// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// All that the project knows of Embree, for versions 3 and 4.
namespace mrpt_terrain::sim {

/// Rays of one packet: the width of the oldest instruction set, which is the one in use.
inline constexpr std::size_t kPacket = 4;
using RayPacket = RTCRayHit4;
/// Primitive of a ray that met nothing.
inline constexpr std::uint32_t kNoTriangle = RTC_INVALID_GEOMETRY_ID;

/// Which rays of a packet count: -1 yes, 0 no.
struct alignas(16) ValidMask {
  std::array<int, kPacket> lanes{};
};

/// Triangles in single precision, ready for rays. Built by one thread, so that equal input gives
/// equal trees. Throws std::runtime_error with Embree's own message.
class EmbreeScene {
 public:
  EmbreeScene(const std::vector<std::array<float, 3>>& vertices,
              const std::vector<std::array<std::uint32_t, 3>>& triangles);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// First hits of the valid rays between tnear and tfar.
  void intersect(const ValidMask& valid, RayPacket& packet) const {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect4(valid.lanes.data(), scene_, &packet, &arguments);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect4(valid.lanes.data(), scene_, &context, &packet);
#endif
  }

 private:
  RTCScene scene_ = nullptr;
};

}  // namespace mrpt_terrain::sim
