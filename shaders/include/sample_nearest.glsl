// The nearest pixel. Reference: projtex::reference::sample_footprint.
vec4 sample_image(Footprint f) { return image_texel(f, ivec2(floor(f.pixel + 0.5)), 0); }
