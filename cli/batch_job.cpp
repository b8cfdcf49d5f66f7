#include "batch_job.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <new>
#include <numeric>
#include <optional>
#include <set>
#include <thread>

#include "batch_overview.h"
#include "cli/front/exit_code.h"
#include "core/error.h"
#include "kept_steps.h"
#include "make_model.h"
#include "piece_progress.h"
#include "pipeline/helper.h"
#include "pipeline/join_parts.h"
#include "pipeline/stage_clock.h"
#include "pipeline/stage_weights.h"
#include "reconstruct_scene.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;
using batch::Outcome;
using Clock = std::chrono::steady_clock;

/// The table is written this often, and rarer where that takes long: many processes that share a
/// file system would else do little but look for each other's results.
constexpr std::chrono::seconds kTableEvery(5);
constexpr std::chrono::milliseconds kAskAgain(1000);  ///< whether others have finished
constexpr std::chrono::milliseconds kAskSoon(50);     ///< whether they can be helped
constexpr int kTableShare = 50;  ///< of the time goes into tables at most: one in so many

class Batch {
 public:
  Batch(const std::vector<BatchPiece>& pieces, const batch::Store& store,
        const BatchOptions& options)
      : pieces_(pieces), store_(store), options_(options), progress_(total(pieces)) {
    for (const BatchPiece& piece : pieces) rows_.push_back({piece.name, {}});
  }

  void run() {
    try {
      make_all();
    } catch (const Cancelled&) {
      progress_.finish();
      write_table();
      throw;
    }
    progress_.finish();
    write_table();
    tell(rows_, made_before(), options_.json, store_);
  }

 private:
  static double total(const std::vector<BatchPiece>& pieces) {
    double sum = 0;
    for (const BatchPiece& piece : pieces) sum += pipeline::total_weight(piece.job);
    return sum;
  }

  /// Goes through the pieces again while some wait for what others have at hand, and once more at
  /// the end, for a process that had one may have been killed.
  void make_all() {
    std::vector<std::size_t> left(pieces_.size());
    std::iota(left.begin(), left.end(), 0);
    bool again = true;
    for (bool first = true; again && !left.empty(); first = false) {
      const std::vector<std::size_t> open = make_some(left, first);
      if (enough()) return;
      const bool waiting = std::ranges::any_of(open, [&](std::size_t i) {
        const Input input = state(pieces_[i]);
        return input == Input::kInOtherHands || (input == Input::kThere && options_.tiles > 0);
      });
      if (waiting && open.size() == left.size() && !help(open)) wait();
      again = first || waiting;
      left = open;
    }
    for (const std::size_t i : left) ++(state(pieces_[i]) == Input::kMissing ? early_ : elsewhere_);
  }

  /// Returns those that others are at work at, or that wait for such.
  std::vector<std::size_t> make_some(const std::vector<std::size_t>& some, bool first) {
    std::vector<std::size_t> open;
    for (const std::size_t i : some) {
      if (enough()) break;
      progress_.check_cancelled();
      const double weight = pipeline::total_weight(pieces_[i].job);
      PieceProgress progress(progress_, pieces_[i].name, first ? weight : 0, weight);
      if (state(pieces_[i]) != Input::kThere || !work_at(i, progress)) open.push_back(i);
      progress.finish();
      if (Clock::now() > next_table_) write_table();
    }
    return open;
  }

  /// Does what others can be helped with. False: there is nothing.
  bool help(const std::vector<std::size_t>& others) {
    if (options_.tiles == 0) return false;
    const std::size_t before = helped_;
    for (const std::size_t i : others) {
      const BatchPiece& piece = pieces_[i];
      if (beyond_help_.contains(piece.name)) continue;
      try {
        while (help_once(piece)) progress_.check_cancelled();
      } catch (const Error& problem) {
        progress_.warn(concat(piece.name, ": cannot help, for ", problem.what()));
        beyond_help_.insert(piece.name);
        drop_helper();
      }
    }
    return helped_ > before;
  }

  bool help_once(const BatchPiece& piece) {
    const std::filesystem::path folder = store_.tiles(piece.name);
    if (!pipeline::can_be_helped(folder)) return false;
    if (helping_ != piece.name) {
      drop_helper();
      helper_.emplace(folder, piece.job.device, piece.job.threads);
      helping_ = piece.name;
    }
    if (!helper_->help()) return false;
    if (helped_++ == 0) progress_.note("helping others with their tiles");
    return true;
  }

