// float visible(Receiver): the share of a receiver that the viewpoint sees, by the technique that the
// defines choose; 0 behind the viewpoint and off its image.
#include "include/visibility_map.glsl"
#include "include/visibility_receiver_plane.glsl"
#include "include/visibility_triangle.glsl"

layout(binding = kFirstDepthUnit) uniform sampler2DArray first_depth;
layout(binding = kSecondDepthUnit) uniform sampler2DArray second_depth;
layout(binding = kNearestIdsUnit) uniform usampler2DArray nearest_ids;
layout(binding = kDepthMomentsUnit) uniform sampler2DArray depth_moments;

#if defined(DETAIL_SUB_PIXEL) || defined(DETAIL_COVERAGE)
#include "include/visibility_nearest.glsl"
#endif
#if defined(DETAIL_SUB_PIXEL)
#include "include/visibility_sub_pixel.glsl"
#elif defined(DETAIL_COVERAGE)
#include "include/visibility_coverage.glsl"
#elif defined(DETAIL_LISTS)
#include "include/visibility_lists.glsl"
#elif defined(FILTER_VARIANCE)
#include "include/visibility_filter_variance.glsl"
#else

#if defined(VIRTUAL_NORMAL)
#include "include/visibility_virtual_normal.glsl"
#elif defined(VIRTUAL_DERIVATIVES)
#include "include/visibility_virtual_derivatives.glsl"
#else
#include "include/visibility_own_depth.glsl"
#endif

#if defined(COMPARE_IDS)
#include "include/visibility_compare_ids.glsl"
#else
#if defined(BIAS_SECOND_DEPTH)
#include "include/visibility_bias_second_depth.glsl"
#elif defined(BIAS_MIDPOINT)
#include "include/visibility_bias_midpoint.glsl"
#elif defined(BIAS_DUAL_DEPTH)
#include "include/visibility_bias_dual_depth.glsl"
#elif defined(BIAS_RECEIVER_PLANE)
#include "include/visibility_bias_receiver_plane.glsl"
#else
#include "include/visibility_bias_constant.glsl"
#endif
#include "include/visibility_compare_depths.glsl"
#endif

#if defined(FILTER_PCF)
#include "include/visibility_filter_pcf.glsl"
#else
#include "include/visibility_filter_none.glsl"
#endif

#endif

float visible(Receiver r) {
  if (!in_view(r.position.xyz)) return 0.0;
  return fraction_visible(r, locate(part_of(vec4(r.position.xyz, 1.0)), r.position.xyz));
}
