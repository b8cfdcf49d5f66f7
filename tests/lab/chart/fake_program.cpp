#include "fake_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace photohull::chart::test {

namespace fs = std::filesystem;

namespace {

constexpr const char* kProgram = R"sh(#!/bin/sh
here=$(dirname "$0")
echo "$1" >> "$here/calls"
command=$1
input=$2
shift 2
method=hull resolution=100 out=
while [ $# -gt 0 ]; do
  case $1 in
    --method) method=$2; shift ;;
    --resolution) resolution=$2; shift ;;
    --out) out=$2; shift ;;
    --crash) kill -SEGV $$ ;;
    --fail) echo "photohull: no such luck" >&2; exit 3 ;;
    --sleep) sleep 1000 ;;
    --mute) exit 0 ;;
  esac
  shift
done
case $command in
  reconstruct)
    mkdir -p "$out"
    echo "$method $resolution" > "$out/mesh.ply"
    echo '{"photohull": "0", "stages": [{"name": "views", "cpu_seconds": 1.5},
           {"name": "photo", "cpu_seconds": 4.5}]}'
    ;;
  evaluate)
    read -r method resolution < "$input"
    awk -v m="$method" -v n="$resolution" 'BEGIN {
      lack = 20 / n; if (m != "hull") lack /= 2
      printf "{\"seen\": {\"accuracy_pct_diag\": %.9f, \"f\": [{\"t\": 0.001, \"f\": %.9f},", 10 / n, 1 - 4 * lack
      printf "{\"t\": 0.0025, \"f\": %.9f}]}, \"completeness\": 0.9, \"recon_faces\": 12}\n", 1 - lack }'
    ;;
  synthesize)
    mkdir -p "$out"
    cp "$input" "$out/gt.ply"
    ;;
esac
)sh";

}  // namespace

FakeWorld::FakeWorld(const std::vector<std::string>& scenes) {
  write_text(program(), kProgram);
  fs::permissions(program(), fs::perms::owner_all);
  for (const std::string& scene : scenes) {
    fs::create_directory(folder_ / scene);
    write_text(folder_ / scene / "gt.ply", "truth of " + scene);
  }
}

void FakeWorld::plan(const std::string& json) const { write_text(folder_ / "plan.json", json); }

ChartOptions FakeWorld::options() const {
  ChartOptions options;
  options.plan = folder_ / "plan.json";
  options.output = out();
  options.program = program();
  return options;
}

ChartSummary FakeWorld::run() const { return run(options()); }

ChartSummary FakeWorld::run(const ChartOptions& options) const {
  Progress silent;
  return ChartJob(options).run(silent);
}

ChartSummary FakeWorld::run_and_draw(const ChartOptions& options) const {
  Progress silent;
  ChartJob job(options);
  ChartSummary summary = job.run(silent);
  job.draw(summary, silent);
  return summary;
}

int FakeWorld::calls(const std::string& command) {
  std::istringstream lines(read_text(folder_ / "calls"));
  int count = 0;
  for (std::string line; std::getline(lines, line);) count += line == command;
  return count;
}

void FakeWorld::forget_calls() { fs::remove(folder_ / "calls"); }

void Listener::stage(const std::string& name, double w) {
  stages.push_back(name);
  weight += w;
}

}  // namespace photohull::chart::test
