// Bilinear interpolation of the image itself. Reference: projtex::reference::sample_footprint.
vec4 sample_image(Footprint f) { return textureLod(images, image_coordinate(f, f.pixel), 0.0); }