  /// Its device and photographs go: a thread has one device at a time.
  void drop_helper() {
    helper_.reset();
    helping_.clear();
  }

  void wait() {
    std::this_thread::sleep_for(options_.tiles > 0 ? kAskSoon : kAskAgain);
    progress_.check_cancelled();
  }

  /// Of the results of other pieces that a piece goes by.
  enum class Input { kThere, kInOtherHands, kMissing };

  Input state(const BatchPiece& piece) const {
    std::vector<std::string> names = piece.joins;
    for (const fs::path& folder : {piece.job.follow, piece.job.rig})
      if (auto name = store_.piece_of(folder)) names.push_back(*std::move(name));
    for (const std::string& name : names) {
      if (outcome_of(name)) continue;
      const bool mine =
          std::ranges::any_of(pieces_, [&](const BatchPiece& other) { return other.name == name; });
      return mine || !store_.hold(name) ? Input::kInOtherHands : Input::kMissing;
    }
    return Input::kThere;
  }

  /// What became of a piece, where this process has seen to it or somebody of the same plan has.
  std::optional<Outcome> outcome_of(const std::string& name) const {
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (pieces_[i].name == name) return rows_[i].outcome;
    auto made = store_.outcome(name);
    if (made && (options_.plan.empty() || made->plan != options_.plan)) made.reset();
    return made;
  }

  /// The piece without earlier results that there are none of.
  BatchPiece with_what_is_there(BatchPiece piece, PieceProgress& progress) const {
    for (std::filesystem::path* folder : {&piece.job.follow, &piece.job.rig}) {
      const auto name = store_.piece_of(*folder);
      if (!name || outcome_of(*name)->has_result()) continue;
      if (piece.job.part)
        throw Error(
            concat(*name, " has no result, of which this is a part: ", outcome_of(*name)->message));
      progress.note(*name + " has no result to go by");
      folder->clear();
    }
    return piece;
  }

  bool enough() const { return options_.most > 0 && made_ >= options_.most; }

  /// False where somebody else is at work at it.
  bool work_at(std::size_t i, PieceProgress& progress) {
    const BatchPiece& piece = pieces_[i];
    if (auto made = store_.outcome(piece.name); made && is_settled(piece, *made)) {
      ++kept_;
      rows_[i].outcome = std::move(made);
      return true;
    }
    const auto held = store_.hold(piece.name);
    if (!held) return false;
    drop_helper();
    const Outcome outcome = make(piece, progress);
    if (options_.sequence && outcome.has_result())
      store_.publish(piece.name, "volume.vdb", "volume." + piece.name + ".vdb");
    rows_[i].outcome = outcome;
    if (options_.json) std::printf("%s\n", to_json(piece.name, outcome).c_str());
    std::fflush(stdout);
    return true;
  }

  /// As it was made before, or now.
  Outcome make(const BatchPiece& given, PieceProgress& progress) {
    const auto start = Clock::now();
    const double cpu = pipeline::process_cpu_seconds();
    pipeline::forget_peak_memory();
    Outcome out;
    out.scene = given.scene;
    out.plan = options_.plan;
    try {
      const BatchPiece piece = with_what_is_there(given, progress);
      out.identity = identity_of(piece);
      if (auto before = store_.outcome(piece.name); before && is_kept(piece, *before, out)) {
        ++kept_;
        before->plan = options_.plan;
        store_.set_outcome(piece.name, *before);
        return *before;
      }
      if (piece.joins.empty())
        reconstruct(piece, progress, out);
      else
        join(piece, progress, out);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& e) {
      out.exit_code = exit_code(e.kind());
      out.message = e.what();
    } catch (const std::bad_alloc&) {
      out.exit_code = exit_code(ErrorKind::kMemory);
      out.message = "there is not enough memory";
    }
    store_.remove_tiles(given.name);
    if (!out.has_result()) progress.warn(out.message);
    const std::chrono::duration<double> elapsed = Clock::now() - start;
    out.wall_seconds = elapsed.count();
    out.cpu_seconds = pipeline::process_cpu_seconds() - cpu;
    out.peak_memory_bytes = pipeline::process_peak_memory();
    store_.set_outcome(given.name, out);
    ++made_;
    return out;
  }

