#include "visibility/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace photohull::visibility::reference {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSameDepth = 2e-6;
constexpr double kSteepest = 16;
constexpr double kSnap = 1.0 / 128;  // texels: devices round corners to 1/256
constexpr double kLeastVariance = 1e-7;

dmat3 linear_part(const PartLayout& part) {
  return glm::transpose(dmat3(dvec3(part.row_x), dvec3(part.row_y), dvec3(part.row_w)));
}

std::uint32_t hash(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

dvec2 jitter(const dvec2& at, int tap) {
  const std::uint32_t h =
      hash(std::uint32_t(int(std::floor(at.x * 16))) ^
           hash(std::uint32_t(int(std::floor(at.y * 16))) ^ hash(std::uint32_t(tap))));
  return dvec2(h & 0xffffu, h >> 16) / 65536.0 - 0.5;
}

}  // namespace

Map::Map(const MapLayout& layout, const Technique& technique, const TriMesh& mesh,
         std::span<const std::uint32_t> id_of)
    : layout_(layout), technique_(technique), origin_(mesh.origin) {
  for (const auto& t : mesh.triangles) {
    ids_.push_back(id_of.empty() ? std::uint32_t(triangles_.size()) : id_of[triangles_.size()]);
    triangles_.push_back(
        {dvec3(mesh.positions[t[0]]), dvec3(mesh.positions[t[1]]), dvec3(mesh.positions[t[2]])});
  }
  const double texel = layout.texel_width * std::max(layout.middle(), 0.0);
  bias_ = technique.bias_texels * texel;
  z_max_ = technique.z_max_texels * texel;
  if (technique.detail != Detail::kNone) return;  // keeps triangles, not depths
  texels_.resize(layout.parts.size() * std::size_t(layout.size.x) * layout.size.y);
  for (int part = 0; part < int(layout.parts.size()); ++part)
    for (int y = 0; y < layout.size.y; ++y)
      for (int x = 0; x < layout.size.x; ++x)
        draw_texel(part, {x, y},
                   texels_[(std::size_t(part) * layout.size.y + y) * layout.size.x + x]);
}

const Texel& Map::texel(int part, int x, int y) const {
  return texels_[(std::size_t(part) * layout_.size.y + y) * layout_.size.x + x];
}

void Map::adopt_unsure(const VisibilityMap& device) {
  const std::vector<float> first = device.depths(), second = device.depths(true);
  const std::vector<std::uint32_t> ids = device.ids();
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    if (!texels_[i].unsure) continue;
    if (!first.empty()) texels_[i].first = first[i], texels_[i].slope = 0;
    if (!second.empty()) texels_[i].second = second[i];
    if (!ids.empty()) texels_[i].id = ids[i];
  }
}

ivec2 Map::clamped(const ivec2& texel) const {
  return glm::clamp(texel, ivec2(0), layout_.size - 1);
}

Sight Map::sight(int part, const dvec2& at) const {
  const PartLayout& p = layout_.parts[part];
  const dmat3 back = glm::inverse(linear_part(p));
  return {-(back * dvec3(p.row_x.w, p.row_y.w, p.row_w.w)), back * dvec3(at, 1)};
}

double Map::depth_on(int part, const Sight& s, double w) const {
  return glm::dot(layout_.parts[part].row_z, dvec4(s.origin + w * s.direction, 1));
}

Crossing Map::cross(const Sight& s, std::size_t triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  const dvec3 ab = b - a, ac = c - a, normal = glm::cross(ab, ac);
  const double slant = glm::dot(normal, s.direction);
  if (slant == 0) return {};
  Crossing out;
  out.w = glm::dot(normal, a - s.origin) / slant;
  const dvec3 p = s.origin + out.w * s.direction - a;
  const double area = glm::dot(normal, normal);
  out.b1 = glm::dot(glm::cross(p, ac), normal) / area;
  out.b2 = glm::dot(glm::cross(ab, p), normal) / area;
  out.b0 = 1 - out.b1 - out.b2;
  out.exists = true;
  return out;
}

