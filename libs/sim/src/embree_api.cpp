// SPDX-License-Identifier: BSD-3-Clause
#include "embree_api.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace mrpt_terrain::sim {
namespace {

[[noreturn]] void fail(RTCDevice device, const std::string& what) {
  const RTCError code = rtcGetDeviceError(device);
  throw std::runtime_error("Embree: " + what + " (error " + std::to_string(code) + ")");
}

/// The device of the process; never released, because static objects may outlive it.
RTCDevice device() {
  static const RTCDevice instance = [] {
    // The oldest instruction set, so that all machines of an architecture find the same triangles.
    const RTCDevice created = rtcNewDevice("threads=1,verbose=0,isa=sse2");
    if (created == nullptr) fail(nullptr, "no device");
    return created;
  }();
  return instance;
}

/// Copies an array into a buffer that Embree owns and pads.
template <class Element>
void fill(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
          const std::vector<Element>& from) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), from.size());
  if (buffer == nullptr) fail(device(), "no memory for " + std::to_string(from.size()) + " items");
  std::copy(from.begin(), from.end(), static_cast<Element*>(buffer));
}

}  // namespace

EmbreeScene::EmbreeScene(const std::vector<std::array<float, 3>>& vertices,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles)
    : scene_(rtcNewScene(device())) {
  if (scene_ == nullptr) fail(device(), "no scene");
#if RTC_VERSION_MAJOR >= 4
  constexpr auto kFilter = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
  constexpr auto kFilter = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST | kFilter);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  if (!triangles.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices);
    fill(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device()) != RTC_ERROR_NONE) throw std::runtime_error("Embree: no tree");
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

}  // namespace mrpt_terrain::sim
