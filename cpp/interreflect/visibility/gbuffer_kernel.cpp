#include "visibility/gbuffer_kernel.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/gbuffer_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "visibility/gbuffer_kernel-inl.h"

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(trace_tile);
void trace_gbuffer_tile(const GBufferJob& job, const Tile& tile) { HWY_DYNAMIC_DISPATCH(trace_tile)(job, tile); }
}  // namespace interreflect
#endif
