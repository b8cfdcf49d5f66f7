#include "refine/contacts.h"

#include <gtest/gtest.h>

#include "refine/outlines.h"

namespace photohull::refine {
namespace {

using glm::dvec3;

std::vector<Contact> contacts_of(const Surface& surface, const BallViews& views,
                                 double reach = 1.5) {
  return find_contacts(surface.volume.grid, surface.mesh, surface.positions, surface.mesh.normals,
                       {views.cameras(), views.silhouettes()}, reach);
}

dvec3 place_of(const Surface& surface, const Contact& contact) {
  return glm::mix(dvec3(surface.positions[contact.a]), dvec3(surface.positions[contact.b]),
                  double(contact.along));
}

TEST(FindContacts, TellsHowFarTheSurfaceIsShortOfItsOutline) {
  const BallViews views(8);
  for (const double radius : {9.2, 9.7, 10.0, 10.4}) {
    const auto contacts = contacts_of(Surface(sphere(kCentre, radius)), views);
    ASSERT_GT(contacts.size(), 8 * 60u) << radius;  // a circle of 60 voxels in each view
    for (const Contact& contact : contacts) {
      EXPECT_NEAR(contact.lack, kRadius - radius, 0.06) << radius;
      EXPECT_LE(contact.least, contact.lack);
      EXPECT_NEAR(contact.least, contact.lack, 0.06);
      EXPECT_EQ(contact.unsure, 0);
    }
  }
}

TEST(FindContacts, LieWhereTheSurfaceTurnsFromTheCamera) {
  const BallViews views({test::look_at(kCentre + dvec3(60, 0, 0), kCentre, 240, 160, 160)});
  const Surface surface(sphere(kCentre, 9.5));
  for (const Contact& contact : contacts_of(surface, views)) {
    const dvec3 at = place_of(surface, contact) - kCentre;
    EXPECT_NEAR(at.x, 9.5 * 9.5 / 60, 0.1);  // the circle of the tangents
    EXPECT_GE(contact.along, 0);
    EXPECT_LE(contact.along, 1);
  }
}

TEST(FindContacts, WhatIsFarShortIsNone) {
  const BallViews views(6);
  EXPECT_TRUE(contacts_of(Surface(sphere(kCentre, 8)), views).empty());
  EXPECT_FALSE(contacts_of(Surface(sphere(kCentre, 8)), views, 2.5).empty());
}

TEST(FindContacts, PixelsOfTwoVoxelsReachTwiceAsFar) {
  const BallViews views(test::cameras_around(kCentre, 60, 6, 30, 24, 24));
  EXPECT_FALSE(contacts_of(Surface(sphere(kCentre, 8)), views).empty());
  for (const Contact& contact : contacts_of(Surface(sphere(kCentre, 8)), views))
    EXPECT_NEAR(contact.lack, 2, 0.3);
  EXPECT_TRUE(contacts_of(Surface(sphere(kCentre, 6.5)), views).empty())
      << "beyond the volume's band";
}

TEST(FindContacts, SharpEdgesHaveThem) {
  // A cube of edge 20 seen along z shows more than the ball but at its sides' middles.
  const BallViews views(
      {test::look_at(kCentre + dvec3(0, 0, 60), kCentre, 240, 160, 160, {0, -1, 0})});
  const Surface cube(box(kCentre - 8.6, kCentre + 8.6));
  const auto contacts = contacts_of(cube, views);
  EXPECT_GT(contacts.size(), 10u);
  for (const Contact& contact : contacts) {
    const dvec3 at = glm::abs(place_of(cube, contact) - kCentre);
    EXPECT_GT(std::max(at.x, at.y), 8.2);
  }
}

// Two balls, one behind the other: the farther fills the outline, the nearer is half a voxel short.
TEST(FindContacts, KnowsWhatElseIsAtTheOutline) {
  const dvec3 eye = kCentre + dvec3(4000, 0, 0);
  const BallViews views({test::look_at(eye, kCentre, 16000, 160, 160)});
  // Halves at either side of the middle, so that both have a rim of their own.
  const auto halves = [](const dvec3& p) {
    const double far = std::max(
        glm::length((p - kCentre + dvec3(4, 0, 0)) / dvec3(0.4, 1, 1)) - kRadius, p.x - kCentre.x);
    const double near =
        std::max(glm::length((p - kCentre - dvec3(4, 0, 0)) / dvec3(0.4, 1, 1)) - kRadius + 0.5,
                 kCentre.x - p.x);
    return std::min(far, near);
  };
  const Surface surface(halves);
  int nearer = 0, farther = 0;
  for (const Contact& contact : contacts_of(surface, views)) {
    if (place_of(surface, contact).x > kCentre.x + 2) {
      ++nearer;
      EXPECT_GT(contact.lack, 0.25);
      EXPECT_LT(contact.least, contact.lack - 0.2);
    } else if (place_of(surface, contact).x < kCentre.x - 2) {
      ++farther;
      EXPECT_NEAR(contact.least, contact.lack, 0.1);
    }
  }
  EXPECT_GT(nearer, 30);
  EXPECT_GT(farther, 30);
}

TEST(FindContacts, MadeMasksAreUnsureByAPixel) {
  const BallViews views({test::look_at(kCentre + dvec3(60, 0, 0), kCentre, 240, 160, 160)}, true);
  const auto contacts = contacts_of(Surface(sphere(kCentre, 9.7)), views);
  ASSERT_FALSE(contacts.empty());
  for (const Contact& contact : contacts) EXPECT_NEAR(contact.unsure, 0.25, 0.02);  // voxels
}

TEST(FindContacts, ViewsWithoutSilhouettesSayNothing) {
  const BallViews views(3);
  const Surface surface(sphere(kCentre, 9.7));
  const std::vector<carving::Silhouette> none(3);
  EXPECT_TRUE(find_contacts(surface.volume.grid, surface.mesh, surface.positions,
                            surface.mesh.normals, {views.cameras(), none}, 1.5)
                  .empty());
}

}  // namespace
}  // namespace photohull::refine