void Map::draw_texel(int part, const ivec2& at, Texel& texel) const {
  texel.first = texel.second = kInfinity;
  if (layout_.far <= layout_.near) return;
  const Sight s = sight(part, dvec2(at) + 0.5);
  std::size_t nearest = 0;
  std::vector<double> depths;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Crossing c = cross(s, i);
    for (const dvec2& shift :
         {dvec2(kSnap, 0), dvec2(-kSnap, 0), dvec2(0, kSnap), dvec2(0, -kSnap)})
      texel.unsure =
          texel.unsure || cross(sight(part, dvec2(at) + 0.5 + shift), i).inside() != c.inside();
    if (!c.inside() || c.w < layout_.parts[part].nearest_w) continue;
    depths.push_back(depth_on(part, s, c.w));
    if (depths.back() < texel.first) texel.first = depths.back(), nearest = i;
  }
  for (const double z : depths)
    if (z > texel.first * (1 + kSameDepth)) texel.second = std::min(texel.second, z);
  if (texel.first == kInfinity) return;
  texel.id = ids_[nearest];
  // The device's differences are those of blocks of 2 x 2 texels.
  const ivec2 block(at.x & ~1, at.y & ~1);
  const auto plane = [&](const ivec2& t) {
    const Sight beside = sight(part, dvec2(t) + 0.5);
    return depth_on(part, beside, cross(beside, nearest).w);
  };
  texel.slope = std::max(std::abs(plane(block + ivec2(1, 0)) - plane(block)),
                         std::abs(plane(block + ivec2(0, 1)) - plane(block)));
}

Map::Place Map::locate(int part, const dvec3& p) const {
  const PartLayout& l = layout_.parts[part];
  const dvec4 h(p, 1);
  const double w = glm::dot(l.row_w, h);
  return {part, dvec2(glm::dot(l.row_x, h), glm::dot(l.row_y, h)) / w, w, glm::dot(l.row_z, h)};
}

double Map::receiver_depth(const Sample& s, const Place& place, const dvec2& at) const {
  if (technique_.virtual_samples == VirtualSamples::kNone) return place.z;
  const dvec2 d = at - place.at;
  const double most = kSteepest * layout_.texel_width * place.z * (std::abs(d.x) + std::abs(d.y));
  double z;
  if (technique_.virtual_samples == VirtualSamples::kNormal) {
    const Sight line = sight(place.part, at);
    const double slant = glm::dot(s.normal, line.direction);
    const double w = glm::dot(s.normal, s.position - origin_ - line.origin) / slant;
    z = slant == 0 ? place.z : w > 0 ? depth_on(place.part, line, w) : kInfinity;
  } else {
    // (3) solved for the steps in x and y, then (2).
    const Place dx = locate(place.part, s.position - origin_ + s.step_x);
    const Place dy = locate(place.part, s.position - origin_ + s.step_y);
    const dvec2 sx = dx.at - place.at, sy = dy.at - place.at;
    const double det = sx.x * sy.y - sx.y * sy.x;
    if (std::abs(det) < 1e-30 || dx.w <= 0 || dy.w <= 0) return place.z;
    const double nx = (d.x * sy.y - d.y * sy.x) / det, ny = (d.y * sx.x - d.x * sx.y) / det;
    z = place.z + nx * (dx.z - place.z) + ny * (dy.z - place.z);
  }
  return std::clamp(z, place.z - most, place.z + most);
}

double Map::map_depth(const Sample& s, const Place& place, const Texel& texel) const {
  const double z1 = texel.first, z2 = texel.second;
  if (z1 == kInfinity) return z1;
  switch (technique_.bias) {
    case Bias::kConstant:
      return z1 + bias_;
    case Bias::kSlope:
      return z1 + bias_ + technique_.slope_factor * texel.slope;
    case Bias::kSecondDepth:
      return z2;
    case Bias::kMidpoint:
      return z1 + 0.5 * (z2 - z1);
    case Bias::kDualDepth:
      return z1 + std::min(0.5 * (z2 - z1), z_max_);
    case Bias::kReceiverPlane:
      return z1 + bias_ + change_within_texel(s, place);
    case Bias::kIds:
      break;
  }
  return z1;
}

double Map::change_within_texel(const Sample& s, const Place& place) const {
  double change = 0;  // by small steps along each axis of the map
  for (const dvec2& step : {dvec2(1e-4, 0), dvec2(0, 1e-4)}) {
    const Sight line = sight(place.part, place.at + step);
    const double w =
        glm::dot(s.normal, s.position - origin_ - line.origin) / glm::dot(s.normal, line.direction);
    change += 0.5 * std::abs(w / place.w - 1) * place.z / 1e-4;
  }
  const double most = 0.5 * kSteepest * layout_.texel_width * place.z;
  return change < most ? change : most;
}

bool Map::lit(const Sample& s, const Place& place, const dvec2& at) const {
  const ivec2 texel_at = clamped(ivec2(glm::floor(at)));
  const Texel& t = texel(place.part, texel_at.x, texel_at.y);
  if (technique_.bias != Bias::kIds)
    return receiver_depth(s, place, technique_.align_to_texels ? dvec2(texel_at) + 0.5 : at) <=
           map_depth(s, place, t);
  if (receiver_depth(s, place, at) <= t.first) return true;
  if (s.id == shaders::kNoTriangle) return false;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const ivec2 beside = clamped(texel_at + ivec2(x, y));
      if (texel(place.part, beside.x, beside.y).id == s.id) return true;
    }
  return false;
}

