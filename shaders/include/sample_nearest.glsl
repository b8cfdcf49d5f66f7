// The nearest pixel. Reference: projtex::reference::sample_footprint.
vec4 sample_image(Footprint f) { return image_texel(f, ivec2(floor(clamp(f.pixel, vec2(-kFarthest), vec2(kFarthest)) + 0.5)), 0); }
