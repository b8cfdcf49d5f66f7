#include "piece_progress.h"

#include <algorithm>
#include <utility>

namespace photohull::cli {

PieceProgress::PieceProgress(Progress& whole, std::string name, double weight, double own,
                             std::set<std::string>* said)
    : Progress(whole.token()),
      whole_(whole),
      name_(std::move(name)),
      left_(weight),
      scale_(own > 0 ? weight / own : 0),
      said_(said) {}

void PieceProgress::stage(const std::string& name, double weight) {
  const double share = std::min(scale_ * weight, left_);
  left_ -= share;
  whole_.stage(name_ + ": " + name, share);
}

void PieceProgress::update(double fraction) { whole_.update(fraction); }

void PieceProgress::warn(const std::string& message) {
  if (is_new(message)) whole_.warn(name_ + ": " + message);
}

void PieceProgress::note(const std::string& message) {
  if (is_new(message)) whole_.note(name_ + ": " + message);
}

bool PieceProgress::is_new(const std::string& message) {
  return !said_ || said_->insert(message).second;
}

void PieceProgress::finish() {
  if (left_ <= 0) return;
  whole_.stage(name_, left_);
  whole_.update(1);
}

}  // namespace photohull::cli
