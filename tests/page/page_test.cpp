// The report's page as text: what is in it, how large it is, and that nothing of the scene becomes
// markup.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/image.h"
#include "page/make_batch_page.h"
#include "sample_page.h"
#include "unpacked.h"

namespace photohull::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

/// What stands inside the script element of that id.
std::string inside(const std::string& page, const std::string& id) {
  const std::size_t head = page.find("id=\"" + id + "\"");
  const std::size_t start = page.find('>', head) + 1;
  return page.substr(start, page.find("</script>", start) - start);
}

std::string sample_page(const TriMesh& mesh) {
  return page::make_page(sample_report(mesh), "photohull reconstruct " + std::string(kHostileName),
                         sample_shown(mesh));
}

TEST(BatchPage, KeepsNamesFromBecomingMarkup) {
  const page::ShownPiece pieces[] = {
      {R"({"name": "</script><script>alert(1)</script>"})", true, false},
      {R"({"name": "b", "verdict": "good"})", true, true}};
  const std::string page = page::make_batch_page(pieces);
  EXPECT_EQ(count_of(page, "<script"), 2u);
  EXPECT_THAT(inside(page, "data"),
              HasSubstr("\"verdict\":\"good\",\"preview\":true,\"page\":true"));
  EXPECT_THAT(page, Not(HasSubstr("@@")));
  const page::ShownPiece damaged[] = {{"[1]", false, false}};
  EXPECT_THROW(page::make_batch_page(damaged), Error);
}

TEST(ReportPage, KeepsTextsOfTheSceneFromBecomingMarkup) {
  const TriMesh ball = wrinkled_ball(8);
  const std::string page = sample_page(ball);
  const std::string nothing = page::make_page("{}", "", sample_shown(ball));
  EXPECT_EQ(count_of(page, "</script"), count_of(nothing, "</script"));
  EXPECT_EQ(count_of(page, "<script"), count_of(nothing, "<script"));
  EXPECT_THAT(page, Not(HasSubstr("<img src=x")));
  const std::string data = inside(page, "data");
  EXPECT_THAT(data, Not(HasSubstr("<")));
  const auto json = nlohmann::json::parse(data);
  EXPECT_EQ(json["report"]["warnings"][0], kHostileName);
  EXPECT_EQ(json["command"], "photohull reconstruct " + std::string(kHostileName));
}

TEST(ReportPage, TakesPathsThatAreNotUtf8) {
  const TriMesh ball = wrinkled_ball(8);
  page::Shown shown = sample_shown(ball);
  shown.views[0].name = "caf\xe9.jpg";
  const std::string page = page::make_page(sample_report(ball), "photohull \xff", shown);
  const auto json = nlohmann::json::parse(inside(page, "data"));
  EXPECT_EQ(json["views"][0]["name"], "caf\xef\xbf\xbd.jpg");
}

TEST(ReportPage, LoadsNothing) {
  const std::string page = sample_page(wrinkled_ball(8));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* from : {"src=\"http", "href=\"http", "@import", "url(http", "fetch("})
    EXPECT_THAT(page, Not(HasSubstr(from))) << from;
}

TEST(ReportPage, TellsTheReportWithoutWhatItDoesNotShow) {
  const TriMesh ball = wrinkled_ball(8);
  auto report = nlohmann::json::parse(sample_report(ball));
  report["inputs"] = {{{"path", "a.jpg"}}};
  report["device_work"] = {{"uploads", 1}};
  report["cameras"] = {{{"name", "a.jpg"}}};
  const std::string page = page::make_page(report.dump(), "", sample_shown(ball));
  report.erase("inputs");
  report.erase("device_work");
  report.erase("cameras");
  EXPECT_EQ(nlohmann::json::parse(inside(page, "data"))["report"], report);
}

TEST(ReportPage, RefusesAReportThatIsNotJson) {
  const TriMesh ball = wrinkled_ball(8);
  for (const char* bad : {"", "[]", "{\"a\":"})
    EXPECT_THROW(page::make_page(bad, "", sample_shown(ball)), Error) << bad;
}

TEST(ReportPage, HasTheViewsWithTheirPhotographs) {
  const TriMesh ball = wrinkled_ball(8);
  const page::Shown shown = sample_shown(ball);
  const auto json =
      nlohmann::json::parse(inside(page::make_page(sample_report(ball), "", shown), "data"));
  ASSERT_EQ(json["views"].size(), shown.views.size());
  EXPECT_EQ(json["first_view"], 1);
  for (std::size_t i = 0; i < shown.views.size(); ++i) {
    const auto& view = json["views"][i];
    EXPECT_EQ(from_base64(view["jpeg"]), shown.views[i].jpeg);
    // A point at the camera's depth 2 projects to the same pixel by what the page has.
    const Camera& camera = shown.views[i].camera;
    const glm::dvec3 point = camera.center() + 2.0 * camera.ray({30, 40});
    glm::dvec3 at(0);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        at[r] +=
            view["rotation"][r][c].get<double>() * (point[c] - view["centre"][c].get<double>());
    const double focal = view["focal"][0];
    EXPECT_NEAR(focal * at.x / at.z + view["principal"][0].get<double>(), 30, 1e-6);
    EXPECT_NEAR(focal * at.y / at.z + view["principal"][1].get<double>(), 40, 1e-6);
  }
}

