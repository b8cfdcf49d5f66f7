// What a synthesized scene is made of.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "synth/shapes.h"

namespace photohull::synth {

/// The surface: a built-in shape or a mesh file, then scaled, turned (degrees about x, y and z, in
/// that order) and moved.
struct GeometrySpec {
  std::string shape = "sphere";  ///< empty where a mesh file is given
  ShapeValues parameters;        ///< complete, by name
  std::string mesh;              ///< path of a file; relative to the spec's folder
  double scale = 1;
  glm::dvec3 rotate{0.0};     ///< degrees
  glm::dvec3 translate{0.0};  ///< world units
};

/// What of the geometry changes over a sequence of frames: its values at the first frame, and those
/// that the frame after the last would have, so that a period closes. In between they change
/// evenly.
struct MotionSpec {
  std::map<std::string, std::array<double, 2>> parameters;  ///< of the built-in shape, by name
  std::vector<glm::dvec3> rotate;     ///< two in place of the geometry's, or none; degrees
  std::vector<glm::dvec3> translate;  ///< the same; world units

  bool empty() const { return parameters.empty() && rotate.empty() && translate.empty(); }
};

/// Which frame of a sequence is photographed.
struct MomentSpec {
  int frame = 0;   ///< counted from 0
  int frames = 1;  ///< of the sequence
};

struct MaterialSpec {
  glm::dvec3 base{0.55, 0.5, 0.42};  ///< linear reflectance
  std::string pattern = "noise";     ///< "noise" or "checker"
  double contrast = 0.8;             ///< 0 plain, 1 from black to twice the base colour
  double size = 0.12;                ///< coarsest details as a share of the object's diagonal
  int octaves = 5;                   ///< of noise, each twice as fine as the one before
  double gain = 0.7;                 ///< strength of an octave against the coarser one
  double chroma = 0.4;               ///< variation of hue, as contrast is of lightness
  double period_pixels = 0;          ///< checker: two fields in pixels of the mean camera; 0: size
  bool faces = false;                ///< another base colour for every plane
  double gloss = 0;                  ///< strength of the highlights
  double roughness = 0.25;           ///< of the highlights
  double haze = 0;                   ///< share of the colour that comes from below the surface
  double haze_depth = 0.03;          ///< along the line of sight, in diagonals
};

struct DirectionalLight {
  glm::dvec3 direction{0.4, -0.5, 0.75};  ///< towards the light, any length
  glm::dvec3 colour{0.75};
};

struct PointLight {
  glm::dvec3 position{0.0};  ///< in diagonals of the object from the middle of its box
  glm::dvec3 colour{0.5};    ///< as it arrives a diagonal away; falls with distance squared
};

constexpr const char* kShadowRays = "rays";

struct LightSpec {
  glm::dvec3 ambient{0.45};
  std::vector<DirectionalLight> directional = {DirectionalLight{}};
  std::vector<PointLight> point;
  bool shadows = true;
  std::string shadow_test = kShadowRays;  ///< exact rays, or a technique of visibility maps
  int shadow_texels = 1024;               ///< of a map, along each side
};

struct BackgroundSpec {
  std::string type = "colour";  ///< "colour" or "clutter"
  glm::dvec3 colour{0.0};       ///< linear
  double size = 0.35;           ///< of the clutter's patches as a share of the diagonal
  double distance = 2.5;        ///< of the clutter: radius of its sphere in camera distances
  bool moving = false;          ///< other clutter in every view
  bool plates = false;          ///< write photographs of the background without the object, too
};

/// A printed sheet that the object stands on (sheet/sheet.h).
struct SheetSpec {
  std::string board;     ///< path of the JSON that describes it, relative to the spec's folder
  double fill = 0.6;     ///< share of the free space's width or height that the object's box takes
  double print = 1;      ///< how large it is printed: 0.97 is 3 % too small
  glm::dvec3 bend{0.0};  ///< mm that it rises half its diagonal from the middle, by x^2, x y, y^2
  double hidden = 0;     ///< share of the tags that something lies on, others in every view
  /// Degrees about x, y and z, in that order, by which the object is turned, with its pattern, to
  /// lie on another side.
  glm::dvec3 turn{0.0};
};

struct ImageSpec {
  int width = 640, height = 480;
  int samples = 4;    ///< n x n rays a pixel, stratified
  int bits = 8;       ///< of the pictures: 8 or 16
  bool maps = true;   ///< write depth/ and normals/
  bool masks = true;  ///< write masks/
};

struct Ring {
  int count = 18;
  double elevation = 15;  ///< degrees above the horizon
  double phase = 0;       ///< turn, in steps of the ring
};

struct CameraSpec {
  std::string layout = "rings";  ///< "rings", "hemisphere", "arc" or "within"
  std::vector<Ring> rings = {{18, 10, 0}, {18, 40, 0.5}};
  int count = 36;                   ///< hemisphere, arc and within
  double lowest = 0, highest = 80;  ///< hemisphere: degrees of elevation
  double arc = 90;                  ///< degrees that the arc spans
  double azimuth = 0;               ///< degrees: of ring views 0, of the arc's middle
  double crowding = 1;              ///< rings: azimuths as its power of the share; 1 even
  double elevation = 15;            ///< of the arc, and of the places of within
  /// within: degrees that cameras turn from looking at the middle, dealt out in turn, and that they
  /// look down
  std::vector<double> turns = {0};
  double pitch = 0;
  double field_of_view = 75;            ///< within: degrees across the frame's width
  double distance = 1.8;                ///< from the middle of the box, in its diagonals
  std::vector<double> distances = {1};  ///< factors of the distance, dealt out in turn
  std::vector<double> focals = {1};     ///< factors of the focal length, dealt out in turn
  double fill = 0.8;                   ///< largest share of the frame's width or height in any view
  glm::dvec2 principal_offset{2, -1};  ///< pixels from the middle of the frame
  double roll = 0;                     ///< degrees, either way at random
  /// Object and sheet turn; lights and background stay, and the camera at azimuth 0 before them.
  bool turntable = false;
};

// Styles of masks.
constexpr const char* kCoverage = "coverage";
constexpr const char* kAliased = "aliased";
constexpr const char* kCut = "cut";
constexpr const char* kEroded = "eroded";

struct DegradationSpec {
  std::uint64_t seed = 0;                 ///< mixed with the scene's
  double photon_noise = 0;                ///< deviation at white, of 1 = white, linear light
  double read_noise = 0;                  ///< deviation at black
  double code_noise = 0;                  ///< deviation of the sRGB codes, of 255
  double blur = 0;                        ///< Gaussian deviation in pixels
  double edge_blur = 0;                   ///< more in the corners, growing with r^2, pixels
  double motion_blur = 0;                 ///< length in pixels, of some views
  double motion_blur_views = 0.25;        ///< share of the views, evenly over their order
  double exposure = 0;                    ///< deviation between views, stops
  double white_balance = 0;               ///< deviation of red and blue gain between views, stops
  double vignetting = 0;                  ///< share of light lost in the corners
  int jpeg = 0;                           ///< quality from 1 to 100; 0: none
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;  ///< lens distortion, Brown's model
  double pose_error = 0;                  ///< root mean square over object and views, pixels
  double intrinsics_error = 0;            ///< the same, by focal length and principal point
  glm::dvec2 pixel_shift{0.0};            ///< written principal points, pixels
  bool ignore_distortion = false;         ///< the written cameras have no distortion
  double wrong_views = 0;                 ///< share of the views whose written poses are wrong
  double wrong_turn = 30;                 ///< by so many degrees about the object's middle
  double view_shift = 0;                  ///< pixels that some written principal points are off
  double view_shift_views = 0;            ///< share of the views that these are
  double mask_grow = 0;                   ///< pixels that masks are too large; negative: too small
  std::string mask_style = kCoverage;     ///< "coverage", "aliased", "cut" or "eroded"
  double mask_cut = 0.5;                  ///< least coverage that "cut" and "eroded" keep
  int mask_holes = 0;                     ///< a mask
  double mask_hole_radius = 6;            ///< pixels
  std::vector<int> mask_wrong;            ///< views that get the next view's mask
  double missing = 0;                     ///< share of the views left out
  std::vector<int> missing_views;         ///< views left out, by index before any is
  int shuffle = 0;                        ///< order of the views; 0: as they were taken
  double box_scale = 1;                   ///< of the written box about its middle
  glm::dvec3 box_shift{0.0};              ///< of the written box, in the object's diagonals
};

struct Spec {
  std::string name = "scene";
  std::uint64_t seed = 1;
  GeometrySpec geometry;
  MotionSpec motion;
  MomentSpec moment;
  MaterialSpec material;
  LightSpec light;
  BackgroundSpec background;
  SheetSpec sheet;
  ImageSpec image;
  CameraSpec cameras;
  DegradationSpec degradations;
  int truth_samples = 200000;  ///< points of gt_visible.ply
};

inline constexpr int kMostViews = 2000;
inline constexpr int kMostFrames = 1000000;
inline constexpr int kLargestImage = 16384;  ///< pixels along a side
inline constexpr double kMostRays = 2e11;    ///< of a whole scene

/// Reads a spec from a JSON file. Every field is optional. Throws Error that names the file and
/// the field's path: of unknown fields (with the nearest known one), wrong types and values out of
/// range.
Spec read_spec(const std::filesystem::path& file);

/// The same from text; `source` opens messages, mesh paths are relative to `folder`.
Spec parse_spec(const std::string& text, const std::string& source,
                const std::filesystem::path& folder);

/// Every field with its value, as JSON that read_spec reads back to an equal spec. `extra` is a
/// JSON object about the result, kept under "result" and ignored by read_spec.
std::string spec_text(const Spec& spec, const std::string& extra = "{}");

/// Views before any goes missing.
int view_count(const CameraSpec& cameras);

/// Changes the numbers of views so that they sum to `count`; rings keep their shares. Throws
/// UsageError unless every ring keeps a view and count is at most kMostViews.
void set_view_count(CameraSpec& cameras, int count);

}  // namespace photohull::synth