  /// Was it made, or found to be made, for the same plan?
  bool is_settled(const BatchPiece& piece, const Outcome& made) const {
    if (piece.job.fresh || options_.plan.empty() || made.plan != options_.plan) return false;
    return made.has_result() || !options_.retry;
  }

  bool is_kept(const BatchPiece& piece, const Outcome& before, const Outcome& now) const {
    if (piece.job.fresh || before.identity != now.identity) return false;
    return before.has_result() ? has_results(store_.results(piece.name)) : !options_.retry;
  }

  std::string identity_of(const BatchPiece& piece) const {
    if (piece.joins.empty())
      return model_identity(piece.job, piece.load, piece.scene, store_.results(piece.name));
    StepIdentity identity;
    for (const fs::path& part : folders_of(piece.joins)) identity.add_file(part / "report.json");
    return identity.digest();
  }

  std::vector<fs::path> folders_of(const std::vector<std::string>& names) const {
    std::vector<fs::path> out;
    for (const std::string& name : names) out.push_back(store_.results(name));
    return out;
  }

  void join(const BatchPiece& piece, PieceProgress& progress, Outcome& out) {
    for (const std::string& name : piece.joins)
      if (const auto part = outcome_of(name); !part || !part->has_result())
        throw Error(concat(name, " has no result, without which the parts cannot be joined",
                           part ? ": " + part->message : std::string()));
    progress.stage("join", 1);
    const std::vector<fs::path> all = folders_of(piece.joins);
    const pipeline::JoinedParts joined =
        pipeline::join_parts(all.front(), {all.begin() + 1, all.end()}, store_.results(piece.name),
                             piece.job.max_memory, progress);
    take_verdict(joined.verdict.verdict, out);
    out.views = joined.views;
    out.voxel_size = joined.voxel_size;
    out.triangles = joined.triangles;
  }

  static void take_verdict(const assess::Verdict& verdict, Outcome& out) {
    out.verdict = assess::to_string(verdict.level);
    if (!verdict.reasons.empty()) out.message = verdict.reasons.front();
    if (verdict.level == assess::Level::kFailed) out.exit_code = exit_code(ErrorKind::kDoubted);
  }

  void reconstruct(const BatchPiece& piece, PieceProgress& progress, Outcome& out) {
    io::LoadSceneOptions load = piece.load;
    load.most_views = io::kEnoughViews;
    pipeline::ReconstructOptions job = piece.job;
    if (options_.tiles > 0) job.tiles = {store_.tiles(piece.name), options_.tiles};
    const MadeModel made = make_model(job, load, piece.scene, store_.results(piece.name), progress);
    take_verdict(made.verdict.verdict, out);
    out.views = made.views;
    out.voxel_size = made.voxel_size;
    out.triangles = made.triangles;
  }

  void write_table() {
    const auto start = Clock::now();
    fill(rows_, store_);
    if (options_.table) write_overview(rows_, store_);
    const auto end = Clock::now();
    next_table_ = end + std::max<Clock::duration>(kTableEvery, kTableShare * (end - start));
  }

  std::string made_before() const {
    std::string text = concat(", ", kept_, " of them made before");
    if (elsewhere_ > 0)
      text += concat("; other processes were at work at ", elsewhere_,
                     ", run this again for the table of all");
    if (early_ > 0)
      text += concat("; ", early_, " go by others that are not made yet and were not asked for");
    return text;
  }

  const std::vector<BatchPiece>& pieces_;
  const batch::Store& store_;
  const BatchOptions& options_;
  TerminalProgress progress_;
  std::vector<batch::Row> rows_;
  Clock::time_point next_table_ = Clock::now() + kTableEvery;
  std::string helping_;  // the piece that helper_ is for
  std::optional<pipeline::Helper> helper_;
  std::set<std::string> beyond_help_;  // pieces that this process cannot help with
  std::size_t helped_ = 0;             // tiles
  int made_ = 0, kept_ = 0, elsewhere_ = 0, early_ = 0;
};

}  // namespace

void run_batch(const std::vector<BatchPiece>& pieces, const batch::Store& store,
               const BatchOptions& options) {
  Batch(pieces, store, options).run();
}

}  // namespace photohull::cli
