#include "calib/pose_photographs.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/seen_height.h"
#include "calib/sheet_problem.h"
#include "core/error.h"
#include "core/median.h"
#include "core/option_word.h"

namespace photohull {
namespace {

constexpr std::size_t kFewestTags = 2, kFewestAround = 3;         // on a sheet; around a cylinder
constexpr double kLeastNoise = 0.01, kBadTag = 5, kBadPhoto = 6;  // pixels; times the median
constexpr double kHarmlessTag = 0.5, kHarmlessPhoto = 1.0;        // pixels
constexpr double kUncertainFocal = 0.01;                          // of the focal length

class Poser {
 public:
  Poser(const std::vector<PosePhoto>& photos, const Sheet& sheet, const PoseOptions& options)
      : given_(photos), sheet_(sheet), o_(options) {
    problem_.model = options.lens;
    problem_.reach = 0.5 * glm::length(sheet.page);
    problem_.flat = sheet.is_flat();
    if (!problem_.flat) fewest_ = kFewestAround;
    result_.photos.resize(photos.size());
    result_.scale = (o_.bar > 0 ? o_.bar / sheet.bar_length() : 1) / o_.unit;
  }

  PoseResult run() {
    take_views();
    start_sheet_problem(given_, problem_);
    for (std::size_t i = 0; i < given_.size(); ++i)
      if (!problem_.photos[i].used && result_.photos[i].reason.empty())
        result_.photos[i].reason = "no pose fits the tags that it shows";
    check_some("no photograph shows the sheet well enough");
    refine();
    if (!o_.flat && sheet_.is_flat()) find_bend();
    report();
    return result_;
  }

 private:
  /// Tags and saddles of each photograph, those that are no plane's left out.
  void take_views() {
    for (std::size_t i = 0; i < given_.size(); ++i) {
      const SheetView& view = given_[i].view;
      SheetPhoto photo;
      photo.view = view.board;
      for (std::size_t k = 0; k < view.board.points.size(); ++k)
        photo.group.push_back(k < view.tag_points() ? k / 4 : k);
      if (!problem_.flat) photo.moved.resize(photo.view.points.size());
      PosedPhoto& out = result_.photos[i];
      out.tags_found = int(view.tags.size());
      if (view.tags.size() >= fewest_ && problem_.flat) drop_wrong_tags(photo);
      const std::size_t tags = tags_of(photo, i);
      photo.used = tags >= fewest_;
      if (!photo.used) out.reason = why_not(view, tags);
      problem_.photos.push_back(std::move(photo));
    }
  }

  /// Tags of the i-th photograph that count.
  std::size_t tags_of(const SheetPhoto& photo, std::size_t i) const {
    std::set<std::size_t> tags;
    for (const std::size_t group : photo.group)
      if (group < given_[i].view.tags.size()) tags.insert(group);
    return tags.size();
  }

  std::string why_not(const SheetView& view, std::size_t tags) const {
    if (view.mirrored) return "it is mirrored: tags are seen in its mirror image only";
    if (view.tags.empty() && view.foreign > 0)
      return concat("it shows ", view.foreign, " tags, none of them of this board");
    if (view.tags.empty() && view.twice > 0)
      return concat("it shows ", view.twice, " tags in two places each: are there two sheets?");
    if (view.tags.empty()) return "no tag was found: it is blurred, or does not show the sheet";
    if (tags < view.tags.size())
      return concat("of its ", view.tags.size(), " tags ", tags, " lie in one plane; ", fewest_,
                    " are needed");
    return concat(tags, tags == 1 ? " tag was" : " tags were", " found; ", fewest_, " are needed");
  }

  void check_some(const std::string& what) const {
    for (const SheetPhoto& photo : problem_.photos)
      if (photo.used) return;
    std::string reason = result_.photos.empty() ? "" : result_.photos[0].reason;
    throw Error(concat(what, "; the first, ", given_.empty() ? "" : given_[0].view.board.name, ": ",
                       reason));
  }

  void refine() {
    for (int round = 0; round < 12; ++round) {
      if (!problem_.flat) problem_.follow_arcs();
      problem_.refine(bent_);
      set_noise();
      const bool dropped = round > 0 && drop_outliers();
      if (round > 1 && !dropped) break;
    }
  }

  /// Of each photograph: its own, but not less than the median one's.
  void set_noise() {
    std::vector<double> all;
    for (const SheetPhoto& photo : problem_.photos)
      if (photo.used) all.push_back(noise_of(photo));
    const double usual = std::max(kLeastNoise, median(all));
    for (SheetPhoto& photo : problem_.photos)
      if (photo.used) photo.noise = std::max(usual, noise_of(photo));
  }

  /// Deviation of a coordinate: of Rayleigh's distribution by its median.
  double noise_of(const SheetPhoto& photo) const { return median(problem_.errors(photo)) / 1.1774; }

