/* Embree 4 has no streams: packets of the processor's `width` over the arrays, as src/embree/calls/embree4.rs
 * does it. The arrays are padded to whole packets.
 */
#include "plain_c.h"

#define BY_PACKETS(K)                                                                              \
  static void load##K(struct RTCRay##K *ray, const struct Rays *rays, size_t first) {              \
    memset(ray, 0, sizeof *ray);                                                                   \
    memset(ray->mask, 0xff, sizeof ray->mask);                                                     \
    memcpy(ray->org_x, rays->origin[0] + first, sizeof ray->org_x);                                \
    memcpy(ray->org_y, rays->origin[1] + first, sizeof ray->org_y);                                \
    memcpy(ray->org_z, rays->origin[2] + first, sizeof ray->org_z);                                \
    memcpy(ray->dir_x, rays->direction[0] + first, sizeof ray->dir_x);                             \
    memcpy(ray->dir_y, rays->direction[1] + first, sizeof ray->dir_y);                             \
    memcpy(ray->dir_z, rays->direction[2] + first, sizeof ray->dir_z);                             \
    memcpy(ray->tnear, rays->tnear + first, sizeof ray->tnear);                                    \
    memcpy(ray->tfar, rays->tfar + first, sizeof ray->tfar);                                       \
  }                                                                                                \
                                                                                                   \
  static void choose##K(int *valid, const struct RTCRay##K *ray, size_t count) {                   \
    for (size_t lane = 0; lane < K; ++lane) {                                                      \
      valid[lane] = lane < count && ray->tnear[lane] <= ray->tfar[lane] ? -1 : 0;                  \
    }                                                                                              \
  }                                                                                                \
                                                                                                   \
  static void intersect_by##K(RTCScene scene, const struct Rays *rays, const struct Hits *hits,    \
                              size_t count, bool coherent) {                                       \
    PREPARE(how, Intersect, coherent);                                                             \
    for (size_t first = 0; first < count; first += K) {                                            \
      struct RTCRayHit##K packet;                                                                  \
      _Alignas(64) int valid[K];                                                                   \
      load##K(&packet.ray, rays, first);                                                           \
      choose##K(valid, &packet.ray, count - first);                                                \
      memset(packet.hit.geomID, 0xff, sizeof packet.hit.geomID);                                   \
      TRACE_K(Intersect, K, valid, scene, how, &packet);                                           \
      memcpy(rays->tfar + first, packet.ray.tfar, sizeof packet.ray.tfar);                         \
      memcpy(hits->normal[0] + first, packet.hit.Ng_x, sizeof packet.hit.Ng_x);                    \
      memcpy(hits->normal[1] + first, packet.hit.Ng_y, sizeof packet.hit.Ng_y);                    \
      memcpy(hits->normal[2] + first, packet.hit.Ng_z, sizeof packet.hit.Ng_z);                    \
      memcpy(hits->u + first, packet.hit.u, sizeof packet.hit.u);                                  \
      memcpy(hits->v + first, packet.hit.v, sizeof packet.hit.v);                                  \
      memcpy(hits->primitive_id + first, packet.hit.primID, sizeof packet.hit.primID);             \
      memcpy(hits->geometry_id + first, packet.hit.geomID, sizeof packet.hit.geomID);              \
    }                                                                                              \
  }                                                                                                \
                                                                                                   \
  static void occluded_by##K(RTCScene scene, const struct Rays *rays, size_t count,                \
                             bool coherent) {                                                      \
    PREPARE(how, Occluded, coherent);                                                              \
    for (size_t first = 0; first < count; first += K) {                                            \
      struct RTCRay##K packet;                                                                     \
      _Alignas(64) int valid[K];                                                                   \
      load##K(&packet, rays, first);                                                               \
      choose##K(valid, &packet, count - first);                                                    \
      TRACE_K(Occluded, K, valid, scene, how, &packet);                                            \
      memcpy(rays->tfar + first, packet.tfar, sizeof packet.tfar);                                 \
    }                                                                                              \
  }

BY_PACKETS(4)
BY_PACKETS(8)
BY_PACKETS(16)

void cohort_c_intersect_stream(RTCScene scene, const struct Rays *rays, const struct Hits *hits,
                               unsigned count, bool coherent, unsigned width) {
  switch (width) {
  case 16: intersect_by16(scene, rays, hits, count, coherent); break;
  case 8: intersect_by8(scene, rays, hits, count, coherent); break;
  default: intersect_by4(scene, rays, hits, count, coherent); break;
  }
}

void cohort_c_occluded_stream(RTCScene scene, const struct Rays *rays, unsigned count,
                              bool coherent, unsigned width) {
  switch (width) {
  case 16: occluded_by16(scene, rays, count, coherent); break;
  case 8: occluded_by8(scene, rays, count, coherent); break;
  default: occluded_by4(scene, rays, count, coherent); break;
  }
}

void cohort_c_intersect_stream_1m(RTCScene scene, struct RTCRayHit *rays, unsigned count,
                                  bool coherent) {
  PREPARE(how, Intersect, coherent);
  for (unsigned i = 0; i < count; ++i) {
    rays[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    if (rays[i].ray.tnear <= rays[i].ray.tfar) {
      TRACE_1(Intersect, scene, how, &rays[i]);
    }
  }
}

void cohort_c_occluded_stream_1m(RTCScene scene, struct RTCRay *rays, unsigned count,
                                 bool coherent) {
  PREPARE(how, Occluded, coherent);
  for (unsigned i = 0; i < count; ++i) {
    if (rays[i].tnear <= rays[i].tfar) {
      TRACE_1(Occluded, scene, how, &rays[i]);
    }
  }
}

#define STREAM_NM(K)                                                                               \
  void cohort_c_intersect_stream_nm##K(RTCScene scene, char *packets, unsigned count,              \
                                       size_t stride, bool coherent) {                             \
    PREPARE(how, Intersect, coherent);                                                             \
    for (unsigned i = 0; i < count; ++i) {                                                         \
      struct RTCRayHit##K *packet = (struct RTCRayHit##K *)(packets + i * stride);                 \
      _Alignas(64) int valid[K];                                                                   \
      choose##K(valid, &packet->ray, K);                                                           \
      memset(packet->hit.geomID, 0xff, sizeof packet->hit.geomID);                                 \
      TRACE_K(Intersect, K, valid, scene, how, packet);                                            \
    }                                                                                              \
  }                                                                                                \
                                                                                                   \
  void cohort_c_occluded_stream_nm##K(RTCScene scene, char *packets, unsigned count,               \
                                      size_t stride, bool coherent) {                              \
    PREPARE(how, Occluded, coherent);                                                              \
    for (unsigned i = 0; i < count; ++i) {                                                         \
      struct RTCRay##K *packet = (struct RTCRay##K *)(packets + i * stride);                       \
      _Alignas(64) int valid[K];                                                                   \
      choose##K(valid, packet, K);                                                                 \
      TRACE_K(Occluded, K, valid, scene, how, packet);                                             \
    }                                                                                              \
  }

STREAM_NM(4)
STREAM_NM(8)
STREAM_NM(16)
