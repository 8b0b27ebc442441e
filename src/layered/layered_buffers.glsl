// A layered pass's arrays by address, and its vertices in the world.
#ifndef UMBRAGE_LAYERED_BUFFERS_GLSL
#define UMBRAGE_LAYERED_BUFFERS_GLSL
#include "gpu/buffers.glsl"
#include "layered/layered_types.shared.h"

UMB_ARRAY(Rows, vec4, 4);
UMB_ARRAY(Skins, LayeredSkinRecord, 4);
UMB_ARRAY(LayeredBatches, LayeredBatch, 4);
UMB_ARRAY(LayeredInstances, LayeredInstanceRecord, 4);
UMB_ARRAY(LayeredCasters, LayeredCaster, 4);
UMB_ARRAY(LayeredViews, LayeredViewRecord, 4);
UMB_ARRAY(LayeredGroups, LayeredGroup, 4);
UMB_ARRAY(LayeredDraws, LayeredDraw, 4);
UMB_ARRAY(LayeredCounts, LayeredCount, 4);
UMB_ARRAY(LargeTriangles, LargeTriangle, 4);

bool sees(uint64_t visible, uint caster, uint view) {
  return (Uints(visible).v[caster * ViewWords + view / 32u] & (1u << (view % 32u))) != 0u;
}

#endif
