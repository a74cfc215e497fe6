#include "casepush/common/random.h"

#include <cmath>

#include "casepush/common/check.h"

namespace casepush {
namespace {

// SplitMix64 (Steele, Lea, Flood 2014): spreads similar seeds over the whole state space.
std::uint64_t splitMix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed) : engine_(splitMix(seed)) {}

Random Random::stream(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = splitMix(seed);
  for (const char c : name) {
    hash = splitMix(hash ^ static_cast<unsigned char>(c));
  }
  return Random(hash);
}

double Random::uniform(double low, double high) {
  constexpr double kScale = 1.0 / 9007199254740992.0;  // 2^-53: all doubles of the form k * 2^-53
  return low + (high - low) * (static_cast<double>(engine_() >> 11) * kScale);
}

double Random::normal(double standard_deviation) {
  double u = 0.0;
  double s = 0.0;
  do {
    u = uniform(-1.0, 1.0);
    const double v = uniform(-1.0, 1.0);
    s = u * u + v * v;
  } while (s >= 1.0 || s == 0.0);
  return standard_deviation * u * std::sqrt(-2.0 * std::log(s) / s);
}

bool Random::chance(double probability) { return uniform(0.0, 1.0) < probability; }

std::uint64_t Random::below(std::uint64_t bound) {
  CASEPUSH_CHECK(bound > 0, "bound = 0");
  const std::uint64_t limit = UINT64_MAX - UINT64_MAX % bound;
  std::uint64_t value = 0;
  do {
    value = engine_();
  } while (value >= limit);
  return value % bound;
}

}  // namespace casepush