  bool drop_outliers() {
    bool dropped = false;
    std::vector<double> noises;
    for (const SheetPhoto& photo : problem_.photos)
      if (photo.used) noises.push_back(noise_of(photo));
    const double usual = median(noises);
    for (std::size_t i = 0; i < problem_.photos.size(); ++i) {
      SheetPhoto& photo = problem_.photos[i];
      if (!photo.used) continue;
      dropped = drop_points(photo) || dropped;
      const double limit = std::max(kHarmlessPhoto, kBadPhoto * usual);
      if (tags_of(photo, i) < fewest_)
        leave_out(i, "its tags do not fit each other");
      else if (noise_of(photo) > limit)
        leave_out(i, concat("its tags do not fit the other photographs: ", problem_.rms(photo),
                            " px rms; it is blurred, or the sheet or the object was moved"));
      dropped = dropped || !photo.used;
    }
    check_some("no photograph fits the sheet");
    return dropped;
  }

  /// Tags one of whose corners is far off.
  bool drop_points(SheetPhoto& photo) const {
    const double limit = std::max(kHarmlessTag, kBadTag * photo.noise);
    const std::vector<double> errors = problem_.errors(photo);
    std::set<std::size_t> bad;
    for (std::size_t k = 0; k < errors.size(); ++k)
      if (!(errors[k] <= limit)) bad.insert(photo.group[k]);
    if (bad.empty()) return false;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      if (bad.count(photo.group[k])) continue;
      photo.view.points[kept] = photo.view.points[k];
      photo.view.pixels[kept] = photo.view.pixels[k];
      if (!photo.moved.empty()) photo.moved[kept] = photo.moved[k];
      photo.group[kept++] = photo.group[k];
    }
    photo.view.points.resize(kept), photo.view.pixels.resize(kept), photo.group.resize(kept);
    if (!photo.moved.empty()) photo.moved.resize(kept);
    return true;
  }

  void leave_out(std::size_t i, const std::string& reason) {
    problem_.photos[i].used = false;
    result_.photos[i].reason = reason;
    result_.photos[i].placed = true;
  }

  glm::dvec3 box_low() const { return {sheet_.free_min, sheet_.strip + o_.margin / print()}; }
  glm::dvec3 box_high() const {
    const glm::dvec2 side = sheet_.free_max - sheet_.free_min;
    const double height = o_.height > 0 ? o_.height / print() : std::max(side.x, side.y);
    const glm::dvec3 high(sheet_.free_max, sheet_.strip + height);
    if (o_.height > 0 || !problem_.flat) return high;
    return lowered_to_seen({box_low(), high}, cameras_used()).max;
  }
  /// Of each photograph that counts, millimetres.
  std::vector<Camera> cameras_used() const {
    std::vector<Camera> cameras;
    Distortion distortion;
    for (const SheetPhoto& photo : problem_.photos) {
      if (!photo.used) continue;
      const SheetCamera& from = problem_.cameras[photo.camera];
      Camera& to = cameras.emplace_back();
      set_lens(from.lens, problem_.model, from.size.x, from.size.y, to.intrinsics, distortion);
      to.cam_from_world = pose_of(photo.pose);
    }
    return cameras;
  }
  /// How much larger than described the sheet is printed.
  double print() const { return result_.scale * o_.unit; }

  /// Largest height of the page's edges over the plane at its middle, mm as described.
  double bend_height(const Bend& bend) const {
    double height = 0;
    for (const double x : {0.0, 0.5, 1.0})
      for (const double y : {0.0, 0.5, 1.0}) {
        glm::dvec3 p(sheet_.lower_left + sheet_.page * glm::dvec2(x, y), 0);
        bend_sheet(bend.data(), problem_.reach, &p.x);
        height = std::max(height, std::abs(p.z));
      }
    return height;
  }

  /// A sheet is bent where that explains what noise does not, and enough to matter.
  void find_bend() {
    constexpr double kSure = 5, kLeastHeight = 0.1;  // deviations; mm
    const SheetProblem flat = problem_;
    bent_ = true;
    problem_.stretches = true;  // from there to paper: the straight way ends in another minimum
    refine();
    problem_.stretches = false;
    refine();
    const auto d = problem_.deviations(true, box_low(), box_high());
    double sure = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (d.bend[i] > 0) sure = std::max(sure, std::abs(problem_.bend[i]) / d.bend[i]);
    if (sure > kSure && bend_height(problem_.bend) > kLeastHeight) return;
    problem_ = flat;
    bent_ = false;
    for (std::size_t i = 0; i < given_.size(); ++i)
      if (problem_.photos[i].used)
        result_.photos[i].reason.clear(), result_.photos[i].placed = false;
  }

