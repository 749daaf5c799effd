/* Single rays and packets. */
#include "plain_c.h"

void cohort_c_intersect1(RTCScene scene, struct RTCRayHit *rays, size_t count, bool coherent) {
  PREPARE(how, Intersect, coherent);
  for (size_t i = 0; i < count; ++i) {
    rays[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    TRACE_1(Intersect, scene, how, &rays[i]);
  }
}

void cohort_c_occluded1(RTCScene scene, struct RTCRay *rays, size_t count, bool coherent) {
  PREPARE(how, Occluded, coherent);
  for (size_t i = 0; i < count; ++i) {
    TRACE_1(Occluded, scene, how, &rays[i]);
  }
}

/* `stride` is the distance in bytes from one packet to the next. */

#define PACKETS(K)                                                                                 \
  void cohort_c_intersect_packet##K(RTCScene scene, const int *valid, char *packets, size_t count, \
                                    size_t stride, bool coherent) {                                \
    PREPARE(how, Intersect, coherent);                                                             \
    for (size_t i = 0; i < count; ++i) {                                                           \
      struct RTCRayHit##K *packet = (struct RTCRayHit##K *)(packets + i * stride);                 \
      for (int lane = 0; lane < K; ++lane) {                                                       \
        packet->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;                                        \
      }                                                                                            \
      TRACE_K(Intersect, K, valid, scene, how, packet);                                            \
    }                                                                                              \
  }                                                                                                \
                                                                                                   \
  void cohort_c_occluded_packet##K(RTCScene scene, const int *valid, char *packets, size_t count,  \
                                   size_t stride, bool coherent) {                                 \
    PREPARE(how, Occluded, coherent);                                                              \
    for (size_t i = 0; i < count; ++i) {                                                           \
      TRACE_K(Occluded, K, valid, scene, how, (struct RTCRay##K *)(packets + i * stride));         \
    }                                                                                              \
  }

PACKETS(4)
PACKETS(8)
PACKETS(16)
