/* What bindgen reads to declare Embree 3. */
#include <embree3/rtcore.h>
