#include "texture/label_faces.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc/detail/gcgraph.hpp>

#include "texture/surface.h"

namespace photohull::texture {
namespace {

constexpr int kMostRounds = 4;

class Labelling {
 public:
  Labelling(const TriMesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
            const FaceViews& views, double seam)
      : neighbours_(neighbours), views_(views), node_(mesh.triangles.size(), -1) {
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      area_.push_back(0.5 * glm::length(double_area(mesh, f)));
      std::array<double, 3> prices{};
      for (int i = 0; i < 3; ++i)
        prices[std::size_t(i)] =
            seam * glm::distance(mesh.positions[mesh.triangles[f][i]],
                                 mesh.positions[mesh.triangles[f][(i + 1) % 3]]);
      price_.push_back(prices);
      labels_.push_back(best(f));
    }
  }

  /// Lets triangles change to `alpha` wherever that lowers the sum. Did any?
  bool expand(std::int32_t alpha) {
    collect(alpha);
    if (faces_.empty()) return false;
    cv::detail::GCGraph<double> graph(unsigned(faces_.size() + 2), unsigned(3 * faces_.size() + 1));
    for (std::size_t n = 0; n < faces_.size() + 2; ++n) graph.addVtx();
    graph.addEdges(int(faces_.size()), int(faces_.size() + 1), 0, 0);  // it must have one
    for (std::size_t n = 0; n < faces_.size(); ++n) add(int(n), alpha, graph);
    graph.maxFlow();
    bool changed = false;
    for (std::size_t n = 0; n < faces_.size(); ++n) {
      node_[faces_[n]] = -1;
      if (graph.inSourceSegment(int(n))) continue;
      labels_[faces_[n]] = alpha;
      changed = true;
    }
    return changed;
  }

  std::vector<std::int32_t> take() { return std::move(labels_); }

 private:
  std::int32_t best(std::size_t face) const {
    std::int32_t view = kUnseen;
    float quality = -1;
    for (const FaceView& v : views_.of(face))
      if (v.quality > quality) {
        view = std::int32_t(v.view);
        quality = v.quality;
      }
    return view;
  }

  double cost(std::size_t face, std::int32_t view) const {
    for (const FaceView& v : views_.of(face))
      if (std::int32_t(v.view) == view) return area_[face] * (1 - std::sqrt(double(v.quality)));
    return area_[face];
  }

  /// The triangles that could have the label, and do not.
  void collect(std::int32_t alpha) {
    faces_.clear();
    costs_.clear();
    for (std::size_t f = 0; f < labels_.size(); ++f) {
      if (labels_[f] == alpha) continue;
      for (const FaceView& v : views_.of(f))
        if (std::int32_t(v.view) == alpha) {
          node_[f] = std::int32_t(faces_.size());
          faces_.push_back(std::uint32_t(f));
          costs_.push_back(area_[f] * (1 - std::sqrt(double(v.quality))));
        }
    }
  }

  /// A triangle in the source's part keeps its label.
  void add(int node, std::int32_t alpha, cv::detail::GCGraph<double>& graph) const {
    const std::uint32_t face = faces_[std::size_t(node)];
    const std::int32_t label = labels_[face];
    double keep = cost(face, label), change = costs_[std::size_t(node)];
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = neighbours_[face][std::size_t(i)];
      if (other == kNoFace) continue;
      const double price = price_[face][std::size_t(i)];
      const double kept = labels_[other] != label ? price : 0;
      if (node_[other] < 0) {
        keep += kept;
        change += labels_[other] != alpha ? price : 0;
      } else if (node_[other] > node) {
        // kept where both stay, the price where one of them does, nothing where both change
        // [KolmogorovZabih04].
        change += price - kept;
        graph.addTermWeights(node_[other], -price, 0);
        graph.addEdges(node, node_[other], 2 * price - kept, 0);
      }
    }
    graph.addTermWeights(node, change, keep);
  }

  const std::vector<std::array<std::uint32_t, 3>>& neighbours_;
  const FaceViews& views_;
  std::vector<double> area_;
  std::vector<std::array<double, 3>> price_;  // of a seam along each side
  std::vector<std::int32_t> labels_;
  std::vector<std::int32_t> node_;  // of each triangle in the graph; -1: none
  std::vector<std::uint32_t> faces_;
  std::vector<double> costs_;
};

}  // namespace

std::vector<std::int32_t> label_faces(const TriMesh& mesh,
                                      const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                                      const FaceViews& views, std::size_t view_count, double seam,
                                      Progress& progress) {
  Labelling labelling(mesh, neighbours, views, seam);
  for (int round = 0; round < kMostRounds; ++round) {
    bool changed = false;
    for (std::size_t v = 0; v < view_count; ++v) {
      progress.check_cancelled();
      changed |= labelling.expand(std::int32_t(v));
    }
    if (!changed) break;
  }
  return labelling.take();
}

}  // namespace photohull::texture
