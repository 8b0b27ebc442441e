// The few places where Embree 3 (Debian 12) and Embree 4 (Debian 13) differ.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <memory>

#include "reference/ray_tracer.hpp"

namespace reference::embree {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;
using Geometry = std::unique_ptr<RTCGeometryTy, Release>;

#if RTC_VERSION_MAJOR >= 4

using Context = RTCRayQueryContext;

/// Embree's context, followed by what the filter functions of a closest-hit query want to know.
struct Query {
  Context context;
  Faces faces;
  explicit Query(Faces faces_of_query) : faces(faces_of_query) { rtcInitRayQueryContext(&context); }
};

inline void intersect(RTCScene scene, Query& query, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  rtcIntersect1(scene, &ray, &arguments);
}

inline void occluded(const int* valid, RTCScene scene, Query& query, RTCRay8& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &query.context;
  rtcOccluded8(valid, scene, &rays, &arguments);
}

#else

using Context = RTCIntersectContext;

struct Query {
  Context context;
  Faces faces;
  explicit Query(Faces faces_of_query) : faces(faces_of_query) { rtcInitIntersectContext(&context); }
};

inline void intersect(RTCScene scene, Query& query, RTCRayHit& ray) { rtcIntersect1(scene, &query.context, &ray); }

inline void occluded(const int* valid, RTCScene scene, Query& query, RTCRay8& rays) {
  query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, scene, &query.context, &rays);
}

#endif

}  // namespace reference::embree
