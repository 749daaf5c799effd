/* The calls of src/embree/query.rs as a C program makes them: what the safe layer is measured against.
 *
 * Each function does the work of the safe call of its name, for a whole array, so that it is entered
 * once: it prepares the call, marks every hit as a miss, as Embree wants it, and traces. The functions
 * are declared in src/embree/plain_c.rs.
 */
#pragma once

#ifdef COHORT_EMBREE4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Rays and hits as structures of arrays: `StreamRays` and `StreamHits` of src/embree/plain_c.rs. */
struct Rays {
  float *origin[3], *direction[3], *tnear, *tfar;
};
struct Hits {
  float *normal[3], *u, *v;
  unsigned *primitive_id, *geometry_id;
};

#ifdef COHORT_EMBREE4

#define PREPARE(how, Query, coherent)                                                              \
  struct RTC##Query##Arguments how;                                                                \
  rtcInit##Query##Arguments(&how);                                                                 \
  how.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT
#define TRACE_1(Query, scene, how, ray) rtc##Query##1(scene, ray, &how)
#define TRACE_K(Query, K, valid, scene, how, packet) rtc##Query##K(valid, scene, packet, &how)

#else

#define PREPARE(how, Query, coherent)                                                              \
  struct RTCIntersectContext how;                                                                  \
  rtcInitIntersectContext(&how);                                                                   \
  how.flags =                                                                                      \
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
#define TRACE_1(Query, scene, how, ray) rtc##Query##1(scene, &how, ray)
#define TRACE_K(Query, K, valid, scene, how, packet) rtc##Query##K(valid, scene, &how, packet)

#endif