  void report() {
    const auto d = problem_.deviations(bent_, box_low(), box_high());
    result_.object_error = d.object_error;
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < given_.size(); ++i) {
      const SheetPhoto& photo = problem_.photos[i];
      if (photo.used || result_.photos[i].placed) report_pose(photo, result_.photos[i]);
      if (!photo.used) continue;
      report_photo(photo, d.poses.at(i), result_.photos[i]);
      result_.photos[i].tags_used = int(tags_of(photo, i));
      for (const double e : problem_.errors(photo)) sum += e * e, ++count;
    }
    result_.rms = std::sqrt(sum / std::max(1.0, count));
    for (std::size_t c = 0; c < problem_.cameras.size(); ++c)
      report_camera(problem_.cameras[c], d.lenses.at(c));
    result_.box = {box_low() * result_.scale, box_high() * result_.scale};
    if (bent_) report_bend(d.bend);
    warn();
  }

  void report_pose(const SheetPhoto& photo, PosedPhoto& out) const {
    out.camera = int(photo.camera);
    out.cam_from_world = pose_of(photo.pose);
    out.cam_from_world.translation *= result_.scale;
  }

  void report_photo(const SheetPhoto& photo, const std::vector<double>& sigma, PosedPhoto& out) {
    out.posed = true;
    out.rms = problem_.rms(photo);
    if (sigma.size() != 6) return;
    for (std::size_t k = 0; k < 3; ++k) {
      out.turn_sigma = std::max(out.turn_sigma, kDegreesPerRadian * sigma[k]);
      out.place_sigma = std::max(out.place_sigma, result_.scale * sigma[3 + k]);
    }
    ++cameras_seen_[photo.camera];
  }

  void report_camera(const SheetCamera& camera, const std::vector<double>& sigma) {
    PosedCamera out;
    out.name = camera.name;
    set_lens(camera.lens, problem_.model, camera.size.x, camera.size.y, out.intrinsics,
             out.distortion);
    out.stated_focal = camera.stated_focal;
    if (!sigma.empty()) {
      out.focal_sigma = std::max(sigma[0], sigma[1]);
      out.principal_sigma = std::max(sigma[2], sigma[3]);
    }
    out.photographs = cameras_seen_[result_.cameras.size()];
    result_.cameras.push_back(out);
  }

  void report_bend(const Bend& sigma) {
    SheetBend& b = result_.bend;
    const double per_unit = result_.scale / std::pow(problem_.reach * result_.scale, 2);
    b.found = true;
    b.xx = problem_.bend[0] * per_unit, b.xy = problem_.bend[1] * per_unit;
    b.yy = problem_.bend[2] * per_unit;
    b.height = bend_height(problem_.bend) * result_.scale;
    b.height_sigma = *std::max_element(sigma.begin(), sigma.end()) * result_.scale;
  }

  void warn() {
    for (const PosedCamera& c : result_.cameras)
      if (c.photographs > 0 && !(c.focal_sigma < kUncertainFocal * c.intrinsics.fx))
        result_.warnings.push_back(concat(c.name, ": the focal length is uncertain, ",
                                          c.intrinsics.fx, " +- ", c.focal_sigma,
                                          " px; photograph the sheet from more heights"));
    int twice = 0, foreign = 0;
    for (const PosePhoto& photo : given_)
      twice += photo.view.twice > 0, foreign += photo.view.foreign > 0;
    if (twice > 0)
      result_.warnings.push_back(
          concat(twice, " photographs show a tag in two places; lay out one sheet only"));
    if (foreign > 0)
      result_.warnings.push_back(concat(
          foreign, " photographs show tags that the board does not have; is it the right one?"));
  }

  const std::vector<PosePhoto>& given_;
  const Sheet& sheet_;
  const PoseOptions& o_;
  SheetProblem problem_;
  PoseResult result_;
  std::map<std::size_t, int> cameras_seen_;
  std::size_t fewest_ = kFewestTags;
  bool bent_ = false;
};

}  // namespace

void describe(Described& to, PoseOptions& o) {
  constexpr double kLargest = 1e5;  // mm
  to.choice(
      "lens", &o.lens,
      std::array{LensModel::kPinhole, LensModel::kBrown, LensModel::kRational, LensModel::kFisheye},
      "which distortion is found");
  to.number("bar", &o.bar, from_to(0, kLargest), "mm",
            "length of the printed bar as a ruler measures it")
      .zero = "as the board says";
  to.number("height", &o.height, from_to(0, kLargest), "mm", "height of the box above the sheet")
      .zero = "the longer side of the free space, but no more than photographs show";
  to.number("margin", &o.margin, from_to(0, kLargest), "mm",
            "height of the box's lower side above the sheet");
  to.number("unit", &o.unit, above(0, kLargest), "mm", "unit of the scene's world").expects =
      "a length above 0: 1 for millimetres, 1000 for metres";
  to.flag("flat", &o.flat, "take the sheet for flat, and do not find out whether it is bent");
}

PoseResult pose_photographs(const std::vector<PosePhoto>& photos, const Sheet& sheet,
                            const PoseOptions& options) {
  check_options(options);
  check_bar(sheet, options.bar);
  return Poser(photos, sheet, options).run();
}

}  // namespace photohull
