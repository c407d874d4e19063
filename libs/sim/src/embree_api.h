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

  /// First hits of the valid rays between tnear and tfar. Which one of several equally far
  /// triangles is found depends on the processor.
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

  /// Visits every triangle that the valid rays meet between tnear and tfar, in an order that means
  /// nothing and some of them twice.
  /// \param visit called with lane, primitive and distance; must not throw
  template <class Visit>
  void for_all_hits(const ValidMask& valid, RayPacket& packet, Visit&& visit) const {
    for (std::size_t k = 0; k < kPacket; ++k) packet.ray.id[k] = static_cast<unsigned int>(k);
    Visitor<Visit> visitor{{}, visit};
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    rtcInitRayQueryContext(&visitor.context);
    arguments.context = &visitor.context;
    arguments.filter = &Visitor<Visit>::pass_on;
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcIntersect4(valid.lanes.data(), scene_, &packet, &arguments);
#else
    rtcInitIntersectContext(&visitor.context);
    visitor.context.filter = &Visitor<Visit>::pass_on;
    rtcIntersect4(valid.lanes.data(), scene_, &visitor.context, &packet);
#endif
  }

 private:
#if RTC_VERSION_MAJOR >= 4
  using Context = RTCRayQueryContext;
#else
  using Context = RTCIntersectContext;
#endif
  template <class Visit>
  struct Visitor {
    Context context;  // first, so that Embree's pointer to it is one to the visitor
    Visit& visit;

    /// Tells of the hits and rejects them all, so that the rays go on.
    static void pass_on(const RTCFilterFunctionNArguments* arguments) {
      const Visitor& self = *reinterpret_cast<const Visitor*>(arguments->context);
      for (unsigned int k = 0; k < arguments->N; ++k) {
        if (arguments->valid[k] == 0) continue;
        arguments->valid[k] = 0;
        self.visit(RTCRayN_id(arguments->ray, arguments->N, k),
                   RTCHitN_primID(arguments->hit, arguments->N, k),
                   RTCRayN_tfar(arguments->ray, arguments->N, k));
      }
    }
  };

  RTCScene scene_ = nullptr;
};

}  // namespace mrpt_terrain::sim
