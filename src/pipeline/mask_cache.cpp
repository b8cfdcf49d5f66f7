#include "pipeline/mask_cache.h"

#include <zlib.h>

#include <fstream>
#include <iomanip>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/option_word.h"
#include "masks/find_masks.h"
#include "pipeline/identity_text.h"
#include "pipeline/input_hashes.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

/// Of all that find_masks goes by.
std::string identity_of(const Scene& scene, bool cut, const std::vector<MaskOrigin>& origins,
                        const PreparedViews& prepared) {
  std::ostringstream text;
  add_program(text);
  text << cut << '\n';
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const SourceView& source = scene.views[i];
    const ColourImage& image = prepared.views[i].image;
    text << std::quoted(source.name) << ' ' << int(origins[i]) << ' ' << source.silhouette << ' '
         << image.width << ' ' << image.height << ' ' << int(image.encoding) << ' '
         << digest_of(image.bytes) << '\n';
    if (!source.plate.empty()) add_file(source.plate, text);
  }
  const std::string all = text.str();
  return digest_of({reinterpret_cast<const std::uint8_t*>(all.data()), all.size()});
}

Bytes deflated(const Bytes& bytes) {
  uLongf size = compressBound(bytes.size());
  Bytes out(size);
  const int status = compress2(out.data(), &size, bytes.data(), bytes.size(), Z_BEST_SPEED);
  PHOTOHULL_CHECK(status == Z_OK);
  out.resize(size);
  return out;
}

Bytes inflated(const Bytes& bytes, std::size_t size) {
  Bytes out(size);
  uLongf written = size;
  if (uncompress(out.data(), &written, bytes.data(), bytes.size()) != Z_OK || written != size)
    throw Error("a mask does not have its size");
  return out;
}

/// What find_masks did to `prepared` and `origins`, `warnings` of which there were before.
json outcome(const std::vector<MaskOrigin>& before, std::size_t warnings,
             const std::vector<MaskOrigin>& origins, const PreparedViews& prepared) {
  json masks = json::array();
  for (std::size_t i = 0; i < origins.size(); ++i)
    if (origins[i] != before[i])
      masks.push_back({{"view", i},
                       {"origin", int(origins[i])},
                       {"confidence", prepared.masks[i].confidence},
                       {"coverage", json::binary(deflated(prepared.views[i].mask.coverage))}});
  const std::vector<std::string> added(prepared.warnings.begin() + long(warnings),
                                       prepared.warnings.end());
  return {{"masks", masks}, {"warnings", added}};
}

/// Does to `prepared` and `origins` what find_masks did. Throws json::exception or Error, and
/// leaves them, where `kept` is not such an outcome.
void repeat(const json& kept, std::vector<MaskOrigin>& origins, PreparedViews& prepared) {
  struct Taken {
    std::size_t view;
    MaskOrigin origin;
    double confidence;
    Mask mask;
  };
  std::vector<Taken> taken;
  for (const json& one : kept.at("masks")) {
    const auto view = one.at("view").get<std::size_t>();
    const int origin = one.at("origin").get<int>();
    if (view >= origins.size() ||
        (origin != int(MaskOrigin::kPlate) && origin != int(MaskOrigin::kBackground)))
      throw Error("a mask of no view");
    const ColourImage& image = prepared.views[view].image;
    const auto pixels = std::size_t(image.width) * std::size_t(image.height);
    taken.push_back(
        {view,
         MaskOrigin(origin),
         one.at("confidence").get<double>(),
         {image.width, image.height, inflated(one.at("coverage").get_binary(), pixels)}});
  }
  const auto warnings = kept.at("warnings").get<std::vector<std::string>>();
  for (Taken& one : taken) {
    origins[one.view] = one.origin;
    prepared.masks[one.view].confidence = one.confidence;
    prepared.views[one.view].mask = std::move(one.mask);
  }
  prepared.warnings.insert(prepared.warnings.end(), warnings.begin(), warnings.end());
}

/// The outcomes by their identities; more than one where photographs were decoded once more.
class Kept {
 public:
  Kept(fs::path file, bool fresh, Progress& progress)
      : file_(std::move(file)), progress_(progress) {
    std::ifstream stream(file_, std::ios::binary);
    if (fresh || !stream) return;
    const Bytes bytes{std::istreambuf_iterator<char>(stream), {}};
    before_ = json::from_cbor(bytes, true, false);
    if (!before_.is_object()) say_damaged();
  }

  bool take(const std::string& identity, std::vector<MaskOrigin>& origins,
            PreparedViews& prepared) {
    const json& all = now_.contains(identity) ? now_ : before_;
    if (!all.contains(identity)) return false;
    try {
      repeat(all[identity], origins, prepared);
    } catch (const json::exception&) {
      return say_damaged();
    } catch (const Error&) {
      return say_damaged();
    }
    if (!now_.contains(identity)) now_[identity] = before_[identity];
    return true;
  }

  void keep(const std::string& identity, json outcome) {
    now_[identity] = std::move(outcome);
    const Bytes bytes = json::to_cbor(now_);
    write_atomically(file_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

 private:
  bool say_damaged() {
    progress_.warn(concat(file_.string(), ": damaged, so that masks are made anew"));
    before_ = json::object();
    return false;
  }

  fs::path file_;
  Progress& progress_;
  json before_ = json::object(), now_ = json::object();
};

}  // namespace

MaskFinder find_masks_once(const fs::path& folder, bool fresh, Progress& progress) {
  auto kept = std::make_shared<Kept>(folder / ".photohull-masks", fresh, progress);
  return [kept, &progress](const Scene& scene, const ViewLoader& loader, bool cut,
                           std::vector<MaskOrigin>& origins, PreparedViews& prepared) {
    const std::string identity = identity_of(scene, cut, origins, prepared);
    if (kept->take(identity, origins, prepared)) {
      progress.note(concat("the masks are those that the run before made (", option_word("fresh"),
                           " makes them anew)"));
      return;
    }
    const std::vector<MaskOrigin> before = origins;
    const std::size_t warnings = prepared.warnings.size();
    find_masks(scene, loader, cut, origins, prepared);
    json made = outcome(before, warnings, origins, prepared);
    if (!made["masks"].empty()) kept->keep(identity, std::move(made));
  };
}

}  // namespace photohull::pipeline
