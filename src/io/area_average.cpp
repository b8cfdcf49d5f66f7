#include "io/area_average.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace photohull::io {
namespace {

constexpr double kRounding = 1e-9;  // pixels: what is narrower is none

int count(double extent, double ratio) {
  return std::max(1, int(std::ceil(extent / ratio - kRounding)));
}

}  // namespace

AreaAverage::AreaAverage(double width, double height, const glm::dvec2& ratio, int channels,
                         Emit emit)
    : source_height_(height),
      ratio_(ratio.y),
      channels_(channels),
      width_(count(width, ratio.x)),
      height_(count(height, ratio.y)),
      emit_(std::move(emit)),
      spans_(std::size_t(width_)),
      narrow_(std::size_t(width_) * std::size_t(channels)),
      sum_(narrow_.size(), 0.0f) {
  PHOTOHULL_CHECK(width > 0 && height > 0 && ratio.x > 0 && ratio.y > 0 && channels > 0);
  for (int i = 0; i < width_; ++i) {
    const double left = i * ratio.x, right = std::min((i + 1) * ratio.x, width);
    Span& span = spans_[std::size_t(i)];
    span.first = int(left + kRounding);
    for (double x = span.first; x < right - kRounding; x += 1)
      span.weights.push_back(float((std::min(x + 1, right) - std::max(x, left)) / (right - left)));
  }
}

void AreaAverage::add(const float* row) {
  std::fill(narrow_.begin(), narrow_.end(), 0.0f);
  float* out = narrow_.data();
  for (const Span& span : spans_) {
    const float* in = row + std::size_t(span.first) * std::size_t(channels_);
    for (const float weight : span.weights)
      for (int c = 0; c < channels_; ++c) out[c] += weight * *in++;
    out += channels_;
  }
  const double bottom = std::min(top_ + 1, source_height_);
  for (double y = top_; y < bottom - kRounding && row_ < height_;) {
    const double end = std::min((row_ + 1) * ratio_, source_height_);
    const double part = std::min(bottom, end) - y;
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += float(part) * narrow_[i];
    weight_ += part;
    y += part;
    if (y < end - kRounding) break;
    for (float& value : sum_) value /= float(weight_);
    emit_(sum_.data());
    std::fill(sum_.begin(), sum_.end(), 0.0f);
    weight_ = 0;
    ++row_;
  }
  top_ += 1;
}

}  // namespace photohull::io
