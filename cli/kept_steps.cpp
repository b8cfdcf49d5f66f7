#include "kept_steps.h"

#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <span>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_levels.h"
#include "pipeline/identity_text.h"
#include "pipeline/input_hashes.h"

namespace photohull::cli {

namespace fs = std::filesystem;
using nlohmann::json;

StepIdentity::StepIdentity() { pipeline::add_program(text_); }

void StepIdentity::add(const std::string& text) { text_ << std::quoted(text) << '\n'; }

void StepIdentity::add_file(const fs::path& file) {
  add(fs::absolute(file).lexically_normal().string());
  add(pipeline::digest_of_file(file));
}

void StepIdentity::add_options(const Described& described) {
  for (const Option& option : described.options())
    add(concat(option.name, " ", text_of(option, pipeline::kIdentityDigits)));
}

std::string StepIdentity::digest() const {
  const std::string all = text_.str();
  return pipeline::digest_of({reinterpret_cast<const std::uint8_t*>(all.data()), all.size()});
}

KeptSteps::KeptSteps(fs::path file) : file_(std::move(file)) {
  try {
    std::ifstream stream(file_);
    if (stream) json::parse(stream, json_level_guard(file_.string())).get_to(steps_);
  } catch (const json::exception&) {
  } catch (const Error&) {
  }
  write();
}

bool KeptSteps::has(const std::string& step, const std::string& identity) const {
  const auto found = steps_.find(step);
  return found != steps_.end() && found->second == identity;
}

void KeptSteps::begin(const std::string& step) {
  if (steps_.erase(step) > 0) write();
}

void KeptSteps::done(const std::string& step, const std::string& identity) {
  steps_[step] = identity;
  write();
}

void KeptSteps::write() const { write_atomically(file_, json(steps_).dump(1) + "\n"); }

}  // namespace photohull::cli
