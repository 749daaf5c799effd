/* Compares the installed headers of Embree 4 with what the Rust side relies on.
 *
 * The crate embree4-sys carries the headers of Embree 4.2. Since 4.3 a hit also says which instance
 * of an instance array was met, so the library writes beyond that crate's hit structures. The Rust
 * side therefore lays out rays and hits itself; this file fails to compile where they disagree.
 */
#include <embree4/rtcore.h>
#include <stddef.h>

#define SAME(is, expected) _Static_assert((is) == (expected), #is " is not " #expected)
#define FITS(is, room) _Static_assert((is) <= (room), #is " is more than " #room)

/* src/embree/ray.rs */
SAME(sizeof(struct RTCRay), 48);
SAME(offsetof(struct RTCRay, tfar), 32);
SAME(offsetof(struct RTCRayHit, hit), 48);
SAME(offsetof(struct RTCHit, instPrimID), 32);
SAME(sizeof(struct RTCRayHit), 96);

/* src/embree/packet.rs */
#define PACKET(K)                                                                                  \
  SAME(sizeof(struct RTCRay##K), 48 * K);                                                          \
  SAME(offsetof(struct RTCRay##K, tfar), 32 * K);                                                  \
  SAME(offsetof(struct RTCRayHit##K, hit), 48 * K);                                                \
  SAME(offsetof(struct RTCHit##K, instPrimID), 32 * K);                                            \
  FITS(sizeof(struct RTCRayHit##K), (48 * K + 36 * K + 63) / 64 * 64)
PACKET(4);
PACKET(8);
PACKET(16);

/* What embree4-sys declares for the arguments of a call. */
SAME(sizeof(struct RTCIntersectArguments), 32);
SAME(offsetof(struct RTCIntersectArguments, feature_mask), 4);
SAME(offsetof(struct RTCIntersectArguments, intersect), 24);
SAME(sizeof(struct RTCOccludedArguments), 32);
SAME(offsetof(struct RTCOccludedArguments, feature_mask), 4);
SAME(offsetof(struct RTCOccludedArguments, occluded), 24);

/* What src/embree/user_geometry.rs reads and writes. */
SAME(offsetof(struct RTCRayQueryContext, instID), 0);
SAME(offsetof(struct RTCIntersectFunctionNArguments, context), 24);
SAME(offsetof(struct RTCIntersectFunctionNArguments, rayhit), 32);
SAME(offsetof(struct RTCIntersectFunctionNArguments, N), 40);
SAME(offsetof(struct RTCOccludedFunctionNArguments, ray), 32);
SAME(offsetof(struct RTCOccludedFunctionNArguments, N), 40);