double Map::pcf(const Sample& s, const Place& place) const {
  const int n = technique_.filter_size;
  const bool circular =
      technique_.kernel == Kernel::kCircular || technique_.kernel == Kernel::kCircularJittered;
  const bool jittered =
      technique_.kernel == Kernel::kJittered || technique_.kernel == Kernel::kCircularJittered;
  double passed = 0, weight = 0, outer_passed = 0, outer_weight = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      dvec2 cell(i + 0.5, j + 0.5);
      if (jittered) cell += jitter(place.at, j * n + i);
      dvec2 offset = cell - 0.5 * n;
      if (circular) {  // (10)
        const double radius = 0.5 * n * std::sqrt(std::max(cell.y, 0.0) / n);
        const double turn = 2 * std::numbers::pi * cell.x / n;
        offset = radius * dvec2(std::cos(turn), std::sin(turn));
      }
      const double sigma = 0.25 * n;
      const double w =
          technique_.gaussian ? std::exp(-0.5 * glm::dot(offset, offset) / (sigma * sigma)) : 1;
      dvec2 at = place.at + offset;
      if (technique_.on_pixels)
        at =
            locate(place.part, s.position - origin_ + offset.x * s.step_x + offset.y * s.step_y).at;
      const bool pass = lit(s, place, at);
      const bool outer = circular ? j == n - 1 : i == 0 || j == 0 || i == n - 1 || j == n - 1;
      passed += pass ? w : 0;
      weight += w;
      outer_passed += outer && pass ? w : 0;
      outer_weight += outer ? w : 0;
    }
  if (technique_.adaptive && outer_passed <= 0) return 0;
  if (technique_.adaptive && outer_passed >= outer_weight) return 1;
  return passed / weight;
}

dvec2 Map::moments(int part, const ivec2& centre) const {
  const int radius = technique_.filter_size / 2;
  const double sigma = 0.25 * technique_.filter_size;
  dvec2 sum(0.0);
  double weight = 0;
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) {
      const ivec2 at = clamped(centre + ivec2(x, y));
      const double z = std::clamp(
          (texel(part, at.x, at.y).first - layout_.near) / (layout_.far - layout_.near), 0.0, 1.0);
      const double w = std::exp(-0.5 * (x * x + y * y) / (sigma * sigma));
      sum += w * dvec2(z, z * z);
      weight += w;
    }
  return sum / weight;
}

double Map::variance(const Place& place) const {
  if (layout_.far <= layout_.near) return 1;
  const double z = std::min((place.z - bias_ - layout_.near) / (layout_.far - layout_.near), 1.0);
  const dvec2 p = place.at - 0.5, low = glm::floor(p), f = p - low;
  const auto at = [&](int x, int y) {
    return moments(place.part, clamped(ivec2(low) + ivec2(x, y)));
  };
  const dvec2 m = (1 - f.y) * ((1 - f.x) * at(0, 0) + f.x * at(1, 0)) +
                  f.y * ((1 - f.x) * at(0, 1) + f.x * at(1, 1));
  if (z <= m.x) return 1;
  const double spread = std::max(m.y - m.x * m.x, kLeastVariance);
  const double bound = spread / (spread + (z - m.x) * (z - m.x));
  return std::clamp((bound - technique_.bleeding_cut) / (1 - technique_.bleeding_cut), 0.0, 1.0);
}

double Map::visible(const Sample& s) const {
  const dvec3 p = s.position - origin_;
  const dvec4 h(p, 1);
  const double z = glm::dot(layout_.parts[0].row_z, h);
  const dvec2 image(glm::dot(layout_.view_x, h), glm::dot(layout_.view_y, h));
  if (z <= 0 || image.x < 0 || image.y < 0 || image.x > z || image.y > z) return 0;
  int part = 0;
  while (part + 1 < int(layout_.parts.size()) &&
         glm::dot(layout_.eye_row, h) > layout_.parts[part].end)
    ++part;
  const Place place = locate(part, p);
  if (technique_.detail == Detail::kSubPixel) return sub_pixel(s, place);
  if (technique_.detail == Detail::kCoverage) return coverage(s, place);
  if (technique_.detail == Detail::kLists) return exact(s, place);
  if (technique_.filter == Filter::kVariance) return variance(place);
  if (technique_.filter == Filter::kPcf) return pcf(s, place);
  return lit(s, place, place.at) ? 1 : 0;
}

}  // namespace photohull::visibility::reference
