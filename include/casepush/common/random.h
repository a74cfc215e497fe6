#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace casepush {

/// Seeded random numbers whose sequence is the same on every platform and standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  /// An independent stream: the same seed and name always give the same one.
  static Random stream(std::uint64_t seed, std::string_view name);

  double uniform(double low, double high);    ///< In [low, high).
  double normal(double standard_deviation);   ///< Mean 0 (Box-Muller, Marsaglia's polar form).
  bool chance(double probability);            ///< True with the given probability.
  std::uint64_t below(std::uint64_t bound);   ///< Integer in [0, bound); bound > 0.
  std::uint64_t bits() { return engine_(); }  ///< 64 random bits, e.g. a seed for something else.

 private:
  std::mt19937_64 engine_;
};

}  // namespace casepush
