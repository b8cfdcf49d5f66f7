#include "texture/label_faces.h"

#include <gtest/gtest.h>

#include "scenes.h"
#include "texture/seams.h"
#include "texture/surface.h"

namespace photohull::texture {
namespace {

/// Views 0 and 1 for every triangle, with these qualities.
FaceViews two_views(const TriMesh& mesh,
                    const std::function<std::array<float, 2>(std::size_t)>& quality) {
  FaceViews views;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    views.first.push_back(views.views.size());
    views.clear.push_back(1);
    views.views.push_back({0, quality(f)[0]});
    views.views.push_back({1, quality(f)[1]});
  }
  views.first.push_back(views.views.size());
  return views;
}

const TriMesh& sphere() {
  static const TriMesh mesh = mesh_of({{0, 0, 0}, 1, plain(glm::dvec3(0.5))}, 4);
  return mesh;
}

/// z of a triangle's middle.
float height(std::size_t f) {
  const auto& [a, b, c] = sphere().triangles[f];
  return (sphere().positions[a].z + sphere().positions[b].z + sphere().positions[c].z) / 3;
}

TEST(LabelFaces, TheBetterViewWinsWhereItIsClearlyBetter) {
  Progress progress;
  const auto labels = label_faces(
      sphere(), neighbours_of(sphere()),
      two_views(sphere(),
                [](std::size_t f) {
                  return height(f) > 0 ? std::array{1.0f, 0.3f} : std::array{0.3f, 1.0f};
                }),
      2, 0.01, progress);
  for (std::size_t f = 0; f < labels.size(); ++f) {
    EXPECT_EQ(labels[f], height(f) > 0 ? 0 : 1);
  }
}

TEST(LabelFaces, SpecksAndCheckersDoNotPayForTheirSeams) {
  Progress progress;
  const auto labels =
      label_faces(sphere(), neighbours_of(sphere()),
                  two_views(sphere(),
                            [](std::size_t f) {
                              return f % 3 == 0 ? std::array{0.9f, 1.0f} : std::array{1.0f, 0.9f};
                            }),
                  2, 0.05, progress);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 0), std::ptrdiff_t(labels.size()));
}

TEST(LabelFaces, WhatNoCameraFacesHasNone) {
  Progress progress;
  FaceViews none;
  none.first.assign(sphere().triangles.size() + 1, 0);
  none.clear.assign(sphere().triangles.size(), 0);
  const auto labels = label_faces(sphere(), neighbours_of(sphere()), none, 2, 0.05, progress);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), kUnseen), std::ptrdiff_t(labels.size()));
}

TEST(Neighbours, AreAcrossEachSide) {
  const auto neighbours = neighbours_of(sphere());
  for (std::size_t f = 0; f < neighbours.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = neighbours[f][std::size_t(i)];
      ASSERT_NE(other, kNoFace);
      const auto& t = sphere().triangles[f];
      const auto& o = sphere().triangles[other];
      for (const std::uint32_t v : {t[std::size_t(i)], t[std::size_t((i + 1) % 3)]})
        EXPECT_NE(std::find(o.begin(), o.end(), v), o.end());
    }
  TriMesh fan = sphere();  // three triangles at a side: none is the neighbour of another there
  fan.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_EQ(neighbours_of(fan)[0][0], kNoFace);
}

}  // namespace
}  // namespace photohull::texture
