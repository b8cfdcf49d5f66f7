// How well a mesh predicts photographs that were not used to make it. Definitions in
// docs/guide/evaluate.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "core/progress.h"
#include "eval/predict_photo.h"

namespace photohull::eval {

struct PhotoOptions {
  PredictOptions predict;
  int window = 7;  ///< edge of the windows compared, pixels; odd

  /// Throws UsageError naming the option.
  void validate() const;
};

void describe(Described& to, PhotoOptions& options);

/// One held-out photograph, or all of them together. The foreground is what the mask covers by half
/// or more, all of the photograph where there is none; pixels that were not photographed (alpha 0)
/// count nowhere.
struct PhotoScore {
  std::string view;  ///< its name; empty for all together
  bool masked = false;
  std::int64_t pixels = 0;                   ///< photographed
  std::int64_t foreground = 0;               ///< of these
  std::int64_t projected = 0;                ///< of `pixels`, onto which the mesh projects
  std::int64_t covered = 0;                  ///< of the foreground, onto which it projects
  std::int64_t predicted = 0;                ///< of `covered`, which lending views see too
  std::int64_t judged = 0;                   ///< of the foreground, whose windows hold texture
  std::int64_t judged_predicted = 0;         ///< of these, in `predicted`
  double score_sum = 0;                      ///< of ZNCC over `judged`
  double squared_sum = 0, absolute_sum = 0;  ///< of differences over `predicted`, see below

  /// Mean ZNCC over all `judged` pixels, those without prediction as 0: the figure to compare
  /// meshes by. Nothing when no window holds texture.
  std::optional<double> zncc() const;
  /// Mean ZNCC over the judged pixels that are predicted.
  std::optional<double> zncc_predicted() const;
  /// Of `predicted` pixels, values sRGB-encoded in [0, 1], the mean over channels; dB.
  std::optional<double> psnr() const;
  std::optional<double> mean_difference() const;
  /// Shares in [0, 1]; of the foreground.
  std::optional<double> coverage() const, predicted_share() const;
  /// Of the mesh's projection, on background; nothing without masks.
  std::optional<double> excess() const;
  /// Of the mesh's projection and the foreground; nothing without masks.
  std::optional<double> silhouette_iou() const;

  void add(const PhotoScore& other);
};

struct PhotoAgreement {
  PhotoOptions options;
  std::string result_name, scene, mask_source;  ///< as the caller names them
  std::string photometric;           ///< how the photographs were made alike; empty: they were not
  std::size_t lenders = 0;           ///< photographs that lent colour
  std::vector<PhotoScore> views;     ///< held out, in the order asked for
  PhotoScore all;                    ///< sums of them; masked when all are
  std::optional<std::size_t> worst;  ///< of `views`, by zncc
  std::vector<std::string> warnings;
};

/// What was compared, for pictures.
struct PhotoMaps {
  std::size_t view = 0;  ///< index into the views given
  Prediction prediction;
  std::vector<std::uint8_t> foreground;
  std::vector<float> scores;  ///< ZNCC, NaN where nothing is judged
};

/// Predicts each held-out photograph from the mesh and the lending ones (predict_photo), and
/// compares, by windows (window_agreement) of square roots of linear light. The floor of the
/// variance is that of three times the photograph's noise, of 8-bit rounding at least. After
/// [Waechter17]. Indices go into `views`; none may be in both lists. `worst`, where given, gets the
/// maps of the worst view.
///
/// Equal input gives equal output, whatever the number of threads. Throws Error when the mesh has
/// no faces or a coordinate that is not finite, or when no held-out view sees it; UsageError for
/// options out of range or lists that are empty or overlap; Cancelled.
PhotoAgreement judge_by_photographs(const TriMesh& mesh, std::span<const PreparedView> views,
                                    std::span<const std::size_t> held_out,
                                    std::span<const std::size_t> lenders,
                                    const PhotoOptions& options = {}, Progress* progress = nullptr,
                                    PhotoMaps* worst = nullptr);

}  // namespace photohull::eval
