/* Embree 3's own streams; `width` is not for them. */
#include "plain_c.h"

static struct RTCRayNp ray_pointers(const struct Rays *rays) {
  struct RTCRayNp pointers = {
      .org_x = rays->origin[0],    .org_y = rays->origin[1],    .org_z = rays->origin[2],
      .dir_x = rays->direction[0], .dir_y = rays->direction[1], .dir_z = rays->direction[2],
      .tnear = rays->tnear,        .tfar = rays->tfar,
  };
  return pointers;
}

void cohort_c_intersect_stream(RTCScene scene, const struct Rays *rays, const struct Hits *hits,
                               unsigned count, bool coherent, unsigned width) {
  (void)width;
  PREPARE(how, Intersect, coherent);
  struct RTCRayHitNp pointers = {
      .ray = ray_pointers(rays),
      .hit = {
          .Ng_x = hits->normal[0], .Ng_y = hits->normal[1], .Ng_z = hits->normal[2],
          .u = hits->u,            .v = hits->v,
          .primID = hits->primitive_id, .geomID = hits->geometry_id,
      },
  };
  for (unsigned i = 0; i < count; ++i) {
    hits->geometry_id[i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersectNp(scene, &how, &pointers, count);
}

void cohort_c_occluded_stream(RTCScene scene, const struct Rays *rays, unsigned count,
                              bool coherent, unsigned width) {
  (void)width;
  PREPARE(how, Occluded, coherent);
  struct RTCRayNp pointers = ray_pointers(rays);
  rtcOccludedNp(scene, &how, &pointers, count);
}

void cohort_c_intersect_stream_1m(RTCScene scene, struct RTCRayHit *rays, unsigned count,
                                  bool coherent) {
  PREPARE(how, Intersect, coherent);
  for (unsigned i = 0; i < count; ++i) {
    rays[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect1M(scene, &how, rays, count, sizeof *rays);
}

void cohort_c_occluded_stream_1m(RTCScene scene, struct RTCRay *rays, unsigned count,
                                 bool coherent) {
  PREPARE(how, Occluded, coherent);
  rtcOccluded1M(scene, &how, rays, count, sizeof *rays);
}

#define STREAM_NM(K)                                                                               \
  void cohort_c_intersect_stream_nm##K(RTCScene scene, char *packets, unsigned count,              \
                                       size_t stride, bool coherent) {                             \
    PREPARE(how, Intersect, coherent);                                                             \
    for (unsigned i = 0; i < count; ++i) {                                                         \
      struct RTCRayHit##K *packet = (struct RTCRayHit##K *)(packets + i * stride);                 \
      for (int lane = 0; lane < K; ++lane) {                                                       \
        packet->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;                                        \
      }                                                                                            \
    }                                                                                              \
    rtcIntersectNM(scene, &how, (struct RTCRayHitN *)packets, K, count, stride);                   \
  }                                                                                                \
                                                                                                   \
  void cohort_c_occluded_stream_nm##K(RTCScene scene, char *packets, unsigned count,               \
                                      size_t stride, bool coherent) {                              \
    PREPARE(how, Occluded, coherent);                                                              \
    rtcOccludedNM(scene, &how, (struct RTCRayN *)packets, K, count, stride);                       \
  }

STREAM_NM(4)
STREAM_NM(8)
STREAM_NM(16)
