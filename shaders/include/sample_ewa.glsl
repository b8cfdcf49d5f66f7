// Elliptical Gaussian [Heckbert89]: the Gaussian that the Jacobian makes of a round one on the plane,
// integrated over the pixels' squares. A level is chosen at which the short axis is two to four texels
// long; axes beyond 16 : 1 are widened. Rows of texels in turn: the Gaussian's share of the row, spread
// along it as the Gaussian is that fits the row best.
// Reference: projtex::reference::sample_footprint.
const float kMostRatio = 16.0;
const float kGaussianVariance = 1.0 / 6.0;  // of the square's edge squared
const float kLeastVariance = 4e-4;          // pixels squared
const float kTexelsAcross = 2.0;
const float kReach = 3.0;  // standard deviations

// Normal distribution function, by Abramowitz and Stegun 7.1.26, to 1e-7.
float normal_cdf(float z) {
  float x = abs(z) * 0.70710678, t = 1.0 / (1.0 + 0.3275911 * x);
  float tail = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
  float half_tail = 0.5 * tail * exp(-x * x);
  return z < 0.0 ? half_tail : 1.0 - half_tail;
}

float normal_density(float z) { return 0.39894228 * exp(-0.5 * z * z); }

vec4 sample_image(Footprint f) {
  FootprintAxes axes = axes_of(f);
  float shorter = max(axes.shorter, axes.longer / kMostRatio);
  int level = clamp(int(floor(log2(max(shorter, 1e-6) / kTexelsAcross))), 0, kLastLevel);
  float size = float(1 << level);
  shorter = min(shorter / size, 2.0 * kTexelsAcross);
  float longer = min(axes.longer / size, 2.0 * kTexelsAcross * kMostRatio);
  vec2 e = axes.direction;
  float l = kGaussianVariance * longer * longer, s = kGaussianVariance * shorter * shorter;
  float xx = l * e.x * e.x + s * e.y * e.y + kLeastVariance;
  float yy = l * e.y * e.y + s * e.x * e.x + kLeastVariance;
  float xy = (l - s) * e.x * e.y, slope = xy / yy;
  float rest = (l * s + kLeastVariance * (l + s + kLeastVariance)) / yy;  // xx - xy^2 / yy
  float deviation = sqrt(yy), spread = sqrt(rest + slope * slope * yy / (1.0 + 12.0 * yy));
  vec2 at = (clamp(f.pixel, vec2(-kFarthest), vec2(kFarthest)) + 0.5) / size - 0.5;
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  float last_row = at.y + kReach * deviation + 0.5;
  for (float y = ceil(at.y - kReach * deviation - 0.5); y <= last_row; y += 1.0) {
    float z0 = (y - 0.5 - at.y) / deviation, z1 = (y + 0.5 - at.y) / deviation;
    // In the tail's own precision.
    float row = z0 > 0.0 ? normal_cdf(-z0) - normal_cdf(-z1) : normal_cdf(z1) - normal_cdf(z0);
    float middle = at.x + slope * deviation * (normal_density(z0) - normal_density(z1)) / max(row, 1e-4);
    float last = middle + (row < 1e-4 ? -1e3 : kReach * spread + 0.5);
    float x = ceil(middle - kReach * spread - 0.5), before = normal_cdf((x - 0.5 - middle) / spread);
    for (; x <= last; x += 1.0) {
      float after = normal_cdf((x + 0.5 - middle) / spread), weight = row * (after - before);
      sum += weight * image_texel(f, ivec2(x, y), level);
      weights += weight;
      before = after;
    }
  }
  return weights > 0.0 ? sum / weights : vec4(0.0);
}
