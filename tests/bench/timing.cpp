// SPDX-License-Identifier: BSD-3-Clause
#include "bench/timing.hpp"

#include <benchmark/benchmark.h>

namespace tactus::bench {
namespace {

class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    const Run& run = runs.front();
    seconds = run.cpu_accumulated_time / static_cast<double>(run.iterations);
  }
  double seconds = 0.0;
};

}  // namespace

double thread_seconds(const std::string& name, double at_least, const std::function<void()>& work) {
  const auto loop = [&work](benchmark::State& state) {
    for ([[maybe_unused]] auto run : state) work();
  };
  benchmark::internal::Benchmark* registered = benchmark::RegisterBenchmark(name.c_str(), loop);
  if (at_least > 0.0)
    registered->MinTime(at_least);
  else
    registered->Iterations(1);
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector, ".");
  benchmark::ClearRegisteredBenchmarks();
  return collector.seconds;
}

}  // namespace tactus::bench