TEST(ReportPage, StaysBelowThreeMegabytes) {
  const TriMesh ball = wrinkled_ball(316);  // 200 thousand triangles
  ASSERT_GT(ball.triangles.size(), 199000u);
  page::Shown shown = sample_shown(ball);
  // As many bytes of photographs as a reconstruction allows itself, which deflating does not help.
  shown.views[0].jpeg.assign(480000, 0);
  EXPECT_LT(page::make_page(sample_report(ball), "", shown).size(), 3000000u);
}

TEST(ReportPage, IsTheSameEveryTime) {
  const TriMesh ball = wrinkled_ball(40);
  EXPECT_EQ(sample_page(ball), sample_page(ball));
}

class EncodedModel : public testing::Test {
 protected:
  static constexpr int kRings = 20;
  const TriMesh ball_ = wrinkled_ball(kRings);
  const page::Shown shown_ = sample_shown(ball_);
  const Unpacked unpacked_ = unpack(shown_.model);

  glm::dvec3 position(std::uint32_t vertex) const {
    glm::dvec3 p;
    for (int c = 0; c < 3; ++c)
      p[c] = unpacked_.table["low"][c].get<double>() +
             unpacked_.table["step"].get<double>() *
                 double(unpacked_.streams.at("position")[3 * vertex + std::uint32_t(c)]);
    return p;
  }

  /// For each unpacked vertex the mesh's, by its place.
  std::vector<std::size_t> vertices_of_mesh() const {
    std::vector<std::size_t> found;
    const std::size_t count = unpacked_.table["vertices"];
    for (std::uint32_t v = 0; v < count; ++v) {
      std::size_t nearest = 0;
      for (std::size_t i = 1; i < ball_.positions.size(); ++i)
        if (glm::distance(ball_.world(i), position(v)) <
            glm::distance(ball_.world(nearest), position(v)))
          nearest = i;
      found.push_back(nearest);
    }
    return found;
  }
};

TEST_F(EncodedModel, HasTheMeshWithinItsSteps) {
  const std::vector<std::size_t> of_mesh = vertices_of_mesh();
  ASSERT_EQ(of_mesh.size(), ball_.positions.size());
  EXPECT_EQ(std::set<std::size_t>(of_mesh.begin(), of_mesh.end()).size(), of_mesh.size());
  const double step = unpacked_.table["step"];
  EXPECT_LT(step, 3.0 / 65535);
  for (std::uint32_t v = 0; v < of_mesh.size(); ++v) {
    const glm::dvec3 off = glm::abs(position(v) - ball_.world(of_mesh[v]));
    EXPECT_LT(std::max({off.x, off.y, off.z}), 0.51 * step);
    for (std::uint32_t c = 0; c < 3; ++c)
      EXPECT_NEAR(unpacked_.streams.at("colour")[3 * v + c] / 255.0,
                  srgb_from_linear(double(ball_.colours[of_mesh[v]][int(c)])), 0.51 / 255);
    EXPECT_NEAR(unpacked_.streams.at("confidence")[v] / 254.0, double(ball_.confidence[of_mesh[v]]),
                0.51 / 254);
    EXPECT_EQ(unpacked_.streams.at("views")[v],
              std::uint32_t(std::lround(6 * ball_.confidence[of_mesh[v]])));
    EXPECT_EQ(unpacked_.streams.at("disagreement")[v] == 255, ball_.confidence[of_mesh[v]] == 0);
  }
}

TEST_F(EncodedModel, HasTheSameTriangles) {
  const std::vector<std::size_t> of_mesh = vertices_of_mesh();
  const auto rotated = [](std::array<std::uint32_t, 3> t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  std::multiset<std::array<std::uint32_t, 3>> given, found;
  for (const auto& t : ball_.triangles) given.insert(rotated(t));
  for (const auto& [a, b, c] : unpacked_.triangles)
    found.insert(rotated({std::uint32_t(of_mesh.at(a)), std::uint32_t(of_mesh.at(b)),
                          std::uint32_t(of_mesh.at(c))}));
  EXPECT_EQ(found, given);
}

TEST(EncodedModels, OfMeshesWithoutColours) {
  TriMesh mesh = wrinkled_ball(4);
  mesh.colours.clear();
  const Unpacked unpacked = unpack(page::encode_model(mesh, {}));
  EXPECT_FALSE(unpacked.streams.contains("colour"));
  EXPECT_EQ(unpacked.triangles.size(), mesh.triangles.size());
}

TEST(EncodedModels, OfAMeshWithoutExtent) {
  TriMesh point;
  point.positions.assign(3, glm::vec3(2, 2, 2));
  point.triangles = {{0, 1, 2}};
  const Unpacked unpacked = unpack(page::encode_model(point, {}));
  EXPECT_EQ(unpacked.triangles.size(), 1u);
  EXPECT_EQ(unpacked.table["low"][0], 2.0);
}

}  // namespace
}  // namespace photohull::test
